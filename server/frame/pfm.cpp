// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "base/load_error.h"
#include "frame/linear_picture.h"

namespace wellspring::frame {

static_assert(std::endian::native == std::endian::little, "PFM is written as little-endian floats");
static_assert(sizeof(vec3) == 12, "a row of colours is a row of floats");

std::vector<char> encode_pfm(const Frame& frame) {
  char header[64];
  int length = std::snprintf(header, sizeof header, "PF\n%d %d\n-1.0\n", frame.width, frame.height);
  size_t row = size_t(frame.width) * sizeof(vec3);
  std::vector<char> bytes(size_t(length) + row * size_t(frame.height));
  std::memcpy(bytes.data(), header, size_t(length));
  for (int y = 0; y < frame.height; y++)  // bottom row first
    std::memcpy(bytes.data() + size_t(length) + row * size_t(frame.height - 1 - y),
                frame.color.data() + size_t(y) * size_t(frame.width), row);
  return bytes;
}

Frame decode_pfm(std::istream& in, const std::string& path) {
  std::string magic;
  Frame frame;
  double scale = 0;
  in.width(3);
  if (!(in >> magic) || (magic != "PF" && magic != "Pf"))
    throw LoadError(path, "byte 0", "not a PFM file: it must begin with PF or Pf");
  if (!(in >> frame.width >> frame.height >> scale) || !std::isfinite(scale) || scale == 0)
    throw LoadError(path, "header", "width, height and scale expected");
  if (frame.width < 1 || frame.height < 1 || frame.width > largest_picture_side ||
      frame.height > largest_picture_side)
    throw LoadError(path, "header", "picture must have 1 to 16384 pixels a side");
  in.get();  // exactly one blank ends the header
  size_t channels = magic == "PF" ? 3 : 1;
  auto start = in.tellg();
  in.seekg(0, std::ios::end);
  auto available = in.tellg() - start;
  in.seekg(start);
  size_t row = size_t(frame.width) * channels;
  if (available < 0 || size_t(available) < row * 4 * size_t(frame.height))
    throw LoadError(path, "header", "file is shorter than its width and height say");
  frame.color.resize(size_t(frame.width) * size_t(frame.height));
  std::vector<uint32_t> words(row);
  for (int y = frame.height - 1; y >= 0; y--) {
    if (!in.read(reinterpret_cast<char*>(words.data()), std::streamsize(row * 4)))
      throw LoadError(path, "row " + std::to_string(y), "cannot be read");
    if (scale > 0)
      for (uint32_t& word : words) word = __builtin_bswap32(word);
    for (int x = 0; x < frame.width; x++) {
      auto value = [&](size_t c) { return std::bit_cast<float>(words[size_t(x) * channels + c]); };
      frame.color[size_t(y) * size_t(frame.width) + size_t(x)] =
          channels == 3 ? vec3(value(0), value(1), value(2)) : vec3(value(0));
    }
  }
  return frame;
}

}  // namespace wellspring::frame
