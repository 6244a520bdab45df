// SPDX-License-Identifier: Apache-2.0
#include "show/status/speeds.h"

#include <fstream>
#include <nlohmann/json.hpp>

namespace wellspring::show {

using nlohmann::json;

namespace {

json problem(const std::string& what) { return {{"problem", what}}; }

json find_points(const json& report) {
  json points = json::array();
  for (const json& result : report["results"]) {
    if (!result.is_object() || result.value("report", "") != "light.error") continue;
    if (!result.value("name", "").ends_with(".flip") || !result.contains("technique")) continue;
    points.push_back({{"technique", result["technique"]},
                      {"scene", result.value("scene", "")},
                      {"spp", result.value("spp", 0)},
                      {"seconds", result.value("cpu_seconds", 0.0)},
                      {"flip", result.value("value", 0.0)}});
  }
  return points;
}

json speeds_of(const std::string& file) {
  if (file.empty()) return problem("this server was started without --bench");
  std::ifstream in(file);
  if (!in)
    return problem(
        "nothing has been measured on this machine yet: ./wellspring bench --only "
        "light.error --quick --json FILE does it");
  const json report = json::parse(in, nullptr, false);
  if (!report.is_object() || !report.contains("results") || !report["results"].is_array())
    return problem(file + ": is no report of wellspring bench");
  const json points = find_points(report);
  if (points.empty()) return problem(file + ": holds no error over time (light.error)");
  const json run = report.value("run", json::object()),
             machine = report.value("machine", json::object());
  return {{"date", run.value("date", "")},
          {"commit", run.value("commit", "")},
          {"cpu", machine.value("cpu", "")},
          {"cores", machine.value("cores", 0)},
          {"points", points}};
}

}  // namespace

std::string read_speeds(const std::string& file) {
  json speeds;
  try {
    speeds = speeds_of(file);
  } catch (const json::exception&) {  // fields of other kinds
    speeds = problem(file + ": is no report of wellspring bench");
  }
  return speeds.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace wellspring::show
