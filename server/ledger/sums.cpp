// SPDX-License-Identifier: Apache-2.0
#include "ledger/sums.h"

#include <charconv>
#include <chrono>
#include <cmath>
#include <fmt/core.h>

namespace wellspring::ledger {

using namespace std::chrono;

void add(Sums& to, const Sums& more) {
  for (const auto& [key, value] : more) to[key] += value;
}

std::string day_text(int64_t day) {
  const year_month_day date{sys_days{days{day}}};
  return fmt::format("{:04}-{:02}-{:02}", int(date.year()), unsigned(date.month()),
                     unsigned(date.day()));
}

std::optional<int64_t> parse_day(std::string_view text) {
  if (text.size() != 10 || text[4] != '-' || text[7] != '-') return {};
  auto number = [&](size_t from, size_t count) {
    int value = -1;
    const char* end = text.data() + from + count;
    auto [last, error] = std::from_chars(text.data() + from, end, value);
    return error == std::errc() && last == end ? value : -1;
  };
  const int y = number(0, 4), m = number(5, 2), d = number(8, 2);
  if (y < 0 || m < 0 || d < 0) return {};
  const year_month_day date{year{y}, month{unsigned(m)}, std::chrono::day{unsigned(d)}};
  if (!date.ok()) return {};
  return sys_days{date}.time_since_epoch().count();
}

namespace {

std::string field(const std::string& text) {
  std::string out;
  if (!text.empty() && std::string_view("=+-@\t\r").find(text[0]) != std::string_view::npos)
    out += '\'';
  for (char c : text) {
    if (c == '"') out += c;
    out += c;
  }
  if (text.find_first_of("\",\r\n") == std::string::npos) return out;
  return fmt::format("\"{}\"", out);
}

}  // namespace

std::string write_csv(const Sums& sums) {
  std::string out = "day,what,key,value\r\n";
  for (const auto& [key, value] : sums)
    out += fmt::format("{},{},{},{}\r\n", day_text(key.day), field(key.what), field(key.key),
                       std::round(10 * value) / 10);
  return out;
}

}  // namespace wellspring::ledger
