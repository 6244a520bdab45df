// SPDX-License-Identifier: Apache-2.0
// A package of the benchmark's own: a room with a very large picture on its wall, which the program
// vips makes (Debian: libvips-tools), as `./wellspring import picture` does.
#pragma once
#include <cstdint>
#include <string>

#include "base/vec.h"
#include "own_folder.h"

namespace wellspring::test {

class LargePictureRoom {
 public:
  // Takes a minute. Throws std::runtime_error if vips is missing or fails.
  LargePictureRoom();
  const std::string& content() const { return folder_.path(); }  // folder of packages
  std::string picture() const { return folder_.path() + "/room/picture.tif"; }

  static constexpr const char* exhibit = "room";
  static constexpr const char* piece = "picture";
  // Levels halve from here; each is cut into tiles of 256 texels a side.
  static constexpr int width = 19968, height = 14592, tile = 256;
  // Metres; the picture's middle, and where its surface lies, which faces +Z.
  static constexpr double picture_width = 4, middle_height = 1.8, surface = -2.98;

 private:
  OwnFolder folder_;
};

}  // namespace wellspring::test
