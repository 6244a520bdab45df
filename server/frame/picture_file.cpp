// SPDX-License-Identifier: Apache-2.0
#include "frame/picture_file.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <span>

#include "base/load_error.h"
#include "base/write_file.h"
#include "frame/jpeg.h"
#include "frame/linear_picture.h"

#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb_image_write.h>
#pragma GCC diagnostic pop
#include <zlib.h>

namespace wellspring::frame {
namespace {

std::string ending_of(const std::string& path) {
  size_t dot = path.find_last_of("./");
  std::string ending = dot == std::string::npos || path[dot] == '/' ? "" : path.substr(dot + 1);
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return ending;
}

bool is_linear(const std::string& ending) { return ending == "pfm" || ending == "exr"; }
bool is_8bit(const std::string& ending) {
  return ending == "png" || ending == "jpg" || ending == "jpeg";
}

// A tEXt chunk behind the header (PNG specification, section 11.3.4.3).
void add_png_comment(const std::string& comment, std::vector<char>& png) {
  constexpr size_t header_end = 33;  // signature 8, IHDR 25
  std::string chunk = "tEXtComment";
  chunk.push_back(0);
  chunk += comment;
  auto number = [](uint32_t value) {
    return std::string{char(value >> 24), char(value >> 16), char(value >> 8), char(value)};
  };
  uint32_t sum =
      uint32_t(crc32(0, reinterpret_cast<const Bytef*>(chunk.data()), uInt(chunk.size())));
  chunk = number(uint32_t(chunk.size() - 4)) + chunk + number(sum);
  png.insert(png.begin() + header_end, chunk.begin(), chunk.end());
}

std::vector<char> encode_png(const Image8& image) {
  std::vector<char> bytes;
  auto append = [](void* context, void* data, int size) {
    auto* out = static_cast<std::vector<char>*>(context);
    out->insert(out->end(), static_cast<char*>(data), static_cast<char*>(data) + size);
  };
  if (!stbi_write_png_to_func(append, &bytes, image.width, image.height, 3, image.rgb.data(),
                              image.width * 3))
    bytes.clear();
  return bytes;
}

}  // namespace

bool is_picture_name(const std::string& path) {
  std::string ending = ending_of(path);
  return is_linear(ending) || is_8bit(ending);
}

bool is_linear_picture_name(const std::string& path) { return is_linear(ending_of(path)); }

void save_picture(const std::string& path, const Frame& frame, const Tonemap& settings,
                  const std::string& comment) {
  std::string ending = ending_of(path);
  if (!is_picture_name(path))
    throw LoadError(path, "", "name must end in .png, .jpg, .pfm or .exr");
  if (frame.width < 1 || frame.height < 1 ||
      frame.color.size() != size_t(frame.width) * size_t(frame.height))
    throw LoadError(path, "", "there is no picture to write");
  if (is_linear(ending)) {
    write_file(path, ending == "pfm" ? encode_pfm(frame) : encode_exr(frame, path, comment));
  } else {
    Image8 image;
    tonemap(frame, settings, image);
    save_image8(path, image, comment);
  }
}

void save_image8(const std::string& path, const Image8& image, const std::string& comment) {
  std::string ending = ending_of(path);
  if (!is_8bit(ending)) throw LoadError(path, "", "name must end in .png or .jpg");
  if (image.width < 1 || image.height < 1 || image.width > 16384 || image.height > 16384 ||
      image.rgb.size() != size_t(image.width) * size_t(image.height) * 3)
    throw LoadError(path, "", "there is no picture of at most 16384 a side to write");
  if (ending == "png") {
    std::vector<char> bytes = encode_png(image);
    if (bytes.empty()) throw LoadError(path, "", "picture is too large for PNG");
    if (!comment.empty()) add_png_comment(comment, bytes);
    write_file(path, bytes);
  } else {
    std::vector<uint8_t> bytes;
    encode_jpeg(image, 95, true, bytes);
    if (!comment.empty()) add_jpeg_comment(comment, bytes);
    write_file(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  }
}

Frame load_linear_picture(const std::string& path) {
  std::string ending = ending_of(path);
  if (!is_linear(ending)) throw LoadError(path, "", "name must end in .pfm or .exr");
  std::ifstream file(path, std::ios::binary);
  if (!file) throw LoadError(path, "", std::string("cannot be read: ") + std::strerror(errno));
  return ending == "pfm" ? decode_pfm(file, path) : decode_exr(file, path);
}

}  // namespace wellspring::frame
