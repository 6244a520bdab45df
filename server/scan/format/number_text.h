// SPDX-License-Identifier: Apache-2.0
// Reads numbers out of lines of text.
#pragma once
#include <charconv>
#include <string_view>

#include "base/layers.h"

namespace wellspring::scan {

inline bool separates(char letter) {
  return letter == ' ' || letter == '\t' || letter == ',' || letter == ';';
}

// Reads the next number, and passes it and the separators before it. Returns 0 at the line's end,
// -1 for what is no number, else 1. "nan" and "inf" are numbers.
inline int next_number(const char*& at, const char* end, double& value) {
  while (at < end && separates(*at)) at++;
  if (at == end) return 0;
  if (*at == '+') at++;
  const auto read = std::from_chars(at, end, value);
  // A number too large or too small for a double keeps its bytes, and no value.
  if (read.ec == std::errc::result_out_of_range) value = 0;
  else if (read.ec != std::errc()) return -1;
  if (read.ptr < end && !separates(*read.ptr)) return -1;
  at = read.ptr;
  return 1;
}

// Returns the word at a place, for messages.
inline std::string_view word_at(const char* at, const char* end) {
  const char* stop = at;
  while (stop < end && !separates(*stop) && stop - at < 40) stop++;
  return {at, size_t(stop - at)};
}

}  // namespace wellspring::scan
