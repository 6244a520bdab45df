// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <csetjmp>
#include <png.h>

#include "base/load_error.h"
#include "image/image.h"

namespace wellspring::image {
namespace {

// libpng leaves its functions by a long jump when a file is wrong. Nothing with a destructor may be
// made between the jump's two ends.
struct Png {
  png_structp png = nullptr;
  png_infop info = nullptr;
  std::string problem = "out of memory";

  static void fail(png_structp png, const char* what) {
    static_cast<Png*>(png_get_error_ptr(png))->problem = what;
    png_longjmp(png, 1);
  }
  static void ignore(png_structp, const char*) {}
};

struct PngReader : Png {
  std::span<const uint8_t> left;        // bytes of the file that are not read yet
  int width = 0, height = 0, bits = 0;  // bits: of a channel

  explicit PngReader(std::span<const uint8_t> bytes) : left(bytes) {
    png = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, fail, ignore);
    if (png) info = png_create_info_struct(png);
    if (info) png_set_read_fn(png, this, read);
  }
  ~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }

  static void read(png_structp png, unsigned char* to, size_t count) {
    PngReader& reader = *static_cast<PngReader*>(png_get_io_ptr(png));
    if (count > reader.left.size()) png_error(png, "the file is cut off");
    std::copy_n(reader.left.begin(), count, to);
    reader.left = reader.left.subspan(count);
  }
  bool read_head() {
    if (!info || setjmp(png_jmpbuf(png))) return false;
    png_read_info(png, info);
    width = int(png_get_image_width(png, info));
    height = int(png_get_image_height(png, info));
    bits = png_get_bit_depth(png, info) == 16 ? 16 : 8;
    return true;
  }
  // Unpacks rows one after the other, so that a file takes no more memory than its width and height
  // say.
  bool read_texels(void* texels) {
    if (setjmp(png_jmpbuf(png))) return false;
    png_set_expand(png);       // expands palettes, fewer than eight bits, and a transparent colour
    png_set_gray_to_rgb(png);  // turns grey into colour
    png_set_add_alpha(png, 0xffff, PNG_FILLER_AFTER);  // adds alpha if there is none
    if (bits == 16) png_set_swap(png);                 // to little-endian
    const int passes = png_set_interlace_handling(png);
    png_read_update_info(png, info);
    const size_t row_bytes = png_get_rowbytes(png, info);
    if (row_bytes != size_t(width) * 4 * size_t(bits / 8)) png_error(png, "rows of another length");
    for (int pass = 0; pass < passes; pass++)
      for (int row = 0; row < height; row++)
        png_read_row(png, static_cast<unsigned char*>(texels) + size_t(row) * row_bytes, nullptr);
    png_read_end(png, nullptr);
    return true;
  }
};

struct PngWriter : Png {
  std::vector<uint8_t> bytes;

  PngWriter() {
    png = png_create_write_struct(PNG_LIBPNG_VER_STRING, this, fail, ignore);
    if (png) info = png_create_info_struct(png);
  }
  ~PngWriter() { png_destroy_write_struct(&png, &info); }

  static void put(png_structp png, unsigned char* from, size_t count) {
    auto& bytes = static_cast<PngWriter*>(png_get_io_ptr(png))->bytes;
    bytes.insert(bytes.end(), from, from + count);
  }
  bool write(const Image8& image, png_text* text, int texts) {
    if (!info || setjmp(png_jmpbuf(png))) return false;
    png_set_write_fn(png, this, put, nullptr);
    png_set_compression_level(png, 4);
    png_set_IHDR(png, info, png_uint_32(image.width), png_uint_32(image.height), 8,
                 PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_set_text(png, info, text, texts);
    png_write_info(png, info);
    for (int y = 0; y < image.height; y++)
      png_write_row(png, &image.rgb[3 * size_t(y) * size_t(image.width)]);
    png_write_end(png, nullptr);
    return true;
  }
};

}  // namespace

ImageCodes decode_png(std::span<const uint8_t> bytes, int64_t most_pixels,
                      const std::string& file) {
  PngReader png(bytes);
  const auto fail = [&] { throw LoadError(file, "", "picture cannot be decoded: " + png.problem); };
  if (!png.read_head()) fail();
  check_size(png.width, png.height, most_pixels, file);
  ImageCodes image{png.width, png.height, {}, {}};
  const size_t count = size_t(image.width) * size_t(image.height) * 4;
  png.bits == 8 ? image.codes8.resize(count) : image.codes16.resize(count);
  void* texels = image.codes8.data();
  if (png.bits == 16) texels = image.codes16.data();
  if (!png.read_texels(texels)) fail();
  return image;
}

std::vector<uint8_t> encode_png(const Image8& image, const std::string& comment,
                                const std::string& file) {
  std::string key = "Comment", value = comment;
  png_text text{};
  text.compression = PNG_TEXT_COMPRESSION_NONE;
  text.key = key.data();
  text.text = value.data();
  text.text_length = value.size();
  PngWriter writer;
  if (!writer.write(image, &text, comment.empty() ? 0 : 1))
    throw LoadError(file, "", "cannot be written as PNG: " + writer.problem);
  return std::move(writer.bytes);
}

}  // namespace wellspring::image
