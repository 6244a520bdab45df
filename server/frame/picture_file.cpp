// SPDX-License-Identifier: Apache-2.0
#include "frame/picture_file.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStdIO.h>
#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <span>
#include <sstream>
#include <string_view>

#include "base/load_error.h"
#include "base/write_file.h"
#include "frame/jpeg.h"

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

namespace {

// A file of a few bytes may claim any number of pixels, which take memory before they are read.
constexpr int64_t most_exr_pixels = int64_t(1) << 26;
constexpr int64_t farthest_window = 1 << 20;

// Returns the names of a file's red, green and blue: plain, a lone Y, or those of the first layer
// with all three.
std::array<std::string, 3> color_channels(const Imf::ChannelList& channels,
                                          const std::string& path) {
  if (channels.findChannel("R") && channels.findChannel("G") && channels.findChannel("B"))
    return {"R", "G", "B"};
  if (channels.findChannel("Y")) return {"Y", "Y", "Y"};
  for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
    std::string name = channel.name();
    if (name.size() < 2 || name.compare(name.size() - 2, 2, ".R") != 0) continue;
    std::string layer = name.substr(0, name.size() - 1);
    if (channels.findChannel(layer + "G") && channels.findChannel(layer + "B"))
      return {layer + "R", layer + "G", layer + "B"};
  }
  throw LoadError(path, "channels", "no R, G and B, and no Y");
}

uint32_t read_word(std::string_view bytes, size_t at) {  // bytes beyond the end are 0
  uint32_t word = 0;
  for (size_t i = 0; i < 4 && at + i < bytes.size(); i++)
    word |= uint32_t(uint8_t(bytes[at + i])) << (8 * i);
  return word;
}

// Returns how many bytes OpenEXR reads of a value of this type whose size is said to be `size`: for
// some types the value itself decides. `rest`: bytes from the value to the file's end.
uint64_t bytes_read(const std::string& type, std::string_view rest, uint32_t size) {
  static const std::map<std::string, uint64_t> fixed = {
      {"box2f", 16},         {"box2i", 16},    {"chromaticities", 32},
      {"compression", 1},    {"double", 8},    {"envmap", 1},
      {"deepImageState", 1}, {"float", 4},     {"int", 4},
      {"keycode", 28},       {"lineOrder", 1}, {"m33d", 72},
      {"m33f", 36},          {"m44d", 128},    {"m44f", 64},
      {"rational", 8},       {"v2d", 16},      {"tiledesc", 9},
      {"timecode", 8},       {"v2f", 8},       {"v2i", 8},
      {"v3d", 24},           {"v3f", 12},      {"v3i", 12}};
  if (auto found = fixed.find(type); found != fixed.end()) return found->second;
  if (type == "floatvector") return size - size % 4;
  if (type == "preview") return 8 + 4 * uint64_t(read_word(rest, 0)) * read_word(rest, 4);
  uint64_t at = 0;
  if (type == "stringvector") {
    while (at < size) at += 4 + uint64_t(read_word(rest, at));
    return at;
  }
  if (type != "chlist") return size;
  while (at < rest.size() && rest[at] != 0) at = std::min(rest.find('\0', at), rest.size()) + 17;
  return at + 1;
}

// Refuses attributes whose sizes reach beyond the file's end or are not what a value of the type
// takes: OpenEXR makes room for an attribute of any size before it looks for its bytes. A header
// (OpenEXR File Layout, "Header") has name, type, size, value; an empty name ends it; files of
// several parts have several headers.
void check_attributes(const std::string& bytes, const std::string& path) {
  if (bytes.size() < 8) return;  // OpenEXR says what is missing
  const bool parts = bytes[5] & 0x10;
  size_t at = 8;
  for (bool first = true; at < bytes.size() && (first || parts) && bytes[at] != 0; at++) {
    first = false;
    while (at < bytes.size() && bytes[at] != 0) {
      std::string type;  // the second of two texts
      for (int text = 0; text < 2 && at < bytes.size(); text++) {
        type = bytes.c_str() + at;
        at += type.size() + 1;
      }
      if (at + 4 > bytes.size()) return;
      const std::string where = "byte " + std::to_string(at);
      const uint32_t size = read_word(bytes, at);
      at += 4;
      if (size > bytes.size() - at)
        throw LoadError(path, where,
                        "an attribute of " + std::to_string(size) + " bytes is cut off");
      if (bytes_read(type, std::string_view(bytes).substr(at), size) != size)
        throw LoadError(path, where,
                        "an attribute of " + std::to_string(size) + " bytes is no " + type);
      at += size;
    }
  }
}

}  // namespace

