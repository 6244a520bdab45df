// SPDX-License-Identifier: Apache-2.0
#include "world/load/gltf_image.h"

#include <algorithm>
#include <cmath>
#include <csetjmp>
#include <cstring>
#include <memory>
#include <png.h>
#include <turbojpeg.h>
#include <webp/decode.h>

namespace wellspring::world {

PngReader::PngReader(std::span<const uint8_t> bytes) : left_(bytes) {
  png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, fail, [](png_structp, const char*) {});
  if (png_) info_ = png_create_info_struct(png_);
  if (info_) png_set_read_fn(png_, this, read);
  else problem = "out of memory";
}

PngReader::~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }

void PngReader::read(png_structp png, unsigned char* to, size_t count) {
  PngReader& reader = *static_cast<PngReader*>(png_get_io_ptr(png));
  if (count > reader.left_.size()) png_error(png, "the file is cut off");
  std::copy_n(reader.left_.begin(), count, to);
  reader.left_ = reader.left_.subspan(count);
}

void PngReader::fail(png_structp png, const char* what) {
  static_cast<PngReader*>(png_get_error_ptr(png))->problem = what;
  png_longjmp(png, 1);
}

// libpng leaves its functions by a long jump when a file is wrong. Nothing with a destructor may be
// made between the jump's two ends.
bool PngReader::read_head() {
  if (!info_ || setjmp(png_jmpbuf(png_))) return false;
  png_read_info(png_, info_);
  width = int(png_get_image_width(png_, info_));
  height = int(png_get_image_height(png_, info_));
  bits = png_get_bit_depth(png_, info_) == 16 ? 16 : 8;
  return true;
}

bool PngReader::read_texels(void* texels) {
  if (setjmp(png_jmpbuf(png_))) return false;
  png_set_expand(png_);       // expands palettes, fewer than eight bits, and a transparent colour
  png_set_gray_to_rgb(png_);  // turns grey into colour
  png_set_add_alpha(png_, 0xffff, PNG_FILLER_AFTER);  // adds alpha if there is none
  if (bits == 16) png_set_swap(png_);                 // to little-endian
  const int passes = png_set_interlace_handling(png_);
  png_read_update_info(png_, info_);
  const size_t row_bytes = png_get_rowbytes(png_, info_);
  if (row_bytes != size_t(width) * 4 * size_t(bits / 8)) png_error(png_, "rows of another length");
  for (int pass = 0; pass < passes; pass++)
    for (int row = 0; row < height; row++)
      png_read_row(png_, static_cast<unsigned char*>(texels) + size_t(row) * row_bytes, nullptr);
  png_read_end(png_, nullptr);
  return true;
}

}  // namespace wellspring::world

#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_HDR
#define STBI_NO_STDIO
#define STBI_MAX_DIMENSIONS 16384
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wsign-compare"
#include <stb_image.h>
#pragma GCC diagnostic pop

