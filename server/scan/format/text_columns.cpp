// SPDX-License-Identifier: Apache-2.0
#include "scan/format/text_columns.h"

#include <algorithm>
#include <cmath>

#include "scan/format/number_text.h"

namespace wellspring::scan {
namespace {

using Rows = std::vector<std::vector<double>>;

bool is_normal(const Rows& rows, size_t at) {
  size_t units = 0;
  for (const std::vector<double>& row : rows) {
    const double square = row[at] * row[at] + row[at + 1] * row[at + 1] + row[at + 2] * row[at + 2];
    if (std::abs(square - 1) < 0.02) units++;
    else if (square != 0) return false;  // a point without a normal has zeros, or nan
  }
  return units > 0;
}

bool is_color(const Rows& rows, size_t at) {
  double high = 0;
  bool is_whole = true;
  for (const std::vector<double>& row : rows)
    for (size_t i = at; i < at + 3; i++) {
      if (!(row[i] >= 0 && row[i] <= 65535)) return false;
      high = std::max(high, row[i]);
      is_whole = is_whole && row[i] == std::floor(row[i]);
    }
  return is_whole || high <= 1;
}

void name_three(std::vector<Role>& roles, size_t at, Role first) {
  for (int i = 0; i < 3; i++) roles[at + size_t(i)] = Role(int(first) + i);
}

}  // namespace

std::vector<Role> read_column_names(std::string_view line) {
  std::vector<Role> roles;
  while (!line.empty() && (line[0] == '/' || line[0] == '#' || separates(line[0])))
    line.remove_prefix(1);
  while (!line.empty()) {
    size_t end = 0;
    while (end < line.size() && !separates(line[end])) end++;
    std::string_view name = line.substr(0, end);
    if (name.size() >= 2 && name.front() == '"' && name.back() == '"')
      name = name.substr(1, name.size() - 2);
    Role role = role_named(name);
    if (std::ranges::find(roles, role) != roles.end()) role = Role::none;
    roles.push_back(role);
    while (end < line.size() && separates(line[end])) end++;
    line.remove_prefix(end);
  }
  for (const Role role : {Role::x, Role::y, Role::z})
    if (std::ranges::find(roles, role) == roles.end()) return {};
  return roles;
}

std::vector<Role> guess_columns(const Rows& rows, bool is_leica) {
  const size_t count = rows[0].size();
  std::vector<Role> roles(count, Role::none);
  name_three(roles, 0, Role::x);
  std::vector<bool> is_free(count, true);
  const auto fits = [&](size_t at) { return is_free[at] && is_free[at + 1] && is_free[at + 2]; };
  const auto claim = [&](size_t at, Role first) {
    name_three(roles, at, first);
    for (size_t i = at; i < at + 3; i++) is_free[i] = false;
  };
  for (size_t i = 0; i < 3; i++) is_free[i] = false;
  for (size_t at = 3; at + 3 <= count; at++)
    if (fits(at) && is_normal(rows, at)) {
      claim(at, Role::normal_x);
      break;
    }
  std::vector<size_t> colors;
  for (size_t at = 3; at + 3 <= count && colors.size() < 2; at++)
    if (fits(at) && is_color(rows, at)) colors.push_back(at);
  if (!colors.empty()) claim(is_leica ? colors.back() : colors.front(), Role::red);
  if (std::ranges::count(is_free, true) == 1)
    roles[size_t(std::ranges::find(is_free, true) - is_free.begin())] = Role::intensity;
  return roles;
}

}  // namespace wellspring::scan
