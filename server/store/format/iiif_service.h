// SPDX-License-Identifier: Apache-2.0
// Reads pictures from other museums' servers by the IIIF Image API, versions 1 to 3, levels 0 to 2.
// Tiles are asked for as OpenSeadragon does, so that servers have them at hand.
// https://iiif.io/api/image/3.0/
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "store/picture/pyramid.h"

namespace wellspring::store {

// Opens a service by its base address or that of its info.json, which is read once; tiles are asked
// for below that address, whatever "id" the info.json gives. Only `hosts` are asked: HOST or
// HOST:PORT. An answer is waited for `patience` seconds. Tiles may be one texel larger or smaller
// than they should be, since servers round differently. A tile that the server has not (404, 410)
// is absent. Throws LoadError for whatever else goes wrong, here and when tiles are fetched.
std::shared_ptr<const PicturePyramid> load_iiif_service(const std::string& address,
                                                        const std::vector<std::string>& hosts,
                                                        double patience = 10);

}  // namespace wellspring::store
