// SPDX-License-Identifier: Apache-2.0
#include "base/unicode.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <memory>
#include <utf8proc.h>
#include <vector>

namespace wellspring {

std::string nfc(std::string_view text) {
  const bool plain = std::all_of(text.begin(), text.end(), [](char c) { return (c & 0x80) == 0; });
  if (plain) return std::string(text);
  utf8proc_uint8_t* made = nullptr;
  const utf8proc_ssize_t length = utf8proc_map(
      reinterpret_cast<const utf8proc_uint8_t*>(text.data()), utf8proc_ssize_t(text.size()), &made,
      utf8proc_option_t(UTF8PROC_STABLE | UTF8PROC_COMPOSE));
  const std::unique_ptr<utf8proc_uint8_t, void (*)(void*)> owned(made, std::free);
  if (length < 0) return std::string(text);
  return std::string(reinterpret_cast<const char*>(made), size_t(length));
}

namespace {

constexpr int edit = 4, other_case = 1;  // costs of edits
constexpr size_t longest = 100;          // names of more letters are not compared

int cost_of(char a, char b) {
  if (a == b) return 0;
  auto small = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
  return small(a) == small(b) ? other_case : edit;
}

// Returns the distance of Damerau 1964, each letter swapped at most once ("optimal string
// alignment").
int distance(std::string_view a, std::string_view b) {
  std::vector<int> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (size_t j = 0; j <= b.size(); j++) last[j] = int(j) * edit;
  for (size_t i = 1; i <= a.size(); i++) {
    row[0] = int(i) * edit;
    for (size_t j = 1; j <= b.size(); j++) {
      row[j] =
          std::min({last[j] + edit, row[j - 1] + edit, last[j - 1] + cost_of(a[i - 1], b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], before[j - 2] + edit);
    }
    std::swap(before, last);
    std::swap(last, row);
  }
  return last[b.size()];
}

}  // namespace

std::string did_you_mean(std::string_view name, std::span<const std::string> known) {
  if (name.empty() || name.size() > longest) return "";
  const std::string* nearest = nullptr;
  int least = 0;
  for (const std::string& other : known) {
    if (other.empty() || other.size() > longest) continue;
    int cost = distance(name, other);
    size_t letters = std::max(name.size(), other.size());
    bool is_near = cost <= int(letters) * edit / 3 && cost < int(letters) * edit;
    if (is_near && (!nearest || cost < least)) nearest = &other, least = cost;
  }
  return nearest ? "; did you mean '" + *nearest + "'?" : "";
}

std::string list_names(std::span<const std::string> known, size_t most) {
  std::string list;
  for (size_t i = 0; i < std::min(known.size(), most); i++)
    list += (list.empty() ? "" : ", ") + known[i];
  if (known.size() > most) list += " and " + std::to_string(known.size() - most) + " more";
  return list;
}

}  // namespace wellspring
