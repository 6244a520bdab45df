// SPDX-License-Identifier: Apache-2.0
// Tells formats of large pictures apart.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "store/bands/band_view.h"
#include "store/picture/pyramid.h"

namespace wellspring::store {

// Opens a picture by what is found at `path`: a Deep Zoom .dzi or .xml, a folder of Zoomify
// (ImageProperties.xml) or of IIIF level 0 (info.json), or these files themselves, a TIFF, a plain
// JPEG, PNG or WebP, a .geojson with labels in `language`, a .painting.json, of which `layer` is
// shown (empty: the first) with labels in it, too. Or `path` is the http or https address of an
// IIIF image service, whose host is one of `allowed_hosts` (store/remote/http_get.h). `bands`: how
// a TIFF of many bands is shown; others know only the first one. Throws LoadError, which names the
// file and the place in it.
std::shared_ptr<const PicturePyramid> open_picture(
    const std::string& path, const std::string& layer = "", const std::string& language = "en",
    const std::vector<std::string>& allowed_hosts = {}, const BandView& bands = {});

}  // namespace wellspring::store
