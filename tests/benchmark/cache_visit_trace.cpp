// SPDX-License-Identifier: Apache-2.0
#include "cache_visit_trace.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/load_error.h"

namespace wellspring::test {

using nlohmann::json;

namespace {

constexpr size_t columns = 7;  // time, x, y, z, yaw, pitch, fov

TraceSample read_sample(const json& row) {
  if (!row.is_array() || row.size() != columns)
    throw std::invalid_argument("a sample is seven numbers");
  double value[columns];
  for (size_t i = 0; i < columns; i++) {
    value[i] = row[i].get<double>();
    if (!std::isfinite(value[i])) throw std::invalid_argument("a number that is not finite");
  }
  return {
      value[0], {value[1], value[2], value[3]}, float(value[4]), float(value[5]), float(value[6])};
}

// Ten thousandths: a tenth of a millimetre, and far below a pixel's angle.
double round_off(double value) { return std::round(value * 1e4) / 1e4; }

}  // namespace

VisitTrace load_visit_trace(const std::string& file) {
  VisitTrace trace;
  trace.name = std::filesystem::path(file).stem().string();
  std::ifstream in(file);
  if (!in) throw LoadError(file, "", "cannot be read");
  try {
    json root = json::parse(in);
    trace.exhibit = root.at("exhibit").get<std::string>();
    trace.about = root.at("about").get<std::string>();
    trace.telling = root.at("storyteller").get<std::string>() == "telling";
    for (const json& row : root.at("samples")) trace.samples.push_back(read_sample(row));
    for (const json& event : root.at("lamps"))
      trace.lamps.push_back({event.at("time").get<double>(), event.at("on").get<bool>()});
  } catch (const std::exception& error) {
    throw LoadError(file, "", error.what());
  }
  if (trace.samples.empty()) throw LoadError(file, "/samples", "there are none");
  for (size_t i = 1; i < trace.samples.size(); i++)
    if (!(trace.samples[i].time > trace.samples[i - 1].time))
      throw LoadError(file, "/samples/" + std::to_string(i), "time does not grow");
  for (size_t i = 1; i < trace.lamps.size(); i++)
    if (trace.lamps[i].time < trace.lamps[i - 1].time)
      throw LoadError(file, "/lamps/" + std::to_string(i), "time runs back");
  return trace;
}

void save_visit_trace(const VisitTrace& trace, const std::string& folder) {
  std::string file = (std::filesystem::path(folder) / (trace.name + ".json")).string();
  std::ofstream out(file);
  json head = {{"about", trace.about},
               {"exhibit", trace.exhibit},
               {"storyteller", trace.telling ? "telling" : "idle"},
               {"lamps", json::array()},
               {"columns", {"time s", "x m", "y m", "z m", "yaw rad", "pitch rad", "fov rad"}}};
  for (const LampSwitch& lamp : trace.lamps)
    head["lamps"].push_back({{"time", lamp.time}, {"on", lamp.on}});
  // One sample a line, so that a change of the trace shows as lines.
  std::string text = head.dump(1);
  text.erase(text.find_last_of('}'));
  while (text.back() == '\n') text.pop_back();
  out << text << ",\n \"samples\": [\n";
  for (size_t i = 0; i < trace.samples.size(); i++) {
    const TraceSample& s = trace.samples[i];
    json row = json::array();
    for (double value : {s.time, s.position.x, s.position.y, s.position.z, double(s.yaw),
                         double(s.pitch), double(s.fov)})
      row.push_back(round_off(value));
    out << "  " << row.dump() << (i + 1 < trace.samples.size() ? ",\n" : "\n");
  }
  out << " ]\n}\n";
  if (!out.flush()) throw LoadError(file, "", "cannot be written");
}

std::vector<VisitTrace> load_visit_traces(const std::string& folder) {
  std::vector<std::string> files;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(folder, none))
    if (entry.path().extension() == ".json") files.push_back(entry.path().string());
  if (files.empty()) throw LoadError(folder, "", "holds no traces");
  std::sort(files.begin(), files.end());
  std::vector<VisitTrace> traces;
  for (const std::string& file : files) traces.push_back(load_visit_trace(file));
  return traces;
}

double trace_seconds(const VisitTrace& trace) { return trace.samples.back().time; }

Viewpoint eval_trace(const VisitTrace& trace, double time) {
  const auto& samples = trace.samples;
  auto after = std::upper_bound(samples.begin(), samples.end(), time,
                                [](double t, const TraceSample& s) { return t < s.time; });
  const TraceSample& b = after == samples.end() ? samples.back() : *after;
  const TraceSample& a = after == samples.begin() ? samples.front() : *(after - 1);
  double span = b.time - a.time;
  double t = span > 0 ? std::clamp((time - a.time) / span, 0.0, 1.0) : 0.0;
  Viewpoint at;
  at.name = trace.name;
  at.position = a.position + (b.position - a.position) * t;
  at.yaw = a.yaw + (b.yaw - a.yaw) * float(t);
  at.pitch = a.pitch + (b.pitch - a.pitch) * float(t);
  at.fov = a.fov + (b.fov - a.fov) * float(t);
  return at;
}

bool lamps_on(const VisitTrace& trace, double time) {
  bool on = true;
  for (const LampSwitch& lamp : trace.lamps)
    if (lamp.time <= time) on = lamp.on;
  return on;
}

}  // namespace wellspring::test
