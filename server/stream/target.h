// SPDX-License-Identifier: Apache-2.0
// The target of a request line ("/a/b?c=d") to path and query. Strict, so that whoever gets the
// path may append it to a folder's name: decoded once, no "." or ".." or empty segments, no
// backslash, no control characters, no encoded slash, nothing that a second decoding would turn
// into one of these.
#pragma once
#include <string>
#include <string_view>

#include "base/layers.h"
#include "wire/http.h"

namespace wellspring::stream {

inline constexpr size_t max_target_bytes = 2048;  // longer: 414
inline constexpr size_t max_query_fields = 32;    // more: 400

// Fills path and query. Returns 200, or the status to refuse with (400, 414).
int read_target(std::string_view target, HttpQuestion& question);

}  // namespace wellspring::stream
