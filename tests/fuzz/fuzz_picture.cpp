// SPDX-License-Identifier: Apache-2.0
// Pictures on surfaces, of the sky and for comparison: PNG, JPEG, HDR, PFM, OpenEXR.
#include "fuzz/fuzz.h"
#include "image/image.h"
#include "world/texture.h"

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
  load([&] {
    const LinearImage sky = decode_hdr(bytes, 1 << 26, "fuzz.hdr");
    require(sky.color.size() == size_t(sky.width) * size_t(sky.height), "a sky has all texels");
  });
  load([&] { decode_jpeg(bytes, "fuzz.jpg"); });
  const std::string text(text_of(bytes));
  if (text.starts_with("P")) load([&] { decode_pfm(text, "fuzz.pfm"); });
  else load([&] { decode_exr(text, "fuzz.exr"); });
}

}  // namespace wellspring::fuzz
