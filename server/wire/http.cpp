// SPDX-License-Identifier: Apache-2.0
#include "wire/http.h"

#include <limits>
#include <stdexcept>
#include <zlib.h>

namespace wellspring::wire {

bool is_text(std::string_view content_type) {
  const std::string_view type = content_type.substr(0, content_type.find(';'));
  return type.starts_with("text/") || type == "application/json" ||
         type == "application/manifest+json" || type == "image/svg+xml";
}

std::string gzip(std::string_view text) {
  if (text.empty()) return {};
  if (text.size() > std::numeric_limits<uInt>::max())
    throw std::length_error("gzip: a text of 4 GiB or more");
  constexpr int gzip_window = 15 + 16;  // 32 KiB; 16: with the header and trailer of gzip
  constexpr int most_memory = 9;
  z_stream stream{};
  if (deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, gzip_window, most_memory,
                   Z_DEFAULT_STRATEGY) != Z_OK)
    throw std::runtime_error("gzip: zlib does not start");
  std::string packed(text.size() - 1, '\0');  // a longer result is not wanted
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream.avail_in = uInt(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = uInt(packed.size());
  const bool fits = deflate(&stream, Z_FINISH) == Z_STREAM_END;
  packed.resize(fits ? size_t(stream.total_out) : 0);
  deflateEnd(&stream);
  return packed;
}

}  // namespace wellspring::wire
