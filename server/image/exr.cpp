// SPDX-License-Identifier: Apache-2.0
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStdIO.h>
#include <algorithm>
#include <array>
#include <cstdlib>
#include <map>
#include <string_view>

#include "base/load_error.h"
#include "image/image.h"

namespace wellspring::image {
namespace {

// A file of a few bytes may claim any number of pixels, which take memory before they are read.
constexpr int64_t most_exr_pixels = int64_t(1) << 26;
constexpr int64_t farthest_window = 1 << 20;

// Returns the names of a file's red, green and blue: plain, a lone Y, or those of the first layer
// with all three.
std::array<std::string, 3> color_channels(const Imf::ChannelList& channels,
                                          const std::string& file) {
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
  throw LoadError(file, "channels", "no R, G and B, and no Y");
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
void check_attributes(const std::string& bytes, const std::string& file) {
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
        throw LoadError(file, where,
                        "an attribute of " + std::to_string(size) + " bytes is cut off");
      if (bytes_read(type, std::string_view(bytes).substr(at), size) != size)
        throw LoadError(file, where,
                        "an attribute of " + std::to_string(size) + " bytes is no " + type);
      at += size;
    }
  }
}

}  // namespace

std::vector<char> encode_exr(const LinearView& image, const std::string& file,
                             const std::string& comment) {
  try {
    Imf::Header header(image.width, image.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    if (!comment.empty()) Imf::addComments(header, comment);
    Imf::FrameBuffer buffer;
    auto add = [&](const char* name, const float* plane, size_t step) {
      header.channels().insert(name, Imf::Channel(Imf::FLOAT));
      buffer.insert(name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(const_cast<float*>(plane)),
                                     step, step * size_t(image.width)));
    };
    add("R", &image.color[0].x, sizeof(vec3));
    add("G", &image.color[0].y, sizeof(vec3));
    add("B", &image.color[0].z, sizeof(vec3));
    if (image.depth.size() == image.color.size()) add("Z", image.depth.data(), sizeof(float));
    Imf::StdOSStream stream;
    {
      Imf::OutputFile exr(stream, header);
      exr.setFrameBuffer(buffer);
      exr.writePixels(image.height);
    }  // the offset table is written when the file closes
    std::string bytes = stream.str();
    return {bytes.begin(), bytes.end()};
  } catch (const std::exception& error) {
    throw LoadError(file, "", std::string("cannot be written as OpenEXR: ") + error.what());
  }
}

LinearImage decode_exr(const std::string& bytes, const std::string& file) {
  try {
    check_attributes(bytes, file);
    Imf::Header::setMaxImageSize(largest_side, largest_side);
    Imf::StdISStream stream;
    stream.str(bytes);
    Imf::InputFile exr(stream);
    const auto& window = exr.header().dataWindow();
    int64_t width = int64_t(window.max.x) - window.min.x + 1,
            height = int64_t(window.max.y) - window.min.y + 1;
    if (width < 1 || height < 1 || width > largest_side || height > largest_side)
      throw LoadError(file, "dataWindow", "picture must have 1 to 16384 pixels a side");
    if (width * height > most_exr_pixels)
      throw LoadError(file, "dataWindow", "picture must have at most 64 million pixels");
    if (std::max(std::abs(int64_t(window.min.x)), std::abs(int64_t(window.min.y))) >
        farthest_window)
      throw LoadError(file, "dataWindow", "begins more than a million pixels from 0");
    std::array<std::string, 3> names = color_channels(exr.header().channels(), file);
    const bool grey = names[0] == names[1];
    LinearImage image;
    image.width = int(width);
    image.height = int(height);
    image.color.resize(size_t(width * height));
    Imf::FrameBuffer buffer;
    for (int c = 0; c < (grey ? 1 : 3); c++) {
      // OpenEXR addresses pixels by their window coordinates.
      char* origin =
          reinterpret_cast<char*>(&image.color[0][c]) -
          (ptrdiff_t(window.min.x) + ptrdiff_t(window.min.y) * width) * ptrdiff_t(sizeof(vec3));
      buffer.insert(names[size_t(c)],
                    Imf::Slice(Imf::FLOAT, origin, sizeof(vec3), sizeof(vec3) * size_t(width)));
    }
    exr.setFrameBuffer(buffer);
    exr.readPixels(window.min.y, window.max.y);
    if (grey)
      for (vec3& color : image.color) color = vec3(color.x);
    return image;
  } catch (const LoadError&) {
    throw;
  } catch (const std::exception& error) {
    throw LoadError(file, "", std::string("not readable as OpenEXR: ") + error.what());
  }
}

}  // namespace wellspring::image
