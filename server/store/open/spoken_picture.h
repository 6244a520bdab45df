// SPDX-License-Identifier: Apache-2.0
// Shows a picture in another language than one that is open.
#pragma once
#include <mutex>
#include <string>

#include "store/picture/pyramid.h"

namespace wellspring::store {

// Has the levels of the picture that is open, and is opened itself when its first piece is fetched:
// a language that nobody asks for costs nothing.
class SpokenPicture : public PicturePyramid {
 public:
  // `path` and `layer` are those of open_picture().
  SpokenPicture(const PicturePyramid& open, std::string path, std::string layer,
                std::string language);
  // Throws LoadError if the picture cannot be opened, or has other levels by now.
  Fetched fetch(PieceKey key) const override;

 private:
  const PicturePyramid& opened() const;

  const std::string path_, layer_, language_;
  mutable std::mutex mutex_;
  mutable std::shared_ptr<const PicturePyramid> picture_;  // null: it is not open yet
};

}  // namespace wellspring::store
