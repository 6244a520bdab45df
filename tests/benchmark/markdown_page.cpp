// SPDX-License-Identifier: Apache-2.0
#include "markdown_page.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <map>

namespace wellspring::test {

using nlohmann::json;

namespace {

constexpr size_t page_width = 100;
constexpr const char* nothing = "-";  // stands where a figure is missing

using Cells = std::vector<std::string>;

struct Lines {
  std::vector<Cells> rows;  // the first one is the heading
  size_t left_out = 0;
};

std::string show_value(const json& value, double scale = 1) {
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_number()) return format_figure(scale * value.get<double>());
  if (value.is_string()) return escape_cell(value.get<std::string>());
  return value.is_null() ? nothing : escape_cell(value.dump());
}

std::string text_of(const json& object, const std::string& key) {
  auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : "";
}

std::string report_of(const json& result) {
  std::string named = text_of(result, "report"), name = text_of(result, "name");
  return named.empty() ? name.substr(0, name.rfind('.')) : named;
}

std::string metric_of(const json& result) {
  std::string name = text_of(result, "name");
  return name.substr(name.rfind('.') + 1);
}

bool is_shown(const json& result, const std::vector<PageFilter>& only) {
  return std::all_of(only.begin(), only.end(), [&](const PageFilter& filter) {
    auto found = result.find(filter.field);
    return found != result.end() &&
           std::find(filter.values.begin(), filter.values.end(), *found) != filter.values.end();
  });
}

bool shows(const PageColumn& column, const json& result) {
  return column.metric == text_of(result, "name") || column.metric == metric_of(result);
}

bool has_words(std::string_view text, std::string_view words) {
  auto is_letter = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0; };
  for (size_t at = text.find(words); at != text.npos; at = text.find(words, at + 1)) {
    size_t end = at + words.size();
    if ((at == 0 || !is_letter(text[at - 1])) && (end == text.size() || !is_letter(text[end])))
      return true;
  }
  return false;
}

std::string heading_of(const PageColumn& column, const json& result) {
  std::string unit = column.unit;
  if (unit.empty() && column.field == "value") unit = text_of(result, "unit");
  if (unit == "1/s") unit = "a second";
  if (unit.empty() || unit == "1" || has_words(column.heading, unit))
    return escape_cell(column.heading);
  return escape_cell(column.heading + ", " + unit);
}

bool replaces(PageCell cell, const json& newer, const json& older) {
  if (!newer.is_number()) return false;
  if (!older.is_number()) return true;
  if (cell == PageCell::least) return newer.get<double>() < older.get<double>();
  if (cell == PageCell::most) return newer.get<double>() > older.get<double>();
  return cell == PageCell::last;
}

// Numbers keys in the order of their first appearance.
struct Order {
  std::vector<Cells> keys;
  std::map<Cells, size_t> places;
  size_t find(const Cells& key) {
    auto [at, is_new] = places.try_emplace(key, keys.size());
    if (is_new) keys.push_back(key);
    return at->second;
  }
};

Cells key_of(const PageTable& table, const json& result) {
  Cells key;
  for (const PageKey& row : table.rows) {
    auto found = result.find(row.field);
    key.push_back(found == result.end() ? nothing : show_value(*found));
  }
  return key;
}

