// SPDX-License-Identifier: Apache-2.0
// Pictures on surfaces, of the sky and for comparison: PNG, JPEG, HDR, PFM, OpenEXR.
#include <sstream>

#include "frame/jpeg.h"
#include "frame/picture_file.h"
#include "fuzz/fuzz.h"
#include "world/load/gltf_image.h"

namespace wellspring::fuzz {

void fuzz_picture(Bytes bytes) {
  for (bool srgb : {false, true}) {
    Image image;
    int64_t texels_left = 1 << 20;
    if (decode_image(bytes, srgb, image, texels_left).empty()) {
      const size_t texels = size_t(image.width) * size_t(image.height);
      require(image.texels8.size() == 4 * texels || image.texels.size() == texels,
              "a picture has all of its texels");
    }
  }
  Image sky;
  if (decode_radiance(bytes, sky).empty())
    require(sky.texels.size() == size_t(sky.width) * size_t(sky.height), "a sky has all texels");
  load([&] { decode_jpeg(bytes, "fuzz.jpg"); });
  std::istringstream in(text_of(bytes));
  if (text_of(bytes).starts_with("P")) load([&] { decode_pfm(in, "fuzz.pfm"); });
  else load([&] { decode_exr(in, "fuzz.exr"); });
}

}  // namespace wellspring::fuzz
