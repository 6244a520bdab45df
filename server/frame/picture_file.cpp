// SPDX-License-Identifier: Apache-2.0
#include "frame/picture_file.h"

#include <algorithm>
#include <cctype>

#include "base/load_error.h"
#include "base/read_file.h"
#include "base/write_file.h"

namespace wellspring::frame {
namespace {

constexpr size_t most_bytes = size_t(4) << 30;  // those of the largest linear picture, and more

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
    const LinearView view{frame.width, frame.height, frame.color, frame.depth};
    write_file(path, ending == "pfm" ? encode_pfm(view) : encode_exr(view, path, comment));
  } else {
    Image8 image;
    tonemap(frame, settings, image);
    save_image8(path, image, comment);
  }
}

void save_image8(const std::string& path, const Image8& image, const std::string& comment) {
  std::string ending = ending_of(path);
  if (!is_8bit(ending)) throw LoadError(path, "", "name must end in .png or .jpg");
  if (image.width < 1 || image.height < 1 || image.width > largest_side ||
      image.height > largest_side ||
      image.rgb.size() != size_t(image.width) * size_t(image.height) * 3)
    throw LoadError(path, "", "there is no picture of at most 16384 a side to write");
  std::vector<uint8_t> bytes;
  if (ending == "png") {
    bytes = encode_png(image, comment, path);
  } else {
    encode_jpeg(image, 95, true, bytes);
    if (!comment.empty()) add_jpeg_comment(comment, bytes);
  }
  write_file(path, bytes);
}

Frame load_linear_picture(const std::string& path) {
  std::string ending = ending_of(path);
  if (!is_linear(ending)) throw LoadError(path, "", "name must end in .pfm or .exr");
  const std::string bytes = read_file(path, most_bytes);
  LinearImage read = ending == "pfm" ? decode_pfm(bytes, path) : decode_exr(bytes, path);
  return {read.width, read.height, std::move(read.color), {}, {}, {}};
}

}  // namespace wellspring::frame
