// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <sstream>

#include "base/load_error.h"
#include "image/image.h"

namespace wellspring::image {

static_assert(std::endian::native == std::endian::little, "PFM is written as little-endian floats");
static_assert(sizeof(vec3) == 12, "a row of colours is a row of floats");

std::vector<char> encode_pfm(const LinearView& image) {
  char header[64];
  int length = std::snprintf(header, sizeof header, "PF\n%d %d\n-1.0\n", image.width, image.height);
  size_t row = size_t(image.width) * sizeof(vec3);
  std::vector<char> bytes(size_t(length) + row * size_t(image.height));
  std::memcpy(bytes.data(), header, size_t(length));
  for (int y = 0; y < image.height; y++)  // bottom row first
    std::memcpy(bytes.data() + size_t(length) + row * size_t(image.height - 1 - y),
                image.color.data() + size_t(y) * size_t(image.width), row);
  return bytes;
}

LinearImage decode_pfm(const std::string& bytes, const std::string& file) {
  std::istringstream in(bytes.substr(0, 256));
  std::string magic;
  LinearImage image;
  double scale = 0;
  in.width(3);
  if (!(in >> magic) || (magic != "PF" && magic != "Pf"))
    throw LoadError(file, "byte 0", "not a PFM file: it must begin with PF or Pf");
  if (!(in >> image.width >> image.height >> scale) || !std::isfinite(scale) || scale == 0)
    throw LoadError(file, "header", "width, height and scale expected");
  if (image.width < 1 || image.height < 1 || image.width > largest_side ||
      image.height > largest_side)
    throw LoadError(file, "header", "picture must have 1 to 16384 pixels a side");
  in.get();  // exactly one blank ends the header
  const size_t channels = magic == "PF" ? 3 : 1;
  const size_t row = size_t(image.width) * channels * sizeof(float);
  if (!in || bytes.size() - size_t(in.tellg()) < row * size_t(image.height))
    throw LoadError(file, "header", "file is shorter than its width and height say");
  const char* from = bytes.data() + in.tellg();
  image.color.resize(size_t(image.width) * size_t(image.height));
  for (int y = image.height - 1; y >= 0; y--)
    for (int x = 0; x < image.width; x++) {
      vec3& color = image.color[size_t(y) * size_t(image.width) + size_t(x)];
      for (size_t c = 0; c < channels; c++, from += sizeof(float)) {
        uint32_t word;
        std::memcpy(&word, from, sizeof word);
        color[int(c)] = std::bit_cast<float>(scale > 0 ? __builtin_bswap32(word) : word);
      }
      if (channels == 1) color = vec3(color.x);
    }
  return image;
}

}  // namespace wellspring::image
