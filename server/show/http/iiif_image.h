// SPDX-License-Identifier: Apache-2.0
// Makes the pictures of the IIIF Image API from the tiles of a pyramid: of the level that is just
// as fine as asked for, averaged in linear light; or finds the tile that is stored just so.
#pragma once
#include <vector>

#include "image/image.h"
#include "show/http/iiif_request.h"
#include "store/picture/pyramid.h"

namespace wellspring::show {

// Returns how many of the picture's texels one texel of a level is wide and high, if that is a
// whole number, up to rounding of its size; else 0.
int64_t iiif_scale(const PyramidLevel& level, const PyramidLevel& finest);

// Returns the JPEG of a request that asks for exactly one tile as it is stored; else nothing.
// Throws LoadError.
std::vector<uint8_t> find_iiif_tile(const PicturePyramid& pyramid, const IiifRequest& request);

// Returns how many texels are read and pixels written for a request.
int64_t iiif_cost(const PicturePyramid& pyramid, const IiifRequest& request);

// Makes the picture: white where it has no texels, or transparent ones. Throws LoadError.
Image8 make_iiif_image(const PicturePyramid& pyramid, const IiifRequest& request);

}  // namespace wellspring::show
