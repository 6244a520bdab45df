// SPDX-License-Identifier: Apache-2.0
#include "spectrum/tables.h"

#include <charconv>

namespace wellspring::spectrum {
namespace {

// Takes the text up to the next `end` off.
std::string_view take(std::string_view& text, char end) {
  const size_t size = std::min(text.find(end), text.size());
  const std::string_view taken = text.substr(0, size);
  text.remove_prefix(std::min(size + 1, text.size()));
  return taken;
}

double number_of(std::string_view text) {
  double number = 0;
  std::from_chars(text.data(), text.data() + text.size(), number);
  return number;
}

}  // namespace

StandardTables read_standard(std::string_view csv) {
  StandardTables tables;
  bool has_names = false;
  while (!csv.empty()) {
    std::string_view line = take(csv, '\n');
    if (line.empty() || line.front() == '#') continue;
    const std::string_view first = take(line, ',');
    for (size_t i = 0; !line.empty(); i++) {
      const std::string_view cell = take(line, ',');
      if (!has_names) {
        tables.emplace_back(std::string(cell), SpectrumTable{});
      } else {
        tables[i].second.nm.push_back(number_of(first));
        tables[i].second.value.push_back(number_of(cell));
      }
    }
    has_names = true;
  }
  return tables;
}

}  // namespace wellspring::spectrum