std::vector<char> encode_exr(const Frame& frame, const std::string& path,
                             const std::string& comment) {
  try {
    Imf::Header header(frame.width, frame.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    if (!comment.empty()) Imf::addComments(header, comment);
    Imf::FrameBuffer buffer;
    auto add = [&](const char* name, const float* plane, size_t step) {
      header.channels().insert(name, Imf::Channel(Imf::FLOAT));
      buffer.insert(name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(const_cast<float*>(plane)),
                                     step, step * size_t(frame.width)));
    };
    add("R", &frame.color[0].x, sizeof(vec3));
    add("G", &frame.color[0].y, sizeof(vec3));
    add("B", &frame.color[0].z, sizeof(vec3));
    if (frame.depth.size() == frame.color.size()) add("Z", frame.depth.data(), sizeof(float));
    Imf::StdOSStream stream;
    {
      Imf::OutputFile file(stream, header);
      file.setFrameBuffer(buffer);
      file.writePixels(frame.height);
    }  // the offset table is written when the file closes
    std::string bytes = stream.str();
    return {bytes.begin(), bytes.end()};
  } catch (const std::exception& error) {
    throw LoadError(path, "", std::string("cannot be written as OpenEXR: ") + error.what());
  }
}

Frame decode_exr(std::istream& in, const std::string& path) {
  try {
    std::ostringstream whole;
    whole << in.rdbuf();
    check_attributes(whole.str(), path);
    Imf::Header::setMaxImageSize(largest_picture_side, largest_picture_side);
    Imf::StdISStream stream;
    stream.str(whole.str());
    Imf::InputFile file(stream);
    const auto& window = file.header().dataWindow();
    int64_t width = int64_t(window.max.x) - window.min.x + 1,
            height = int64_t(window.max.y) - window.min.y + 1;
    if (width < 1 || height < 1 || width > largest_picture_side || height > largest_picture_side)
      throw LoadError(path, "dataWindow", "picture must have 1 to 16384 pixels a side");
    if (width * height > most_exr_pixels)
      throw LoadError(path, "dataWindow", "picture must have at most 64 million pixels");
    if (std::max(std::abs(int64_t(window.min.x)), std::abs(int64_t(window.min.y))) >
        farthest_window)
      throw LoadError(path, "dataWindow", "begins more than a million pixels from 0");
    std::array<std::string, 3> names = color_channels(file.header().channels(), path);
    const bool grey = names[0] == names[1];
    Frame frame;
    frame.width = int(width);
    frame.height = int(height);
    frame.color.resize(size_t(width * height));
    Imf::FrameBuffer buffer;
    for (int c = 0; c < (grey ? 1 : 3); c++) {
      // OpenEXR addresses pixels by their window coordinates.
      char* origin =
          reinterpret_cast<char*>(&frame.color[0][c]) -
          (ptrdiff_t(window.min.x) + ptrdiff_t(window.min.y) * width) * ptrdiff_t(sizeof(vec3));
      buffer.insert(names[size_t(c)],
                    Imf::Slice(Imf::FLOAT, origin, sizeof(vec3), sizeof(vec3) * size_t(width)));
    }
    file.setFrameBuffer(buffer);
    file.readPixels(window.min.y, window.max.y);
    if (grey)
      for (vec3& color : frame.color) color = vec3(color.x);
    return frame;
  } catch (const LoadError&) {
    throw;
  } catch (const std::exception& error) {
    throw LoadError(path, "", std::string("not readable as OpenEXR: ") + error.what());
  }
}

}  // namespace wellspring::frame

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

// Inserts a tEXt chunk behind the header (PNG specification, section 11.3.4.3).
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
    write_file(path, bytes);
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
