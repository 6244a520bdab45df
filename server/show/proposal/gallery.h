// SPDX-License-Identifier: Apache-2.0
// Makes a plain room in which pictures hang side by side on one wall: its glTF file, and where they
// hang and are seen from.
#pragma once
#include <string>
#include <vector>

#include "base/vec.h"

namespace wellspring::show {

// Holds the size of a picture, and where the middle of its back is; metres.
struct HungPicture {
  double width = 1, height = 1;
  dvec3 place{0};  // its wall is at z = 0; the floor is at y = 0
};
struct GalleryView {
  dvec3 eye{0};
  double yaw = 0, pitch = 0, fov = 1;  // radians; 0 looks towards -z, positive turns left and up
};
struct Gallery {
  dvec3 size{0};  // metres; the room is between 0 and this
  std::vector<HungPicture> pictures;
  std::vector<dvec3> lamps;        // one above each picture
  std::vector<GalleryView> views;  // one before each picture
  GalleryView overview;
};

// Hangs pictures of these sizes from left to right.
Gallery hang_gallery(std::vector<HungPicture> pictures, double eye_height);

// Writes gallery.gltf and gallery.bin: floor, walls, ceiling and lamps. Throws LoadError.
void write_gallery(const Gallery& gallery, const std::string& folder);

}  // namespace wellspring::show