namespace wellspring::world {
namespace {

struct Free {
  void operator()(void* p) const { stbi_image_free(p); }
};

float decode_srgb16(uint16_t code) {
  float s = float(code) / 65535.0f;
  return s <= 0.04045f ? s / 12.92f : std::pow((s + 0.055f) / 1.055f, 2.4f);
}

bool starts_with(std::span<const uint8_t> bytes, const char* magic, size_t length) {
  return bytes.size() >= length && std::memcmp(bytes.data(), magic, length) == 0;
}

struct CloseHandle {
  void operator()(void* handle) const { tjDestroy(handle); }
};

std::string problem_of(void* jpeg) {
  return std::string("picture cannot be decoded: ") + tjGetErrorStr2(jpeg);
}

// Returns what is wrong with width and height, which come from the header alone, so that a bomb is
// refused before it is unpacked.
std::string check_size(int width, int height, int64_t texels_left) {
  if (width > image_side_limit || height > image_side_limit)
    return "picture of " + std::to_string(width) + "x" + std::to_string(height) +
           " is larger than " + std::to_string(image_side_limit) + " a side";
  if (int64_t(width) * height > texels_left) return "pictures have too many texels in total";
  return "";
}

// Decodes a JPEG. Files that end too early are refused; others of which libjpeg only warns are
// shown, as every browser does.
std::string decode_jpeg_texels(std::span<const uint8_t> bytes, Image& image, int64_t texels_left) {
  const std::unique_ptr<void, CloseHandle> jpeg(tjInitDecompress());
  if (!jpeg) return problem_of(nullptr);
  int chroma = 0, colors = 0;
  if (tjDecompressHeader3(jpeg.get(), bytes.data(), bytes.size(), &image.width, &image.height,
                          &chroma, &colors) != 0)
    return problem_of(jpeg.get());
  if (std::string problem = check_size(image.width, image.height, texels_left); !problem.empty())
    return problem;
  image.texels8.resize(size_t(image.width) * size_t(image.height) * 4);
  if (tjDecompress2(jpeg.get(), bytes.data(), bytes.size(), image.texels8.data(), image.width, 0,
                    image.height, TJPF_RGBA, TJFLAG_LIMITSCANS) == 0)
    return "";
  const std::string_view told = tjGetErrorStr2(jpeg.get());
  const bool shown = tjGetErrorCode(jpeg.get()) == TJERR_WARNING;
  return shown && told.find("remature end") == told.npos ? "" : problem_of(jpeg.get());
}

std::string decode_png_texels(std::span<const uint8_t> bytes, bool srgb, Image& image,
                              int64_t texels_left) {
  PngReader png(bytes);
  const auto cannot = [&] { return "picture cannot be decoded: " + png.problem; };
  if (!png.read_head()) return cannot();
  if (std::string problem = check_size(png.width, png.height, texels_left); !problem.empty())
    return problem;
  image.width = png.width, image.height = png.height;
  const size_t count = size_t(image.width) * size_t(image.height);
  if (png.bits == 8) {
    image.texels8.resize(count * 4);
    return png.read_texels(image.texels8.data()) ? "" : cannot();
  }
  std::vector<uint16_t> codes(count * 4);
  if (!png.read_texels(codes.data())) return cannot();
  image.texels.resize(count);
  for (size_t i = 0; i < count; i++)
    for (int c = 0; c < 4; c++) {
      const uint16_t code = codes[4 * i + size_t(c)];
      image.texels[i][c] = srgb && c < 3 ? decode_srgb16(code) : float(code) / 65535.0f;
    }
  return "";
}

std::string decode_webp_texels(std::span<const uint8_t> bytes, Image& image, int64_t texels_left) {
  WebPBitstreamFeatures features;
  if (WebPGetFeatures(bytes.data(), bytes.size(), &features) != VP8_STATUS_OK)
    return "picture cannot be decoded: its WebP header is broken";
  if (features.has_animation) return "picture is a moving one (WebP)";
  if (std::string problem = check_size(features.width, features.height, texels_left);
      !problem.empty())
    return problem;
  image.width = features.width, image.height = features.height;
  image.texels8.resize(size_t(image.width) * size_t(image.height) * 4);
  if (!WebPDecodeRGBAInto(bytes.data(), bytes.size(), image.texels8.data(), image.texels8.size(),
                          4 * image.width))
    return "picture cannot be decoded: its WebP data is broken or cut off";
  return "";
}

}  // namespace

std::string decode_image(std::span<const uint8_t> bytes, bool srgb, Image& image,
                         int64_t& texels_left) {
  const bool png = starts_with(bytes, "\x89PNG\r\n\x1a\n", 8);
  const bool webp = starts_with(bytes, "RIFF", 4) && bytes.size() >= 12 &&
                    std::memcmp(bytes.data() + 8, "WEBP", 4) == 0;
  std::string problem;
  if (png) problem = decode_png_texels(bytes, srgb, image, texels_left);
  else if (webp) problem = decode_webp_texels(bytes, image, texels_left);
  else if (starts_with(bytes, "\xff\xd8\xff", 3))
    problem = decode_jpeg_texels(bytes, image, texels_left);
  else problem = "picture is neither PNG, JPEG nor WebP";
  if (!problem.empty()) return problem;
  texels_left -= int64_t(image.width) * image.height;
  image.srgb = srgb && image.texels.empty();
  return "";
}

std::string decode_radiance(std::span<const uint8_t> bytes, Image& image) {
  if (!starts_with(bytes, "#?", 2)) return "not a Radiance .hdr picture";
  int width = 0, height = 0, components = 0;
  if (bytes.size() > size_t(INT32_MAX)) return "picture file is too large";
  if (!stbi_info_from_memory(bytes.data(), int(bytes.size()), &width, &height, &components))
    return std::string("picture cannot be decoded: ") + stbi_failure_reason();
  if (std::string problem = check_size(width, height, image_texel_limit / 4); !problem.empty())
    return problem;
  std::unique_ptr<float, Free> texels(stbi_loadf_from_memory(
      bytes.data(), int(bytes.size()), &image.width, &image.height, &components, 3));
  if (!texels) return std::string("picture cannot be decoded: ") + stbi_failure_reason();
  size_t count = size_t(image.width) * size_t(image.height);
  image.srgb = false;
  image.texels.resize(count);
  for (size_t i = 0; i < count; i++) {
    const float* t = texels.get() + 3 * i;
    for (int c = 0; c < 3; c++) image.texels[i][c] = std::isfinite(t[c]) && t[c] > 0 ? t[c] : 0;
    image.texels[i].w = 1;
  }
  return "";
}

}  // namespace wellspring::world
