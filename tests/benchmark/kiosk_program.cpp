// SPDX-License-Identifier: Apache-2.0
#include "kiosk_program.h"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <stdexcept>

namespace wellspring::test {

void run_kiosk_program(BenchReport& report, const BenchOptions& options, const std::string& name,
                       const std::string& more) {
  namespace fs = std::filesystem;
  auto quoted = [](const fs::path& path) { return "'" + path.string() + "'"; };
  std::string command = quoted(fs::path(options.programs) / name);
  if (const char* weights = std::getenv("WELLSPRING_WEIGHTS"))
    command += " --weights " + quoted(fs::path(weights) / "face");
  const fs::path data = fs::absolute(options.content) / "../../shared/data";
  if (fs::exists(data)) command += " --data " + quoted(data);
  if (options.quick) command += " --quick";
  if (!more.empty()) command += " " + more;
  read_results(report, command);
}

void read_results(BenchReport& report, const std::string& command) {
  std::unique_ptr<FILE, int (*)(FILE*)> out(popen(command.c_str(), "r"), pclose);
  if (!out) throw std::runtime_error(command + ": cannot be started");
  std::string line;
  for (int c; (c = std::fgetc(out.get())) != EOF;) {
    if (c != '\n') {
      line += char(c);
      continue;
    }
    nlohmann::json fields = nlohmann::json::parse(line);
    line.clear();
    const std::string metric = fields.at("name"), unit = fields.at("unit");
    const double value = fields.at("value");
    for (const char* key : {"name", "unit", "value"}) fields.erase(key);
    report.add(metric, value, unit, fields);
  }
  if (pclose(out.release()) != 0) throw std::runtime_error(command + ": did not finish");
}

}  // namespace wellspring::test