// Fills a table. With `across` its columns are the values of that field, else the table's columns
// that have results.
Lines fill_table(const PageTable& table, const std::vector<json>& results) {
  struct Cell {
    json value;
    double scale = 1;
  };
  Order rows, columns;
  std::map<std::pair<size_t, size_t>, Cell> cells;
  std::map<size_t, std::string> headings;
  for (size_t c = 0; c < table.columns.size(); c++)  // in the order of the declaration
    if (table.across.empty()) columns.find({std::to_string(c)});
  for (const json& result : results) {
    if (!is_shown(result, table.only)) continue;
    for (size_t c = 0; c < table.columns.size(); c++) {
      const PageColumn& column = table.columns[c];
      if (!shows(column, result)) continue;
      size_t row = rows.find(key_of(table, result)), place = c;
      if (!table.across.empty()) {
        auto found = result.find(table.across);
        if (found == result.end()) continue;
        place = columns.find({show_value(*found)});
      }
      headings.try_emplace(
          place, table.across.empty() ? heading_of(column, result) : columns.keys[place][0]);
      auto value = result.find(column.field);
      Cell& cell = cells[{row, place}];
      if (value == result.end()) continue;
      bool text = !value->is_number() && !value->is_null();
      if (text || replaces(table.cell, *value, cell.value)) cell = {*value, column.scale};
    }
  }
  Lines lines;
  if (rows.keys.empty()) return lines;
  Cells head;
  for (const PageKey& key : table.rows) head.push_back(escape_cell(key.heading));
  for (const auto& [place, heading] : headings) head.push_back(heading);
  lines.rows.push_back(head);
  for (size_t row = 0; row < rows.keys.size(); row++) {
    Cells line = rows.keys[row];
    for (const auto& [place, heading] : headings) {
      auto cell = cells.find({row, place});
      line.push_back(cell == cells.end() ? nothing
                                         : show_value(cell->second.value, cell->second.scale));
    }
    lines.rows.push_back(line);
  }
  return lines;
}

Lines turn(const Lines& flat) {
  Lines turned;
  if (flat.rows.size() < 2) return turned;
  turned.rows.push_back({"what", "value"});
  for (size_t c = 0; c < flat.rows[0].size(); c++)
    turned.rows.push_back({flat.rows[0][c], flat.rows[1][c]});
  return turned;
}

Lines list_results(const std::vector<json>& results) {
  Lines lines{{{"name", "value", "unit", "of"}}};
  for (const json& result : results) {
    std::string about;
    for (const auto& [key, field] : result.items())
      if (key != "name" && key != "metric" && key != "value" && key != "unit" && key != "report")
        about += (about.empty() ? "" : ", ") + escape_cell(key) + " " + show_value(field);
    lines.rows.push_back({show_value(result.value("name", json())),
                          show_value(result.value("value", json())),
                          escape_cell(text_of(result, "unit")), about});
  }
  return lines;
}

std::string line_of(const Cells& cells) {
  std::string line = "|";
  for (const std::string& cell : cells) line += " " + cell + " |";
  return line + "\n";
}

std::string print_table(Lines lines, size_t most_rows) {
  if (lines.rows.size() < 2) return "";
  if (lines.rows.size() > most_rows + 1) {
    lines.left_out = lines.rows.size() - 1 - most_rows;
    lines.rows.resize(most_rows + 1);
  }
  std::string text = line_of(lines.rows[0]);
  text += "|";
  for (size_t c = 0; c < lines.rows[0].size(); c++) text += " --- |";
  text += "\n";
  for (size_t row = 1; row < lines.rows.size(); row++) text += line_of(lines.rows[row]);
  if (lines.left_out > 0)
    text += "\n" + std::to_string(lines.left_out) + " more rows are in the JSON.\n";
  return text;
}

