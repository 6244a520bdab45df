// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <fmt/core.h>
#include <iterator>
#include <nlohmann/json.hpp>

#include "spectrum/color.h"
#include "spectrum/report/lamp_report.h"

namespace wellspring::spectrum {
namespace {

using ordered = nlohmann::ordered_json;

// Writes a cell of CSV: quoted where it must be.
std::string cell(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

double rounded(double value) { return std::round(value * 1e4) / 1e4; }
ordered list_of(const dvec3& v) {
  return ordered::array({rounded(v.x), rounded(v.y), rounded(v.z)});
}

ordered lamp_json(const LampReport& report, size_t i) {
  const ReportedLamp& one = report.lamps[i];
  ordered lamp{{"name", one.lamp.name}, {"about", one.lamp.about}, {"xyz", list_of(one.white)}};
  const dvec2 uv = uv_of(one.white);
  lamp["uv_1976"] = ordered::array({rounded(uv.x), rounded(uv.y)});
  if (const auto found = correlated_temperature(one.white))
    lamp["kelvin"] = std::round(found->kelvin), lamp["duv"] = rounded(found->duv);
  if (report.pigments.empty()) return lamp;
  lamp["rgb_error"] = {{"median", rounded(one.error_median)},
                       {"p95", rounded(one.error_p95)},
                       {"max", rounded(one.error_max)},
                       {"worst", report.pigments[one.worst_pigment].name}};
  return lamp;
}

ordered pigment_json(const LampReport& report, const ReportedPigment& one) {
  ordered pigment{{"name", one.name}, {"source", one.source}, {"under", ordered::object()}};
  for (size_t i = 0; i < one.colors.size(); i++) {
    const ReportedColor& color = one.colors[i];
    pigment["under"][report.lamps[i].lamp.name] = {{"xyz", list_of(color.xyz)},
                                                   {"lab", list_of(color.lab)},
                                                   {"de00_daylight", rounded(color.shift)},
                                                   {"de00_rgb", rounded(color.rgb_error)}};
  }
  return pigment;
}

std::string text_of_lamps(const LampReport& report) {
  std::string text = fmt::format("{:<16}{:>8}{:>9}   {}\n", "lamp", "kelvin", "Duv", "");
  for (const ReportedLamp& one : report.lamps) {
    const auto found = correlated_temperature(one.white);
    text += found ? fmt::format("{:<16}{:>8.0f}{:>9.4f}   {}\n", one.lamp.name, found->kelvin,
                                found->duv, one.lamp.about)
                  : fmt::format("{:<16}{:>8}{:>9}   {}\n", one.lamp.name, "-", "-", one.lamp.about);
  }
  return text;
}

std::string text_of_shifts(const LampReport& report) {
  std::string text = fmt::format("\n{:<22}", "dE00 from daylight");
  for (size_t i = 1; i < report.lamps.size(); i++)
    text += fmt::format("{:>11.10}", report.lamps[i].lamp.name);
  text += "\n";
  for (const ReportedPigment& one : report.pigments) {
    text += fmt::format("{:<22.21}", one.name);
    for (size_t i = 1; i < one.colors.size(); i++)
      text += fmt::format("{:>11.1f}", one.colors[i].shift);
    text += "\n";
  }
  return text;
}

std::string text_of_errors(const LampReport& report) {
  std::string text = "\nA renderer of red, green and blue errs by (dE00)\n";
  text += fmt::format("{:<16}{:>8}{:>8}{:>8}   {}\n", "lamp", "median", "95 %", "max", "worst");
  for (size_t i = 1; i < report.lamps.size(); i++) {
    const ReportedLamp& one = report.lamps[i];
    text += fmt::format("{:<16}{:>8.1f}{:>8.1f}{:>8.1f}   {}\n", one.lamp.name, one.error_median,
                        one.error_p95, one.error_max, report.pigments[one.worst_pigment].name);
  }
  return text;
}

std::string text_of_pairs(const LampReport& report) {
  if (report.pairs.empty()) return "\nNo two match under one lamp and differ under another.\n";
  std::string text = "\nMatch under one lamp, differ under another (metamers, dE00)\n";
  for (const MetamericPair& pair : report.pairs)
    text += fmt::format("{} and {}: {:.1f} under {}, {:.1f} under {}\n",
                        report.pigments[pair.first].name, report.pigments[pair.second].name,
                        pair.near_de00, report.lamps[pair.near_lamp].lamp.name, pair.far_de00,
                        report.lamps[pair.far_lamp].lamp.name);
  return text;
}

std::string text_of_glasses(const LampReport& report) {
  if (report.glasses.empty()) return "";
  std::string text = fmt::format("\n{:<24}{:>10}{:>10}{:>12}   {}\n", "glass, gem or liquid",
                                 "n (d)", "Abbe", "10 mm pass", "index known, nm");
  for (const Dispersion& one : report.glasses) {
    const auto index = index_at(one, line_d_nm), abbe = abbe_number(one),
               passed = transmittance_at(one, line_d_nm, 0.01);
    text += fmt::format("{:<24.23}{:>10}{:>10}{:>12}   {:.0f} to {:.0f}\n", one.name,
                        index ? fmt::format("{:.5f}", *index) : "-",
                        abbe ? fmt::format("{:.2f}", *abbe) : "-",
                        passed ? fmt::format("{:.4f}", *passed) : "-", one.low_nm, one.high_nm);
  }
  return text;
}

}  // namespace

std::string lamp_report_text(const LampReport& report) {
  std::string text = text_of_lamps(report);
  if (!report.pigments.empty())
    text += text_of_shifts(report) + text_of_errors(report) + text_of_pairs(report);
  return text + text_of_glasses(report);
}

std::string lamp_report_csv(const LampReport& report) {
  std::string csv = "pigment,lamp,X,Y,Z,L,a,b,de00_daylight,de00_rgb,adaptation,source\n";
  const char* adaptation = report.settings.adaptation == Adaptation::cat16 ? "cat16" : "none";
  for (const ReportedPigment& one : report.pigments)
    for (size_t i = 0; i < one.colors.size(); i++) {
      const ReportedColor& c = one.colors[i];
      fmt::format_to(std::back_inserter(csv),
                     "{},{},{:.6f},{:.6f},{:.6f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{},{}\n",
                     cell(one.name), cell(report.lamps[i].lamp.name), c.xyz.x, c.xyz.y, c.xyz.z,
                     c.lab.x, c.lab.y, c.lab.z, c.shift, c.rgb_error, adaptation, cell(one.source));
    }
  return csv;
}

std::string lamp_report_json(const LampReport& report) {
  ordered all{{"title", report.title},
              {"adaptation", report.settings.adaptation == Adaptation::cat16 ? "cat16" : "none"},
              {"daylight", daylight_name},
              {"lamps", ordered::array()},
              {"pigments", ordered::array()},
              {"metamers", ordered::array()},
              {"glasses", ordered::array()},
              {"notes", ordered::array()}};
  for (size_t i = 0; i < report.lamps.size(); i++) all["lamps"].push_back(lamp_json(report, i));
  for (const ReportedPigment& one : report.pigments)
    all["pigments"].push_back(pigment_json(report, one));
  for (const MetamericPair& pair : report.pairs)
    all["metamers"].push_back({{"first", report.pigments[pair.first].name},
                               {"second", report.pigments[pair.second].name},
                               {"match_under", report.lamps[pair.near_lamp].lamp.name},
                               {"match_de00", rounded(pair.near_de00)},
                               {"differ_under", report.lamps[pair.far_lamp].lamp.name},
                               {"differ_de00", rounded(pair.far_de00)}});
  for (const Dispersion& one : report.glasses) {
    ordered glass{{"name", one.name}, {"low_nm", one.low_nm}, {"high_nm", one.high_nm}};
    if (const auto index = index_at(one, line_d_nm)) glass["n_d"] = *index;
    if (const auto abbe = abbe_number(one)) glass["abbe"] = *abbe;
    if (const auto passed = transmittance_at(one, line_d_nm, 0.01))
      glass["transmittance_10_mm"] = *passed;
    all["glasses"].push_back(std::move(glass));
  }
  for (const SpectraNote& note : report.notes)
    all["notes"].push_back(
        {{"where", note.where}, {"what", note.what}, {"left_out", note.is_left_out}});
  // Names of strangers may be no UTF-8.
  return all.dump(1, ' ', false, ordered::error_handler_t::replace) + "\n";
}

}  // namespace wellspring::spectrum
