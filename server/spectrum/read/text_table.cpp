// SPDX-License-Identifier: Apache-2.0
#include "spectrum/read/text_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/load_error.h"

namespace wellspring::spectrum {
namespace {

constexpr size_t most_columns = 4096, most_cells = 4'000'000;
constexpr char blanks = ' ';  // as a separator: any run of blanks

std::string_view trim(std::string_view text) {
  const size_t begin = text.find_first_not_of(" \t\r");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

char separator_of(std::string_view line) {
  for (const char one : {'\t', ';', ','})
    if (line.find(one) != std::string_view::npos) return one;
  return blanks;
}

// Returns the cells of a line, without their quotes; one more than allowed if there are too many.
std::vector<std::string> split(std::string_view line, char separator) {
  std::vector<std::string> cells(1);
  bool is_quoted = false, is_between = false;  // between cells that blanks part
  for (const char c : line) {
    const bool is_separator = !is_quoted && (c == separator || (separator == blanks && c == '\t'));
    if (c == '"') is_quoted = !is_quoted;
    if (is_separator && !is_between) cells.emplace_back();
    is_between = is_separator && separator == blanks;
    if (!is_separator && c != '"') cells.back() += c;
    if (cells.size() > most_columns) break;
  }
  for (std::string& cell : cells) {
    cell = trim(cell);
    if (separator == ';' || separator == '\t') std::ranges::replace(cell, ',', '.');
  }
  return cells;
}

bool is_all_numbers(const std::vector<std::string>& cells) {
  double number = 0;
  return std::ranges::none_of(
      cells, [&](const std::string& cell) { return read_cell(cell, number) == CellKind::word; });
}

}  // namespace

CellKind read_cell(const std::string& cell, double& number) {
  if (cell.empty() || cell == "-") return CellKind::missing;
  const char* begin = cell.data() + (cell[0] == '+' ? 1 : 0);
  const char* end = cell.data() + cell.size();
  const auto [stop, error] = std::from_chars(begin, end, number);
  if (error == std::errc() && stop == end)
    return std::isnan(number)   ? CellKind::missing
           : std::isinf(number) ? CellKind::word
                                : CellKind::number;
  std::string lower = cell;
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
  return lower == "n/a" || lower == "na" || lower == "null" ? CellKind::missing : CellKind::word;
}

TextTable read_text_table(const std::string& file, std::string_view text) {
  TextTable table;
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);  // the mark of UTF-8
  char separator = 0;
  size_t cells = 0;
  for (int number = 1; !text.empty(); number++) {
    const size_t size = std::min(text.find('\n'), text.size());
    const std::string_view whole = text.substr(0, size), line = trim(whole);
    text.remove_prefix(std::min(size + 1, text.size()));
    if (line.empty() || line.front() == '#') continue;
    if (separator == 0) separator = separator_of(line);
    TextRow row{number, split(separator == '\t' ? whole : line, separator)};
    const std::string where = "line " + std::to_string(number);
    if (row.cells.size() > most_columns)
      throw LoadError(file, where, "there are more than 4096 columns");
    if ((cells += row.cells.size()) > most_cells)
      throw LoadError(file, where, "there are more than four million cells");
    if (table.names.empty() && table.rows.empty() && !is_all_numbers(row.cells)) {
      table.names = std::move(row.cells), table.names_line = number;
      continue;
    }
    const size_t wanted = table.names.empty() && !table.rows.empty() ? table.rows[0].cells.size()
                          : table.names.empty()                      ? row.cells.size()
                                                                     : table.names.size();
    if (row.cells.size() != wanted)
      throw LoadError(file, where,
                      "there are " + std::to_string(row.cells.size()) + " cells, but " +
                          std::to_string(wanted) + " columns");
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace wellspring::spectrum
