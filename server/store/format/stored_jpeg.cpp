// SPDX-License-Identifier: Apache-2.0
#include "store/format/stored_jpeg.h"

#include <algorithm>
#include <string_view>

namespace wellspring::store {
namespace {

using JpegBytes = std::span<const uint8_t>;

constexpr uint8_t adobe_size = 14;  // bytes of Adobe's segment

bool is_frame(int marker) {
  return marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
}

// Says whether a segment tells about the file: APP0 to APP15, a comment.
bool is_about_file(int marker) { return (marker >= 0xe0 && marker <= 0xef) || marker == 0xfe; }

// Copies the segments before the scan for which `keeps` holds, then all from the scan on if there
// is one. Returns false if it is broken.
template <class Keeps>
bool copy_segments(JpegBytes from, const Keeps& keeps, StoredJpeg& into, bool& scanned) {
  if (from.size() < 4 || from[0] != 0xff || from[1] != 0xd8) return false;
  for (size_t at = 2; at + 2 <= from.size();) {
    if (from[at] != 0xff) return false;
    const int marker = from[at + 1];
    if (marker == 0xff) {
      at++;
      continue;
    }
    if (marker == 0xd9) return true;
    if (at + 4 > from.size()) return false;
    const size_t size = size_t(from[at + 2]) << 8 | from[at + 3];
    if (size < 2 || at + 2 + size > from.size()) return false;
    const JpegBytes data = from.subspan(at + 4, size - 2);
    if (marker == 0xda) {
      into.bytes.insert(into.bytes.end(), from.begin() + ptrdiff_t(at), from.end());
      scanned = true;
      return true;
    }
    if (is_frame(marker)) {
      // Browsers read 8 bits, sequential or progressive, in Huffman's code.
      if (marker > 0xc2 || data.size() < 6 || data[0] != 8) return false;
      into.height = data[1] << 8 | data[2], into.width = data[3] << 8 | data[4];
      into.channels = data[5];
    }
    if (keeps(marker, data))
      into.bytes.insert(into.bytes.end(), from.begin() + ptrdiff_t(at),
                        from.begin() + ptrdiff_t(at + 2 + size));
    at += 2 + size;
  }
  return true;
}

StoredJpeg finished(StoredJpeg jpeg, bool good) {
  if (!good || jpeg.width < 1 || jpeg.height < 1) return {};
  const size_t size = jpeg.bytes.size();
  if (jpeg.bytes[size - 2] != 0xff || jpeg.bytes[size - 1] != 0xd9)
    jpeg.bytes.insert(jpeg.bytes.end(), {0xff, 0xd9});
  return jpeg;
}

}  // namespace

StoredJpeg join_tiff_jpeg(JpegBytes tables, JpegBytes data, JpegColors colors) {
  StoredJpeg jpeg;
  jpeg.bytes.reserve(tables.size() + data.size() + adobe_size + 8);
  jpeg.bytes = {0xff, 0xd8};
  if (colors != JpegColors::grey)
    jpeg.bytes.insert(jpeg.bytes.end(), {0xff, 0xee, 0, adobe_size, 'A', 'd', 'o', 'b', 'e', 0, 100,
                                         0, 0, 0, 0, uint8_t(colors)});
  bool scanned = false;
  const auto keeps = [](int marker, JpegBytes) { return !is_about_file(marker); };
  const bool has_tables = tables.empty() || copy_segments(tables, keeps, jpeg, scanned);
  const bool good = has_tables && !scanned && copy_segments(data, keeps, jpeg, scanned) && scanned;
  return finished(std::move(jpeg), good);
}

StoredJpeg take_jpeg_file(JpegBytes data) {
  StoredJpeg jpeg;
  jpeg.bytes.reserve(data.size());
  jpeg.bytes = {0xff, 0xd8};
  const auto keeps = [](int marker, JpegBytes about) {
    const auto is = [&](std::string_view name) {
      return about.size() > name.size() && std::equal(name.begin(), name.end(), about.begin());
    };
    return !(marker == 0xe1 && is("Exif")) && !(marker == 0xe2 && is("ICC_PROFILE"));
  };
  bool scanned = false;
  const bool good = copy_segments(data, keeps, jpeg, scanned) && scanned;
  return finished(std::move(jpeg), good);
}

}  // namespace wellspring::store
