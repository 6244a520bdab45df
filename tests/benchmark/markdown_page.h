// SPDX-License-Identifier: Apache-2.0
// A benchmark's report as a page of Markdown: a few tables of the figures that answer one question.
// A page is declared and made from a report's JSON (report.h): the same JSON
// gives the same page. A page has most_page_lines lines at most: what a table has no room for is
// counted and stays in the JSON.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace wellspring::test {

constexpr int most_page_lines = 60;

// Says what a column shows of a result.
struct PageColumn {
  // end of the results' name: "flip"; or a whole name, if two metrics are alike
  std::string metric;
  std::string heading;  // heading; the unit is put behind it unless it has it
  double scale = 1;
  std::string unit = {};        // unit of the scaled value; empty: the result's own
  std::string field = "value";  // field of the result that is shown
};

struct PageKey {
  std::string field, heading;
};

struct PageFilter {
  std::string field;
  std::vector<nlohmann::json> values;
};

// Says which result is shown if several fall into one cell.
enum class PageCell { first, last, least, most };

// Rows are in the order of the results.
struct PageTable {
  std::string caption;
  std::vector<PageKey> rows = {};  // fields that tell rows apart; none: each column is a row
  std::vector<PageColumn> columns = {};
  std::string across = {};            // with one column: a field whose values stand side by side
  std::vector<PageFilter> only = {};  // results with other values are left out
  PageCell cell = PageCell::last;
  int most_rows = 10;
};

struct ReportPage {
  std::string report;                   // its name for --only
  std::string question;                 // question that the report answers
  std::vector<std::string> notes = {};  // how its figures are to be read
  std::vector<PageTable> tables = {};
};

// The reports that have results in this JSON, in their order. Results of older JSON files belong
// to the report that their names begin with.
std::vector<std::string> reports_in(const nlohmann::json& report);

// `report` is what BenchReport::save wrote; results of other reports are left out, and so are
// tables without any result.
std::string make_page(const ReportPage& page, const nlohmann::json& report);

// A page for a report without a declared one: each result in a row of its own.
ReportPage plain_page(const std::string& name);

// The most lines that the page can have, whatever the results.
int count_page_lines(const ReportPage& page);

// Three digits, or all that are before the point: 0.0372, 60.1, 47,600.
std::string format_figure(double value);

// Returns a table cell's text: without line ends, | as \|.
std::string escape_cell(std::string_view text);

}  // namespace wellspring::test
