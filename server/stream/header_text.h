// SPDX-License-Identifier: Apache-2.0
// Words of headers.
#pragma once
#include <string>
#include <string_view>

namespace wellspring::stream {

// Small letters of ASCII.
inline std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c += 'a' - 'A';
  return out;
}

// Without spaces and tabs around it.
inline std::string_view trimmed(std::string_view text) {
  const size_t begin = text.find_first_not_of(" \t");
  if (begin == text.npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t") + 1 - begin);
}

// Takes the next item off the front of a list that commas separate.
inline std::string_view take_item(std::string_view& list) {
  const std::string_view item = list.substr(0, list.find(','));
  list.remove_prefix(item.size() < list.size() ? item.size() + 1 : item.size());
  return trimmed(item);
}

}  // namespace wellspring::stream