// Broken between words so that no line is longer than a page is wide.
std::string wrap(std::string_view text, size_t indent = 0) {
  std::string wrapped;
  size_t column = 0;
  while (!text.empty()) {
    size_t end = std::min(text.find(' '), text.size());
    if (end > 0 && column > 0) {
      bool fits = column + 1 + end <= page_width;
      wrapped += fits ? " " : "\n" + std::string(indent, ' ');
      column = fits ? column + 1 : indent;
    }
    wrapped += text.substr(0, end);
    column += end;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return wrapped + "\n";
}

int count_lines(const std::string& text) { return int(std::count(text.begin(), text.end(), '\n')); }

std::string print_head(const ReportPage& page) {
  std::string text =
      "<!-- Written by ./wellspring bench --markdown: what is changed here is lost. -->\n# " +
      page.report + "\n\n" + wrap(page.question) + "\n";
  for (const std::string& note : page.notes) text += wrap("- " + note, 2);
  return page.notes.empty() ? text : text + "\n";
}

std::string print_run(const json& report) {
  const json machine = report.value("machine", json::object());
  const json run = report.value("run", json::object());
  std::string date = text_of(run, "date"), cpu = text_of(machine, "cpu"),
              commit = text_of(run, "commit"), text;
  text = "Measured " + (date.empty() ? "at a date that is not known" : "on " + date) + ", " +
         (cpu.empty() ? "processor not known" : escape_cell(cpu)) + ", " +
         show_value(machine.value("cores", json())) + " cores";
  if (machine.contains("memory_gib")) text += ", " + show_value(machine["memory_gib"]) + " GiB";
  if (machine.contains("load_at_end"))
    text += ", load " + show_value(machine["load_at_end"]) + " at the end";
  if (!commit.empty()) text += ", commit " + escape_cell(commit);
  text = wrap(text + ".");
  std::string command = "./wellspring bench";
  bool is_quick = false;
  for (const json& word : run.value("arguments", json::array())) {
    if (!word.is_string()) continue;
    command += " " + word.get<std::string>();
    is_quick |= word == "--quick";
  }
  if (run.contains("arguments")) text += "\n    " + escape_cell(command) + "\n";
  if (is_quick) text += "\nA quick run: its figures are rough.\n";
  return text;
}

}  // namespace

std::string escape_cell(std::string_view text) {
  std::string escaped;
  for (char c : text) {
    if (c == '|') escaped += "\\|";
    else if (c == '<') escaped += "&lt;";
    else escaped += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  }
  return escaped;
}

std::string format_figure(double value) {
  if (!std::isfinite(value)) return nothing;
  double size = std::abs(value);
  char digits[400];
  std::snprintf(digits, sizeof digits, size >= 999.5 ? "%.0f" : "%.3g", size < 5e-5 ? 0 : size);
  std::string text = digits;
  if (size >= 999.5)
    for (size_t at = text.size(); at > 3;) text.insert(at -= 3, ",");
  return value < 0 && size >= 5e-5 ? "-" + text : text;
}

std::vector<std::string> reports_in(const json& report) {
  std::vector<std::string> names;
  for (const json& result : report.value("results", json::array())) {
    std::string name = report_of(result);
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return names;
}

ReportPage plain_page(const std::string& name) {
  return {name, "All that this report measures.", {}, {}};
}

int count_page_lines(const ReportPage& page) {
  constexpr int most_run_lines = 8;
  int lines = count_lines(print_head(page)) + most_run_lines;
  for (const PageTable& table : page.tables) {
    int caption = table.caption.empty() ? 0 : count_lines(wrap(table.caption)) + 1;
    lines += 1 + caption + 2 + table.most_rows + 2;
  }
  return lines;
}

std::string make_page(const ReportPage& page, const json& report) {
  std::vector<json> results;
  for (const json& result : report.value("results", json::array()))
    if (report_of(result) == page.report) results.push_back(result);
  std::string text = print_head(page) + print_run(report);
  auto append = [&](const std::string& caption, const std::string& table) {
    if (table.empty()) return;
    text += "\n" + (caption.empty() ? "" : wrap(caption) + "\n") + table;
  };
  for (const PageTable& table : page.tables) {
    Lines lines = fill_table(table, results);
    if (table.rows.empty() && table.across.empty()) lines = turn(lines);
    append(table.caption, print_table(std::move(lines), size_t(table.most_rows)));
  }
  if (page.tables.empty()) {
    int room = most_page_lines - count_page_lines(page) - 5;
    append("", print_table(list_results(results), size_t(std::max(room, 1))));
  }
  return text;
}

}  // namespace wellspring::test
