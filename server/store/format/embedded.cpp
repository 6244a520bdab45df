// SPDX-License-Identifier: Apache-2.0
#include "store/format/embedded.h"

#include <algorithm>
#include <map>
#include <string_view>
#include <zlib.h>

namespace wellspring::store {
namespace {

using FileBytes = std::span<const uint8_t>;

constexpr size_t most_unpacked_bytes = size_t(16) << 20;

bool begins(FileBytes bytes, std::string_view with) {
  return bytes.size() >= with.size() &&
         std::equal(with.begin(), with.end(), bytes.begin(),
                    [](char a, uint8_t b) { return uint8_t(a) == b; });
}
// Reads a whole number at the beginning; `bytes` are enough.
uint32_t big(FileBytes bytes, int count) {
  uint32_t value = 0;
  for (int i = 0; i < count; i++) value = value << 8 | bytes[size_t(i)];
  return value;
}
uint32_t little(FileBytes bytes, int count) {
  uint32_t value = 0;
  for (int i = count; i-- > 0;) value = value << 8 | bytes[size_t(i)];
  return value;
}

// Reads the orientation of an EXIF block, which is a TIFF of its own (EXIF 2.3, section 4.5).
Orientation read_exif(FileBytes exif) {
  const bool is_big = begins(exif, "MM");
  if (exif.size() < 8 || (!is_big && !begins(exif, "II"))) return {};
  const auto number = [&](size_t at, int count) {
    return is_big ? big(exif.subspan(at), count) : little(exif.subspan(at), count);
  };
  const size_t list = number(4, 4);
  if (list > exif.size() - 2 || number(2, 2) != 42) return {};
  const size_t count = number(list, 2);
  for (size_t i = 0; i < count; i++) {
    const size_t at = list + 2 + 12 * i;
    if (at + 12 > exif.size()) break;
    constexpr uint32_t orientation = 0x112, u16 = 3, u32 = 4;
    if (number(at, 2) != orientation) continue;
    const uint32_t type = number(at + 2, 2);
    const uint32_t code = type == u16 ? number(at + 8, 2) : type == u32 ? number(at + 8, 4) : 0;
    return {code >= 1 && code <= 8 ? int(code) : 1};
  }
  return {};
}

// Unpacks a zlib stream, up to a bound; empty: broken or too long.
std::vector<uint8_t> inflate_profile(FileBytes packed) {
  std::vector<uint8_t> out;
  z_stream stream{};
  if (inflateInit(&stream) != Z_OK) return out;
  stream.next_in = const_cast<Bytef*>(packed.data());
  stream.avail_in = uInt(packed.size());
  int state = Z_OK;
  while (state == Z_OK && out.size() < most_unpacked_bytes) {
    const size_t size = out.size();
    out.resize(std::max<size_t>(4096, 2 * size));
    stream.next_out = out.data() + size;
    stream.avail_out = uInt(out.size() - size);
    state = inflate(&stream, Z_NO_FLUSH);
    out.erase(out.end() - ptrdiff_t(stream.avail_out), out.end());
    if (stream.avail_out > 0 && state == Z_OK) break;
  }
  inflateEnd(&stream);
  if (state != Z_STREAM_END) out.clear();
  return out;
}

// PNG, third edition, sections 5.3 and 11.
Embedded find_in_png(FileBytes bytes) {
  Embedded found;
  for (size_t at = 8; at + 12 <= bytes.size();) {
    const FileBytes chunk = bytes.subspan(at);
    const size_t size = big(chunk, 4);
    if (size > chunk.size() - 12) break;
    const FileBytes type = chunk.subspan(4, 4), data = chunk.subspan(8, size);
    if (begins(type, "IHDR") && size >= 13) {
      found.width = big(data, 4), found.height = big(data.subspan(4), 4);
      found.channels = data[9] & 2 ? 3 : 1;
    } else if (begins(type, "eXIf")) {
      found.orientation = read_exif(data);
    } else if (begins(type, "iCCP")) {
      const auto name_end = std::ranges::find(data, 0);
      const size_t begin = size_t(name_end - data.begin()) + 2;  // 0, method
      if (begin <= data.size()) found.profile = inflate_profile(data.subspan(begin));
    }
    at += 12 + size;
  }
  return found;
}

// ITU-T T.81, annex B; ICC.1:2022, annex B.4; Adobe's marker (PostScript Technical Note 5116).
Embedded find_in_jpeg(FileBytes bytes) {
  using namespace std::string_view_literals;
  Embedded found;
  std::map<int, FileBytes> profile;  // by the number of its part
  for (size_t at = 2; at + 4 <= bytes.size();) {
    if (bytes[at] != 0xff) break;
    const int marker = bytes[at + 1];
    if (marker == 0xff) {
      at++;
      continue;
    }
    if (marker == 0xda || marker == 0xd9) break;
    const size_t size = big(bytes.subspan(at + 2), 2);
    if (size < 2 || at + 2 + size > bytes.size()) break;
    const FileBytes data = bytes.subspan(at + 4, size - 2);
    const bool is_frame =
        marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
    if (is_frame && data.size() >= 6) {
      found.height = big(data.subspan(1), 2), found.width = big(data.subspan(3), 2);
      found.channels = data[5];
    } else if (marker == 0xe1 && begins(data, "Exif\0\0"sv)) {
      if (found.orientation.is_upright()) found.orientation = read_exif(data.subspan(6));
    } else if (marker == 0xe2 && begins(data, "ICC_PROFILE\0"sv) && data.size() > 14) {
      profile[data[12]] = data.subspan(14);
    } else if (marker == 0xee && begins(data, "Adobe")) {
      found.is_inverted = true;
    }
    at += 2 + size;
  }
  for (const auto& [number, part] : profile)
    found.profile.insert(found.profile.end(), part.begin(), part.end());
  return found;
}

// https://developers.google.com/speed/webp/docs/riff_container
Embedded find_in_webp(FileBytes bytes) {
  using namespace std::string_view_literals;
  Embedded found;
  for (size_t at = 12; at + 8 <= bytes.size();) {
    const FileBytes chunk = bytes.subspan(at);
    const size_t size = little(chunk.subspan(4), 4);
    if (size > chunk.size() - 8) break;
    FileBytes data = chunk.subspan(8, size);
    if (begins(chunk, "ICCP")) found.profile.assign(data.begin(), data.end());
    if (begins(chunk, "EXIF"))
      found.orientation = read_exif(begins(data, "Exif\0\0"sv) ? data.subspan(6) : data);
    at += 8 + size + size % 2;
  }
  return found;
}

}  // namespace

Embedded find_embedded(FileBytes bytes) {
  if (begins(bytes, "\x89PNG\r\n\x1a\n")) return find_in_png(bytes);
  if (begins(bytes, "\xff\xd8")) return find_in_jpeg(bytes);
  if (begins(bytes, "RIFF")) return find_in_webp(bytes);
  return {};
}

}  // namespace wellspring::store
