// SPDX-License-Identifier: Apache-2.0
#include "show/status/status.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace wellspring::show {

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
  for (const CameraReport& camera : one.report.cameras)
    status["cameras"].push_back(
        {{"kiosk", camera.kiosk},
         {"name", camera.name.empty() ? std::to_string(camera.number) : camera.name},
         {"state", camera.state},
         {"seconds", std::round(camera.since)}});
}

}  // namespace

std::string write_status(const std::vector<Standing>& exhibits,
                         const std::vector<FailedExhibit>& failed, bool sums) {
  json findings = json::array();
  json status = {
      {"house", nullptr}, {"kiosks", json::array()}, {"cameras", json::array()}, {"sums", sums}};
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

}  // namespace wellspring::show
