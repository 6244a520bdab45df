// SPDX-License-Identifier: Apache-2.0
// wellspring bench: measures the parts and the whole, prints and saves the report.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>

#include "base/log.h"
#include "report.h"

int main(int argc, char** argv) {
  using namespace wellspring;
  log::start("bench");
  CLI::App app{"Speed against error, measured on this machine."};
  BenchOptions options;
  std::string only, file;
  const std::pair<const char*, void (*)(BenchReport&, const BenchOptions&)> parts[] = {
      {"stream", bench_stream}, {"cache", bench_cache}, {"light", bench_light}, {"avatar", bench_avatar}};
  app.add_flag("--quick", options.quick, "shorter runs: rougher figures");
  app.add_option("--only", only, "one part: stream, cache, light or avatar");
  app.add_option("--json", file, "where to write the report")->required();
  app.add_option("--content", options.content, "folder of exhibit packages")->capture_default_str();
  app.add_option("--web", options.web, "folder of the pages")->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  options.programs = std::filesystem::read_symlink("/proc/self/exe").parent_path().string();
  BenchReport report;
  bool found = only.empty();
  try {
    for (const auto& [name, run] : parts)
      if (only.empty() || only == name) {
        found = true;
        run(report, options);
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
