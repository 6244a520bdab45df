// SPDX-License-Identifier: Apache-2.0
#include "world/load/png_reader.h"

#include <png.h>

#include <algorithm>
#include <csetjmp>

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
  png_set_expand(png_);       // palettes, fewer than eight bits, and a colour that is transparent
  png_set_gray_to_rgb(png_);  // where it is grey
  png_set_add_alpha(png_, 0xffff, PNG_FILLER_AFTER);  // where it has none
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
