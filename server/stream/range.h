// SPDX-License-Identifier: Apache-2.0
// Parts of files, as players of films ask for them: RFC 9110, section 14.
#pragma once
#include <optional>

#include "base/layers.h"
#include "wire/http.h"

namespace wellspring::stream {

struct ByteRange {
  uint64_t begin = 0, size = 0;  // size 0: outside of the file
};
// The range that the header's value "bytes=FIRST-LAST", "bytes=FIRST-" or "bytes=-LENGTH" means in
// a file of `size` bytes. Nothing: to be ignored, because it is none of these; several ranges are
// not given, which a server may choose.
std::optional<ByteRange> read_range(const std::string& value, uint64_t size);

// Makes a reply of 200 with a file one of 206 with the part asked for, or 416 where there is none.
// Stays as it is where the asker wants no range, or has a part of another version (If-Range).
void narrow_to_range(const HttpQuestion& question, HttpReply& reply);

}  // namespace wellspring::stream
