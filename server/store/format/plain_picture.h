// SPDX-License-Identifier: Apache-2.0
// Opens a plain JPEG, PNG or WebP: it is read whole, and smaller levels are averaged from it.
#pragma once
#include <memory>
#include <string>

#include "store/picture/kept_levels.h"

namespace wellspring::store {

// Applies the EXIF orientation and the ICC profile. Throws a LoadError if the picture has more
// texels than `most_texels`, before it is unpacked.
std::shared_ptr<const PicturePyramid> load_plain_picture(const std::string& file,
                                                         int64_t most_texels = most_whole_texels);

}  // namespace wellspring::store
