// SPDX-License-Identifier: Apache-2.0
// Pages made of reports: which figures stand where, and how long a page may be.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "benchmark/reports.h"

using namespace wellspring;

using namespace wellspring::test;

namespace {

using nlohmann::json;

bool has_line(const std::string& page, const std::string& line) {
  return ("\n" + page).find("\n" + line + "\n") != std::string::npos;
}

int count_lines(const std::string& page) { return int(std::count(page.begin(), page.end(), '\n')); }

size_t longest_text_line(const std::string& page) {
  std::istringstream in(page);
  size_t longest = 0;
  for (std::string line; std::getline(in, line);)
    if (!line.starts_with("|") && !line.starts_with("    "))
      longest = std::max(longest, line.size());
  return longest;
}

json result(const std::string& report, const std::string& name, double value,
            const std::string& unit, json fields = json::object()) {
  fields["report"] = report, fields["name"] = name, fields["unit"] = unit;
  fields["metric"] = name.substr(name.rfind('.') + 1);
  fields["value"] = value;
  return fields;
}

json warp_report() {
  json report = {{"machine", {{"cpu", "Some CPU"}, {"cores", 4}}},
                 {"run", {{"date", "2026-01-02"}, {"commit", "abc"}, {"arguments", {"--quick"}}}}};
  for (int age : {16, 300})
    for (const char* trace : {"turn", "stroll"}) {
      json fields = {{"trace", trace}, {"age_ms", age}};
      report["results"].push_back(result("warp", "warp.flip", 0.03721 * age, "FLIP", fields));
      if (age == 16)
        report["results"].push_back(result("warp", "warp.held", 0.25, "share", fields));
    }
  report["results"].push_back(result("other", "other.flip", 7, "FLIP", {{"trace", "turn"}}));
  return report;
}

const ReportPage warp_page = {
    "warp",
    "How good?",
    {"A note."},
    {{.caption = "All of it",
      .rows = {{"trace", "visit"}, {"age_ms", "age, ms"}},
      .columns = {{"flip", "FLIP"}, {"held", "held", 100, "%"}, {"never", "not there"}}}}};

}  // namespace

TEST(MarkdownPage, FiguresStandInTheirRowAndColumn) {
  std::string page = make_page(warp_page, warp_report());
  EXPECT_TRUE(has_line(page, "# warp"));
  EXPECT_TRUE(has_line(page, "How good?"));
  EXPECT_TRUE(has_line(page, "- A note."));
  EXPECT_TRUE(has_line(page, "All of it"));
  EXPECT_TRUE(has_line(page, "| visit | age, ms | FLIP | held, % |")) << page;
  EXPECT_TRUE(has_line(page, "| turn | 16 | 0.595 | 25 |")) << page;
  EXPECT_TRUE(has_line(page, "| stroll | 16 | 0.595 | 25 |"));
  EXPECT_TRUE(has_line(page, "| turn | 300 | 11.2 | - |")) << "missing values";
  EXPECT_EQ(page.find("not there"), std::string::npos) << "columns without results";
  EXPECT_EQ(page.find(" 7 "), std::string::npos) << "another report's results";
}

TEST(MarkdownPage, TellsOfMachineDateAndCommand) {
  std::string page = make_page(warp_page, warp_report());
  EXPECT_TRUE(has_line(page, "Measured on 2026-01-02, Some CPU, 4 cores, commit abc."));
  EXPECT_TRUE(has_line(page, "    ./wellspring bench --quick"));
  EXPECT_TRUE(has_line(page, "A quick run: its figures are rough."));
  json older = warp_report();
  older.erase("run");
  page = make_page(warp_page, older);
  EXPECT_TRUE(has_line(page, "Measured at a date that is not known, Some CPU, 4 cores.")) << page;
  EXPECT_EQ(page.find("bench --quick"), std::string::npos);
}

TEST(MarkdownPage, TheSameReportGivesTheSamePage) {
  EXPECT_EQ(make_page(warp_page, warp_report()), make_page(warp_page, warp_report()));
}

TEST(MarkdownPage, ValuesOfAFieldStandSideBySide) {
  ReportPage page = {"warp",
                     "",
                     {},
                     {{.caption = "",
                       .rows = {{"trace", "visit"}},
                       .columns = {{"flip", "FLIP"}},
                       .across = "age_ms",
                       .only = {{"trace", {"stroll"}}}}}};
  std::string text = make_page(page, warp_report());
  EXPECT_TRUE(has_line(text, "| visit | 16 | 300 |")) << text;
  EXPECT_TRUE(has_line(text, "| stroll | 0.595 | 11.2 |"));
  EXPECT_EQ(text.find("| turn"), std::string::npos);
}

