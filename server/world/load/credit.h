// SPDX-License-Identifier: Apache-2.0
// Who made a glTF file, as it says itself: asset.copyright, and what model libraries write into
// asset.extras (title, author, license, source).
#pragma once
#include <string>

namespace wellspring::world {

struct Credit {
  std::string file;  // as the exhibit names it
  std::string title, author, licence, source, copyright;
  bool empty() const {
    return title.empty() && author.empty() && licence.empty() && source.empty() &&
           copyright.empty();
  }
};

// Throws LoadError. `package` as in SceneLoadOptions.
Credit load_credit(const std::string& path, const std::string& package = "");

}  // namespace wellspring::world
