// SPDX-License-Identifier: Apache-2.0
#include "report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <thread>

namespace wellspring::test {

using nlohmann::json;

void BenchReport::add(const std::string& name, double value, const std::string& unit, json fields) {
  json result = {{"name", name},
                 {"metric", name.substr(name.rfind('.') + 1)},
                 {"value", value},
                 {"unit", unit}};
  if (!part_.empty()) result["report"] = part_;
  std::string about;
  for (const auto& [key, field] : fields.items()) {
    result[key] = field;
    char number[32];
    std::snprintf(number, sizeof number, "%.4g", field.is_number() ? field.get<double>() : 0);
    about += " " + key + "=" +
             (field.is_string()   ? field.get<std::string>()
              : field.is_number() ? number
                                  : field.dump());
  }
  std::printf("%-34s %12.4g %-10s%s\n", name.c_str(), value, unit.c_str(), about.c_str());
  std::fflush(stdout);
  results_.push_back(std::move(result));
}

json BenchReport::to_json() const {
  return {{"machine", describe_machine()}, {"run", run_}, {"results", results_}};
}

void BenchReport::save(const std::string& file) const {
  std::ofstream out(file);
  out << to_json().dump(1) << "\n";
  if (!out.flush()) throw std::runtime_error(file + ": cannot be written");
}

json describe_run(const std::vector<std::string>& arguments, const std::string& folder) {
  std::time_t now = std::time(nullptr);
  char date[16];
  std::strftime(date, sizeof date, "%Y-%m-%d", std::gmtime(&now));
  json run = {{"date", date}, {"arguments", arguments}};
  std::string quoted;
  for (char c : folder) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  std::string command =
      "git -C '" + quoted + "' describe --always --dirty --exclude '*' 2>/dev/null";
  char commit[64] = {};
  if (FILE* pipe = popen(command.c_str(), "r")) {
    if (!std::fgets(commit, sizeof commit, pipe)) commit[0] = 0;
    pclose(pipe);
  }
  commit[std::strcspn(commit, "\n")] = 0;
  if (*commit) run["commit"] = commit;
  return run;
}

json describe_machine() {
  json machine = {{"cores", std::thread::hardware_concurrency()}, {"compiler", __VERSION__}};
  std::ifstream cpu("/proc/cpuinfo");
  for (std::string line; std::getline(cpu, line);)
    if (line.starts_with("model name")) {
      machine["cpu"] = line.substr(line.find(": ") + 2);
      break;
    }
  std::ifstream memory("/proc/meminfo");
  std::string word;
  double kilobytes = 0;
  if (memory >> word >> kilobytes && word == "MemTotal:")
    machine["memory_gib"] = std::round(kilobytes / (1 << 20));
  std::ifstream load("/proc/loadavg");
  double one = 0;
  load >> one;
  machine["load_at_end"] = one;
  return machine;
}

std::string truths_folder(const BenchOptions& options) {
  return (std::filesystem::path(options.programs).parent_path() / "visit_truths").string();
}

double quantile(std::vector<double> values, double p) {
  if (values.empty()) return NAN;
  std::sort(values.begin(), values.end());
  size_t rank = size_t(std::ceil(p * double(values.size())));
  return values[std::clamp(rank, size_t(1), values.size()) - 1];
}

}  // namespace wellspring::test