TEST(MarkdownPage, ATableWithoutRowsListsItsColumns) {
  json report = {{"results",
                  {result("a", "a.fps", 60.06, "1/s"), result("a", "a.bytes", 108000, "B"),
                   result("a", "a.ratio", 0.5, "1", {{"lowest", 0.25}})}}};
  ReportPage page = {"a",
                     "",
                     {},
                     {{.caption = "",
                       .columns = {{"bytes", "a picture", 1e-3, "kB"},
                                   {"fps", "pictures a second"},
                                   {"ratio", "ratio"},
                                   {"ratio", "lowest", 1, "", "lowest"},
                                   {"ratio", "highest", 1, "", "highest"}}}}};
  std::string text = make_page(page, report);
  EXPECT_TRUE(has_line(text,
                       "| what | value |\n| --- | --- |\n| a picture, kB | 108 |\n"
                       "| pictures a second | 60.1 |\n| ratio | 0.5 |\n"
                       "| lowest | 0.25 |\n| highest | - |"))
      << text;
}

TEST(MarkdownPage, OneResultOfSeveralIsShown) {
  json report;
  for (double value : {3.0, 1.0, 2.0})
    report["results"].push_back(result("a", "a.ms", value, "ms"));
  report["results"].push_back(result("a", "a.ms", 0, "ms"));
  report["results"].back()["value"] = nullptr;  // as JSON writes what is no number
  auto shown = [&](PageCell cell) {
    ReportPage page = {"a", "", {}, {{.caption = "", .columns = {{"ms", "time"}}, .cell = cell}}};
    std::string text = make_page(page, report);
    return text.substr(text.rfind("time"));
  };
  EXPECT_EQ(shown(PageCell::first), "time, ms | 3 |\n");
  EXPECT_EQ(shown(PageCell::last), "time, ms | 2 |\n");
  EXPECT_EQ(shown(PageCell::least), "time, ms | 1 |\n");
  EXPECT_EQ(shown(PageCell::most), "time, ms | 3 |\n");
}

TEST(MarkdownPage, CellsStayWithinTheirTable) {
  EXPECT_EQ(escape_cell("a|b\nc<d"), "a\\|b c&lt;d");
  json report;
  report["results"].push_back(result("a", "a.ms", 1, "m|s", {{"scene", "x | y\nz"}}));
  ReportPage page = {
      "a", "", {}, {{.caption = "", .rows = {{"scene", "a|scene"}}, .columns = {{"ms", "time"}}}}};
  std::string text = make_page(page, report);
  EXPECT_TRUE(has_line(text, "| a\\|scene | time, m\\|s |\n| --- | --- |\n| x \\| y z | 1 |"))
      << text;
}

TEST(MarkdownPage, FiguresHaveThreeDigits) {
  EXPECT_EQ(format_figure(0.037213), "0.0372");
  EXPECT_EQ(format_figure(60.06), "60.1");
  EXPECT_EQ(format_figure(47600.4), "47,600");
  EXPECT_EQ(format_figure(999.7), "1,000");
  EXPECT_EQ(format_figure(-1234567), "-1,234,567");
  EXPECT_EQ(format_figure(-0.0012), "-0.0012");
  EXPECT_EQ(format_figure(1e-9), "0");
  EXPECT_EQ(format_figure(NAN), "-");
}

TEST(MarkdownPage, WhatHasNoRoomIsCounted) {
  json report;
  for (int i = 0; i < 500; i++)
    report["results"].push_back(
        result("a", "a.ms", i, "ms", {{"scene", "scene " + std::to_string(i)}}));
  ReportPage page = {
      "a",
      "",
      {},
      {{.caption = "", .rows = {{"scene", "scene"}}, .columns = {{"ms", "time"}}, .most_rows = 3}}};
  std::string text = make_page(page, report);
  EXPECT_TRUE(has_line(text, "| scene 2 | 2 |"));
  EXPECT_FALSE(has_line(text, "| scene 3 | 3 |"));
  EXPECT_TRUE(has_line(text, "497 more rows are in the JSON."));
  EXPECT_LE(count_lines(text), count_page_lines(page));
  std::string plain = make_page(plain_page("a"), report);
  EXPECT_TRUE(has_line(plain, "| a.ms | 2 | ms | scene scene 2 |")) << plain;
  EXPECT_LE(count_lines(plain), most_page_lines);
}

