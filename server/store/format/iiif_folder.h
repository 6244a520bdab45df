// SPDX-License-Identifier: Apache-2.0
// Reads a local tree of IIIF Image API, level 0: an info.json of version 1.0, 1.1, 2 or 3, and the
// tiles beside it as REGION/SIZE/0/QUALITY.FORMAT. https://iiif.io/api/image/3.0/
#pragma once
#include <memory>
#include <string>

#include "store/picture/pyramid.h"

namespace wellspring::store {

// Opens it by its info.json (iiif_info.h). Levels of one tile may be rounded up or down: they are
// as their file is.
std::shared_ptr<const PicturePyramid> load_iiif_folder(const std::string& file);

}  // namespace wellspring::store
