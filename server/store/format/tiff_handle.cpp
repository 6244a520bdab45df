// SPDX-License-Identifier: Apache-2.0
#include "store/format/tiff_handle.h"

#include <algorithm>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <tiffio.h>
#include <unistd.h>

#include "base/load_error.h"

namespace wellspring::store {
namespace {

TiffHandle& handle_of(thandle_t handle) { return *static_cast<TiffHandle*>(handle); }

tmsize_t read_bytes(thandle_t handle, void* to, tmsize_t count) {
  TiffHandle& self = handle_of(handle);
  tmsize_t done = 0;
  while (done < count) {
    const ssize_t got = pread(self.descriptor, static_cast<char*>(to) + done, size_t(count - done),
                              off_t(self.position));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) break;
    done += got, self.position += uint64_t(got);
  }
  return done;
}
tmsize_t write_nothing(thandle_t, void*, tmsize_t) { return -1; }
toff_t seek(thandle_t handle, toff_t offset, int from) {
  TiffHandle& self = handle_of(handle);
  self.position = offset + (from == SEEK_CUR ? self.position : from == SEEK_END ? self.size : 0);
  return self.position;
}
int close_nothing(thandle_t) { return 0; }
toff_t size_of(thandle_t handle) { return handle_of(handle).size; }
int keep_error(TIFF*, void* handle, const char*, const char* format, va_list values) {
  char text[256];
  std::vsnprintf(text, sizeof text, format, values);
  if (handle_of(handle).problem.empty()) handle_of(handle).problem = text;
  return 1;
}
int ignore_warning(TIFF*, void*, const char*, const char*, va_list) { return 1; }

}  // namespace

TiffHandle::TiffHandle(const std::string& file, int descriptor, uint64_t size, int64_t most_bytes)
    : descriptor(descriptor), size(size) {
  TIFFOpenOptions* options = TIFFOpenOptionsAlloc();
  if (!options) throw std::bad_alloc();
  TIFFOpenOptionsSetMaxSingleMemAlloc(options, most_bytes);
  TIFFOpenOptionsSetErrorHandlerExtR(options, keep_error, this);
  TIFFOpenOptionsSetWarningHandlerExtR(options, ignore_warning, this);
  // Mode O reads the places of blocks when they are needed: large files have millions.
  tiff = TIFFClientOpenExt(file.c_str(), "rmO", this, read_bytes, write_nothing, seek,
                           close_nothing, size_of, nullptr, nullptr, options);
  TIFFOpenOptionsFree(options);
  if (!tiff) throw LoadError(file, "", "is no TIFF: " + problem);
}

TiffHandle::~TiffHandle() {
  if (tiff) TIFFClose(tiff);
}

bool TiffHandle::choose(const TiffPage& wanted) {
  if (page != wanted.offset) {
    page = 0;
    if (!TIFFSetSubDirectory(tiff, wanted.offset)) return false;
    page = wanted.offset;
    if (wanted.converts_jpeg) TIFFSetField(tiff, TIFFTAG_JPEGCOLORMODE, JPEGCOLORMODE_RGB);
  }
  return true;
}

template <class Number>
Number TiffHandle::field(uint32_t tag, Number otherwise) const {
  Number value = otherwise;
  return TIFFGetFieldDefaulted(tiff, tag, &value) ? value : otherwise;
}
template uint16_t TiffHandle::field(uint32_t, uint16_t) const;
template uint32_t TiffHandle::field(uint32_t, uint32_t) const;

bool TiffHandle::read_codes(const TiffPage& from, int column, int row, int channel,
                            std::vector<uint8_t>& bytes) {
  const uint32_t x = uint32_t(column) * uint32_t(from.block_width);
  const uint32_t y = uint32_t(row) * uint32_t(from.block_height);
  const uint16_t plane = uint16_t(from.is_planar ? channel : 0);
  const int64_t rows =
      from.is_tiled ? from.block_height : std::min<int64_t>(from.block_height, from.height - y);
  const int64_t codes = int64_t(from.block_width) * (from.is_planar ? 1 : from.channels);
  const int64_t wanted = rows * ((codes * from.bits + 7) / 8);
  bytes.assign(size_t(wanted), 0);
  const uint32_t block =
      from.is_tiled ? TIFFComputeTile(tiff, x, y, 0, plane) : TIFFComputeStrip(tiff, y, plane);
  const tmsize_t got = from.is_tiled ? TIFFReadEncodedTile(tiff, block, bytes.data(), wanted)
                                     : TIFFReadEncodedStrip(tiff, block, bytes.data(), wanted);
  if (got < 0) return false;
  if (got < wanted) problem = "is cut off";
  return got >= wanted;
}

bool TiffHandle::read_any(const TiffPage& from, int column, int row, Piece& block) {
  char why[1024] = "";
  TIFFRGBAImage image;
  const int64_t x = int64_t(column) * from.block_width, y = int64_t(row) * from.block_height;
  const uint32_t wide = uint32_t(std::min<int64_t>(from.block_width, from.width - x));
  const uint32_t high = uint32_t(std::min<int64_t>(from.block_height, from.height - y));
  block = make_piece(int(wide), int(high));
  bool done = TIFFRGBAImageBegin(&image, tiff, 1, why);
  if (done) {
    image.req_orientation = image.orientation;  // leaves rows as they are stored
    image.col_offset = int(x), image.row_offset = int(y);
    std::vector<uint32_t> raster(size_t(wide) * high);
    done = TIFFRGBAImageGet(&image, raster.data(), wide, high);
    TIFFRGBAImageEnd(&image);
    std::memcpy(block.bytes.data(), raster.data(), block.bytes.size());
  }
  if (!done && problem.empty()) problem = why;
  return done;
}

}  // namespace wellspring::store
