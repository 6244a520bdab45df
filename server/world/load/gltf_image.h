// SPDX-License-Identifier: Apache-2.0
// Decodes pictures to Image: PNG by libpng, JPEG by libjpeg-turbo and WebP by libwebp, chosen by
// their first bytes, not by their names.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "world/texture.h"

struct png_struct_def;
struct png_info_def;

namespace wellspring::world {

// Reads PNG pictures by libpng. Rows are unpacked one after the other, so that a file takes no more
// memory than its width and height say.

class PngReader {
 public:
  explicit PngReader(std::span<const uint8_t> bytes);  // borrowed
  ~PngReader();
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  // These two are called once, in this order. False: `problem` says what is wrong with the file.
  bool read_head();
  // Reads red, green, blue and alpha of each pixel as they stand in the file, from the top:
  // uint8_t, or uint16_t if there are 16 bits. The file's colour profile and gamma are left alone,
  // as glTF has it (2.0, section 3.8.2).
  bool read_texels(void* texels);

  int width = 0, height = 0, bits = 0;  // bits: of a channel; set by read_head()
  std::string problem;

 private:
  static void read(png_struct_def* png, unsigned char* to, size_t count);
  static void fail(png_struct_def* png, const char* what);

  std::span<const uint8_t> left_;  // bytes of the file that are not read yet
  png_struct_def* png_ = nullptr;
  png_info_def* info_ = nullptr;
};

constexpr int image_side_limit = 16384;
// Texels of all pictures of a scene together.
constexpr int64_t image_texel_limit = int64_t(1) << 28;

// Decodes a picture: eight-bit pictures keep their codes; 16-bit ones become linear floats.
// `texels_left` shrinks by the decoded texels. Returns an empty string, or what is wrong.
std::string decode_image(std::span<const uint8_t> bytes, bool srgb, Image& image,
                         int64_t& texels_left);
// Decodes Radiance .hdr to linear floats. Returns an empty string, or what is wrong.
std::string decode_radiance(std::span<const uint8_t> bytes, Image& image);

}  // namespace wellspring::world
