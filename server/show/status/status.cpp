// SPDX-License-Identifier: Apache-2.0
#include "show/status/status.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "json/fields.h"
#include "show/http/refusal.h"

namespace wellspring::show {

namespace {

// The day that the question names, or `otherwise` where it names none.
std::optional<int64_t> day_of(const HttpQuestion& question, const char* name, int64_t otherwise) {
  auto found = question.query.find(name);
  if (found == question.query.end() || found->second.empty()) return otherwise;
  return parse_day(found->second);
}

}  // namespace

HttpReply answer_sums(const ReadSums& read, const HttpQuestion& question) {
  if (!read) return refuse(404, "no_sums", "this server was started without --sums: it keeps none");
  const auto from = day_of(question, "from", *parse_day("0000-01-01")),
             to = day_of(question, "to", *parse_day("9999-12-31"));
  if (!from || !to)
    return refuse(400, "bad_parameter", "from, to: a day such as 2026-05-31 is expected");
  HttpReply reply;
  reply.content_type = "text/csv; charset=utf-8";
  reply.headers["Cache-Control"] = "no-store";
  reply.headers["Content-Disposition"] = "attachment; filename=\"sums.csv\"";
  try {
    reply.body = write_csv(read(*from, *to));
  } catch (const std::exception& error) {
    return refuse(503, "unreadable", error.what());
  }
  return reply;
}

using nlohmann::json;

namespace {

void put_findings(json& list, const Standing& one) {
  for (const Finding& finding : one.findings) {
    const bool is_known = std::ranges::any_of(list, [&](const json& other) {
      return other["what"] == finding.what && other["why"] == finding.why;
    });
    if (is_known) continue;
    list.push_back({{"exhibit", one.exhibit},
                    {"about", finding.about},
                    {"grave", finding.grave},
                    {"what", finding.what},
                    {"seconds", std::round(one.report.time - finding.since)},
                    {"why", finding.why},
                    {"remedy", finding.remedy}});
  }
}

void put_kiosks(json& status, const Standing& one) {
  for (const KioskReport& kiosk : one.report.kiosks)
    status["kiosks"].push_back({{"name", kiosk.name},
                                {"exhibit", one.exhibit},
                                {"stage", to_string(kiosk.stage)},
                                {"people", kiosk.people},
                                {"storyteller", kiosk.storyteller},
                                {"screens", kiosk.screens},
                                {"cameras", kiosk.cameras}});
  for (const CameraReport& camera : one.report.cameras) {
    FieldWriter eyes;
    EyeParts::list(camera.parts, eyes);
    status["cameras"].push_back(
        {{"kiosk", camera.kiosk},
         {"name", camera.name.empty() ? std::to_string(camera.number) : camera.name},
         {"state", camera.state},
         {"eyes", std::move(eyes.out)},
         {"seconds", std::round(camera.since)}});
  }
}

void put_workers(json& status, const Standing& one) {
  for (const WorkerReport& worker : one.report.workers.workers)
    status["workers"].push_back({{"name", worker.name},
                                 {"exhibit", one.exhibit},
                                 {"cores", worker.cores},
                                 {"problem", worker.problem},
                                 {"same_bits", worker.same_bits},
                                 {"samples", worker.samples},
                                 {"samples_per_second", std::round(worker.samples_per_second)},
                                 {"line_ms", std::round(1000 * worker.line)}});
}

}  // namespace

std::string write_status(const std::vector<Standing>& exhibits,
                         const std::vector<FailedExhibit>& failed, bool sums) {
  json findings = json::array();
  json status = {{"house", nullptr},
                 {"kiosks", json::array()},
                 {"cameras", json::array()},
                 {"workers", json::array()},
                 {"sums", sums}};
  if (!exhibits.empty())
    status["house"] = {{"open", exhibits[0].report.open}, {"quiet", exhibits[0].report.quiet}};
  for (const FailedExhibit& one : failed)
    findings.push_back({{"exhibit", one.id},
                        {"about", "failed " + one.id},
                        {"grave", true},
                        {"what", "The exhibit '" + one.id + "' cannot be shown"},
                        {"seconds", nullptr},
                        {"why", one.problems.empty() ? "" : one.problems.front()},
                        {"remedy",
                         "'./wellspring check' lists all that is wrong with it; then "
                         "start the server anew."}});
  for (const Standing& one : exhibits) {
    put_findings(findings, one);
    put_kiosks(status, one);
    put_workers(status, one);
  }
  std::stable_sort(findings.begin(), findings.end(), [](const json& a, const json& b) {
    return a["grave"].get<bool>() && !b["grave"].get<bool>();
  });
  status["fine"] = findings.empty();
  status["findings"] = std::move(findings);
  return status.dump(-1, ' ', false, json::error_handler_t::replace);
}

void StatusDesk::see(const ShowReport& report) {
  std::vector<Finding> findings = judge(report, memory_);
  std::lock_guard lock(mutex_);
  standing_.report = report;
  standing_.findings = std::move(findings);
}

Standing StatusDesk::tell() const {
  std::lock_guard lock(mutex_);
  return standing_;
}

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
