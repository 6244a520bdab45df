// SPDX-License-Identifier: Apache-2.0
#include "store/open/spoken_picture.h"

#include <algorithm>

#include "base/load_error.h"
#include "store/open/open_picture.h"

namespace wellspring::store {

SpokenPicture::SpokenPicture(const PicturePyramid& open, std::string path, std::string layer,
                             std::string language)
    : path_(std::move(path)), layer_(std::move(layer)), language_(std::move(language)) {
  levels_ = open.levels();
  languages_ = open.languages();
}

const PicturePyramid& SpokenPicture::opened() const {
  std::lock_guard lock(mutex_);
  if (picture_) return *picture_;
  auto picture = open_picture(path_, layer_, language_);
  const auto same_size = [](const PyramidLevel& a, const PyramidLevel& b) {
    return a.width == b.width && a.height == b.height && a.tile_width == b.tile_width &&
           a.tile_height == b.tile_height;
  };
  if (!std::ranges::equal(picture->levels(), levels_, same_size))
    throw LoadError(path_, "", "has another size than before");
  picture_ = std::move(picture);
  return *picture_;
}

Fetched SpokenPicture::fetch(PieceKey key) const { return opened().fetch(key); }

}  // namespace wellspring::store
