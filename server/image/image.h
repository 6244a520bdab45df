// SPDX-License-Identifier: Apache-2.0
// Turns the bytes of picture files into pixels and back, by each format's own library. Readers take
// bytes of strangers: width and height are checked before anything is unpacked, and what is wrong
// is thrown as a LoadError that names `file`. Rows go from the top.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/vec.h"

namespace wellspring::image {

inline constexpr int largest_side = 16384;  // pixels

// Holds 8-bit sRGB, 3 bytes a pixel.
struct Image8 {
  int width = 0, height = 0;
  std::vector<uint8_t> rgb;
};

struct ImagePart {
  int x = 0, y = 0, width = 0, height = 0;  // pixels from the upper left
  bool operator==(const ImagePart&) const = default;
};

// Holds red, green, blue and alpha as they stand in a file: in `codes16` if it has 16 bits of each,
// else in `codes8`.
struct ImageCodes {
  int width = 0, height = 0;
  std::vector<uint8_t> codes8;
  std::vector<uint16_t> codes16;
};

// Holds linear colours.
struct LinearImage {
  int width = 0, height = 0;
  std::vector<vec3> color;
};
struct LinearView {
  int width = 0, height = 0;
  std::span<const vec3> color;
  std::span<const float> depth;  // empty: none
};

// Throws a LoadError if a side is too long or the picture has more pixels than `most_pixels`.
void check_size(int width, int height, int64_t most_pixels, const std::string& file);

// Reads PNG, JPEG or WebP, which it tells apart by their first bytes. Colour profiles and gamma are
// left alone, as glTF has it (2.0, section 3.8.2).
ImageCodes decode_codes(std::span<const uint8_t> bytes, int64_t most_pixels,
                        const std::string& file);
// Read one of them.
ImageCodes decode_png(std::span<const uint8_t> bytes, int64_t most_pixels, const std::string& file);
ImageCodes decode_webp(std::span<const uint8_t> bytes, int64_t most_pixels,
                       const std::string& file);
// Refuses files that end too early. Others of which libjpeg only warns are shown, as every browser
// does.
ImageCodes decode_jpeg_codes(std::span<const uint8_t> bytes, int64_t most_pixels,
                             const std::string& file);
// Reads a JPEG of four inks as it stands in the file: cyan, magenta, yellow, black.
ImageCodes decode_cmyk_jpeg(std::span<const uint8_t> bytes, const std::string& file);
// Refuses whatever libjpeg warns of.
Image8 decode_jpeg(std::span<const uint8_t> bytes, const std::string& file);

// Encodes a picture. quality: 1..100; full_chroma: 4:4:4 instead of 4:2:0. Overwrites what follows
// the first `skip` bytes of `out`, which is grown to hold them; nothing but `out` is kept
// afterwards.
void encode_jpeg(const Image8& image, int quality, bool full_chroma, std::vector<uint8_t>& out,
                 size_t skip = 0);
// Encodes a part of the picture likewise; it must lie within the picture.
void encode_jpeg(const Image8& image, const ImagePart& part, int quality, bool full_chroma,
                 std::vector<uint8_t>& out, size_t skip = 0);
// Inserts a comment of at most 65533 bytes (longer ones are cut) behind the beginning of a JPEG
// file.
void add_jpeg_comment(const std::string& comment, std::vector<uint8_t>& jpeg);
// Writes `comment` as a text of that name, unless it is empty.
std::vector<uint8_t> encode_png(const Image8& image, const std::string& comment,
                                const std::string& file);

// Reads Radiance .hdr; what is no number above 0 becomes 0.
LinearImage decode_hdr(std::span<const uint8_t> bytes, int64_t most_pixels,
                       const std::string& file);
// PFM (netpbm, http://www.pauldebevec.com/Research/HDR/PFM/) has no depth.
std::vector<char> encode_pfm(const LinearView& image);
LinearImage decode_pfm(const std::string& bytes, const std::string& file);
// OpenEXR is written in 32-bit floats, ZIP, with depth as channel Z. Scan lines or tiles are read,
// half or float: channels R, G, B, or Y alone, or the first layer that has them.
std::vector<char> encode_exr(const LinearView& image, const std::string& file,
                             const std::string& comment = {});
LinearImage decode_exr(const std::string& bytes, const std::string& file);

}  // namespace wellspring::image
