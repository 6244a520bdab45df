// SPDX-License-Identifier: Apache-2.0
// wellspring bench: measures the parts and the whole, prints and saves the report.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>

#include "base/log.h"
#include "cache_visit_trace.h"
#include "light_cycles.h"
#include "light_photons.h"
#include "light_rays.h"
#include "report.h"
#include "show/exhibit/exhibit_load.h"

int main(int argc, char** argv) {
  using namespace wellspring;
  log::start("bench");
  CLI::App app{"Speed against error, measured on this machine."};
  BenchOptions options;
  std::string only, file, traces;
  const std::pair<const char*, void (*)(BenchReport&, const BenchOptions&)> parts[] = {
      {"stream", bench_stream},           {"avatar", bench_avatar},
      {"cache.display", bench_cache_display}, {"cache.warp", bench_cache_warp},
      {"cache.visit", bench_cache_visit},
      {"cache.rest", bench_cache_rest},
      {"show.rest", bench_show_rest},
      {"show.teller", bench_show_teller},
      {"show.load", bench_show_load},
      {"cache.starve", bench_cache_starve}, {"cache.turns", bench_cache_turns},
      {"cache.switch", bench_cache_switch},
      {"denoise.ms", bench_denoise_time}, {"denoise.flip", bench_denoise_flip},
      {"light.frame", bench_light_frame}, {"light.scaling", bench_light_scaling},
      {"light.error", bench_light_error}, {"light.rays", bench_light_rays},
      {"light.cycles", bench_light_cycles}, {"light.photons", bench_light_photons}};
  app.add_flag("--quick", options.quick, "shorter runs: rougher figures");
  app.add_option("--only", only,
                 "one part: stream, cache, show, denoise, avatar, light (or one of its own: "
                 "light.error ...)");
  CLI::Option* json = app.add_option("--json", file, "where to write the report");
  app.add_option("--make-traces", traces,
                 "instead: write the visits' camera traces into this folder")
      ->excludes(json);
  app.add_option("--plots", options.plots,
                 "what names of plots begin with; without it the report's name and _");
  app.add_option("--scenes", options.scenes, "folder of the benchmark's own scenes")
      ->capture_default_str();
  app.add_option("--content", options.content, "folder of exhibit packages")->capture_default_str();
  app.add_option("--web", options.web, "folder of the pages")->capture_default_str();
  app.add_option(
      "--server-option", options.server_words,
      "stream: a further word of the server's command line, as --server-option=--workers=4");
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
  app.add_option("--visit-pictures", options.visit_pictures,
                 "cache: folder for the pictures judged");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  if (file.empty() && traces.empty()) {
    std::cerr << "--json is required\n";
    return 2;
  }
  options.programs = std::filesystem::read_symlink("/proc/self/exe").parent_path().string();
  if (options.plots.empty())
    options.plots = std::filesystem::path(file).replace_extension("").string() + "_";
  BenchReport report;
  bool found = only.empty();
  try {
    if (!traces.empty()) {
      Exhibit castle = load_exhibit((std::filesystem::path(options.content) / "castle").string());
      make_visit_traces(castle, World(castle.scene), traces);
      return 0;
    }
    for (const auto& [name, run] : parts)
      if (only.empty() || name == only || std::string_view(name).starts_with(only + ".")) {
        found = true;
        run(report, options);
      }
    if (only == "light.hall") {  // a part of light.error
      found = true;
      bench_light_hall(report, options);
    }
    if (!found) {
      std::cerr << "--only: there is no part '" << only << "'\n";
      return 2;
    }
    report.save(file);
  } catch (const std::exception& error) {
    std::cerr << "error: " << error.what() << "\n";
    return 1;
  }
  return 0;
}