// Whatever is measured: every column's results, in more rows than any page has room for.
TEST(MarkdownPage, NoPageIsLongerThanItMayBe) {
  for (const ReportEntry& entry : report_entries()) {
    ReportPage page = find_page(entry.name);
    EXPECT_EQ(page.report, entry.name);
    EXPECT_FALSE(page.tables.empty()) << entry.name << " has no page of its own";
    EXPECT_LE(count_page_lines(page), most_page_lines) << entry.name;
    json report = {{"machine", {{"cpu", std::string(60, 'x')}, {"cores", 128}, {"load_at_end", 1}}},
                   {"run", {{"arguments", {"--quick", "--only", entry.name}}}}};
    for (const PageTable& table : page.tables)
      for (const PageColumn& column : table.columns)
        for (int i = 0; i < 100; i++) {
          std::string name =
              column.metric.find('.') == std::string::npos ? "x." + column.metric : column.metric;
          json one = result(entry.name, name, i, "ms", {{table.across, i % 3}});
          for (const PageKey& key : table.rows) one[key.field] = i;
          for (const PageFilter& filter : table.only) one[filter.field] = filter.values[0];
          report["results"].push_back(one);
        }
    std::string text = make_page(page, report);
    EXPECT_LE(count_lines(text), most_page_lines) << entry.name;
    EXPECT_LE(longest_text_line(text), 100u) << text;
    EXPECT_GT(text.find("| ---"), 0u);
  }
}

TEST(MarkdownPage, ResultsBelongToTheReportThatMadeThem) {
  BenchReport report(json{{"date", "2026-01-02"}});
  report.begin("light.frame");
  report.add("light.path.frame_ms", 61, "ms", {{"technique", "path"}});
  json made = report.to_json();
  EXPECT_EQ(reports_in(made), std::vector<std::string>{"light.frame"});
  EXPECT_EQ(made["run"]["date"], "2026-01-02");
  EXPECT_GT(made["machine"]["cores"].get<int>(), 0);
  json older = {{"results", {{{"name", "cache.warp.flip"}, {"value", 1}}}}};
  EXPECT_EQ(reports_in(older), std::vector<std::string>{"cache.warp"});
}

TEST(MarkdownPage, EveryReportIsInTheDocuments) {
  auto read = [](const std::string& file) {
    std::stringstream text;
    text << std::ifstream(std::string(WELLSPRING_SOURCE) + "/" + file).rdbuf();
    return text.str();
  };
  const std::string index = read("BENCHMARKS.md");
  for (const ReportEntry& entry : report_entries()) {
    std::string file = std::string("docs/benchmarks/") + entry.name + ".md", page = read(file);
    EXPECT_NE(page.find(std::string("# ") + entry.name + "\n"), std::string::npos) << file;
    EXPECT_LE(count_lines(page), most_page_lines) << file;
    EXPECT_NE(index.find("](" + file + ")"), std::string::npos) << file << " is not in the index";
  }
  EXPECT_LE(count_lines(index), most_page_lines);
}

TEST(MarkdownPage, PagesAreWrittenFromFiles) {
  namespace fs = std::filesystem;
  fs::path folder = fs::temp_directory_path() / "wellspring_markdown_page_test";
  fs::remove_all(folder);
  fs::create_directories(folder);
  auto write = [&](const char* name, const json& report) {
    std::ofstream(folder / name) << report.dump();
    return (folder / name).string();
  };
  auto read = [&](const char* name) {
    std::stringstream text;
    text << std::ifstream(folder / name).rdbuf();
    return text.str();
  };
  json newer = warp_report();
  newer["results"][0]["value"] = 42;
  std::vector<std::string> files = {write("a.json", warp_report()), write("b.json", newer)};
  write_pages_from(files, (folder / "pages").string());
  EXPECT_NE(read("pages/warp.md").find("# warp\n"), std::string::npos);
  EXPECT_NE(read("pages/warp.md").find("| 42 |"), std::string::npos) << "the last file counts";
  EXPECT_NE(read("pages/other.md").find("# other\n"), std::string::npos);
  write_pages_from(files, (folder / "all.md").string());
  EXPECT_EQ(read("all.md"), read("pages/other.md") + "\n" + read("pages/warp.md"));
  EXPECT_THROW(write_pages_from({write("no.json", json::array())}, (folder / "no.md").string()),
               std::runtime_error);
  fs::remove_all(folder);
}
