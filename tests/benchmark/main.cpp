// SPDX-License-Identifier: Apache-2.0
// wellspring bench: measures the parts and the whole, prints and saves the report, as JSON and as
// pages of Markdown.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fmt/core.h>
#include <iostream>
#include <unistd.h>

#include "about/version.h"
#include "base/clock.h"
#include "base/log.h"
#include "cache_visit_trace.h"
#include "local_display.h"
#include "report.h"
#include "reports.h"
#include "show/exhibit/load/exhibit_load.h"

namespace {

// The words of the command line that say what is measured; places of files are left out.
std::vector<std::string> words_of(const CLI::App& app) {
  std::vector<std::string> words;
  for (const CLI::Option* option : app.get_options()) {
    const std::string name = option->get_name();
    bool is_place = name == "--json" || name == "--markdown" || name == "--plots" ||
                    name == "--scenes" || name == "--content" || name == "--web" ||
                    name == "--visit-pictures" || name == "--last" || name == "--costs";
    if (option->count() == 0 || is_place) continue;
    words.push_back(name);
    if (option->get_items_expected_max() > 0)
      for (const std::string& value : option->results()) words.push_back(value);
  }
  return words;
}

// A line of its own for each part, since results are printed between. Parts take times of their
// own: what is left is a rough guess.
void say_part(const char* name, size_t part, size_t parts, double seconds) {
  if (!isatty(STDERR_FILENO)) return;
  const std::string more = fmt::format("{} ({} of {})", name, part + 1, parts);
  const double done = double(part) / double(parts);
  std::fprintf(stderr, "%s\n", wellspring::progress_line("bench", done, seconds, more).c_str());
}

bool has_report(const wellspring::test::BenchReport& report, const std::string& name) {
  const nlohmann::json all = report.to_json();
  return std::ranges::any_of(all["results"], [&](const nlohmann::json& result) {
    return result.value("report", "") == name;
  });
}

// Keeps the whole report in a file of its own, if it has what that file is for.
void keep(const wellspring::test::BenchReport& report, const std::string& file,
          const std::string& name) {
  if (file.empty() || !has_report(report, name)) return;
  std::filesystem::create_directories(std::filesystem::path(file).parent_path());
  report.save(file);
}

}  // namespace

int main(int argc, char** argv) {
  using namespace wellspring;
  using namespace wellspring::test;
  if (answer_version(argc, argv, {"Boost", "CLI11", "GLM", "nlohmann-json", "stb"})) return 0;
  log::start("bench");
  CLI::App app{"Speed against error, measured on this machine."};
  BenchOptions options;
  std::string only, file, traces, pages, last, costs, steps;
  std::vector<std::string> read;
  app.add_flag("--quick", options.quick, "shorter runs: rougher figures");
  app.add_option("--only", only,
                 "one part: stream, load, workers, pieces, lamps, cache, corrective, bake, show, "
                 "denoise, avatar, "
                 "attention, kiosk, light "
                 "(or one of its own: light.error ...)");
  CLI::Option* json = app.add_option("--json", file, "where to write the report");
  app.add_option("--last", last,
                 "where to keep it, too, if it has error over time: /status shows that");
  app.add_option("--costs", costs,
                 "likewise, if it has costs of serving: ./wellspring plan reads that");
  app.add_option("--markdown", pages,
                 "where to write it for readers: a file.md, or a folder for a page of each");
  app.add_option("--from", read, "instead of measuring: the JSON files that --markdown shows")
      ->excludes(json);
  app.add_option("--make-traces", traces,
                 "instead: write the visits' camera traces into this folder")
      ->excludes(json);
  app.add_option("--warp", steps,
                 "instead: draw what a page has drawn of the keyframes in this folder "
                 "(local_display.h), and say by how much it differs")
      ->excludes(json);
  app.add_option("--plots", options.plots,
                 "what names of plots begin with; without it the report's name and _");
  app.add_option("--scenes", options.scenes, "folder of the benchmark's own scenes")
      ->capture_default_str();
  app.add_option("--content", options.content, "folder of exhibit packages")->capture_default_str();
  app.add_option("--web", options.web, "folder of the pages")->capture_default_str();
  app.add_option("--server-option", options.server_words,
                 "stream, load, show: a further word of the server's command line, as "
                 "--server-option=--cache=FOLDER, which has an empty cache of its own without");
  app.add_option("--cycles-case", options.cycles_case,
                 "light.cycles: compare with Cycles in this case only");
  app.add_option("--visit-trace", options.visit_trace, "cache: simulate this visit only");
  app.add_option("--visit-method", options.visit_methods,
                 "cache: only these ways to keep the picture up");
  app.add_option("--visit-mismatch", options.visit_mismatches, "cache: only these mismatches")
      ->check(CLI::Range(1, 4096));
  app.add_option("--visit-technique", options.visit_technique,
                 "cache: what answers samples in motion")
      ->capture_default_str();
  app.add_option("--visit-width", options.visit_width, "cache: pixels of a row; pictures are 16:9")
      ->check(CLI::Range(16, 1920));
  app.add_option("--visit-instants", options.visit_instants, "cache: pictures judged of each visit")
      ->check(CLI::Range(1, 100));
  app.add_option("--visit-spp", options.visit_spp, "cache: samples of half a converged picture")
      ->check(CLI::Range(1, 65536));
  app.add_option("--bake-seconds", options.bake_seconds,
                 "bake: how long illumination maps are baked")
      ->check(CLI::Range(1.0, 1e6));
  app.add_option("--visit-pictures", options.visit_pictures,
                 "cache: folder for the pictures judged");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  if (!read.empty() && pages.empty()) {
    std::cerr << "--from: --markdown says where to write\n";
    return 2;
  }
  if (file.empty() && traces.empty() && read.empty() && steps.empty()) {
    std::cerr << "--json is required\n";
    return 2;
  }
  options.programs = std::filesystem::read_symlink("/proc/self/exe").parent_path().string();
  if (options.plots.empty())
    options.plots = std::filesystem::path(file).replace_extension("").string() + "_";
  BenchReport report(describe_run(words_of(app), options.scenes));
  bool found = only.empty();
  try {
    if (!read.empty()) {
      write_pages_from(read, pages);
      return 0;
    }
    if (!steps.empty()) {
      std::cout << draw_steps(steps).dump() << "\n";
      return 0;
    }
    if (!traces.empty()) {
      Exhibit castle = load_exhibit((std::filesystem::path(options.content) / "castle").string());
      make_visit_traces(castle, World(castle.scene), traces);
      return 0;
    }
    std::vector<const ReportEntry*> asked;
    for (const ReportEntry& entry : report_entries()) {
      std::string_view name = entry.name;
      bool is_asked = only.empty() || name.starts_with(only + ".");
      if (name == only || (!entry.is_part && is_asked)) asked.push_back(&entry);
    }
    const double began = seconds_now();
    for (size_t i = 0; i < asked.size(); i++) {
      found = true;
      say_part(asked[i]->name, i, asked.size(), seconds_now() - began);
      report.begin(asked[i]->name);
      asked[i]->run(report, options);
    }
    if (!found) {
      std::cerr << "--only: there is no part '" << only << "'\n";
      return 2;
    }
    report.save(file);
    keep(report, last, "light.error");
    keep(report, costs, "load.plan");
    if (!pages.empty()) write_pages(report.to_json(), pages);
  } catch (const std::exception& error) {
    std::cerr << "error: " << error.what() << "\n";
    return 1;
  }
  return 0;
}
