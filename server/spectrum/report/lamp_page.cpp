// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <fmt/core.h>

#include "spectrum/color.h"
#include "spectrum/report/lamp_report.h"

namespace wellspring::spectrum {
namespace {

constexpr size_t most_notes = 200;

constexpr const char* style = R"css(
:root { color-scheme: light; }
body { font: 15px/1.5 system-ui, "Segoe UI", "DejaVu Sans", sans-serif; color: #222;
  background: #fafaf8; max-width: 76rem; margin: 2rem auto; padding: 0 1.5rem; }
h1 { font-size: 1.6rem; font-weight: 600; margin: 0 0 .3rem; }
h2 { font-size: 1.15rem; font-weight: 600; margin: 2.4rem 0 .5rem; }
p { max-width: 46rem; margin: .3rem 0 .8rem; }
.wide { overflow-x: auto; }
table { border-collapse: separate; border-spacing: 0; font-variant-numeric: tabular-nums; }
th, td { padding: .3rem .6rem; text-align: right; white-space: nowrap; }
th { font-weight: 600; vertical-align: bottom; border-bottom: 1px solid #999; background: #fafaf8; }
td { border-bottom: 1px solid #e4e4de; }
th:first-child, td:first-child { text-align: left; }
td.text, th.text { text-align: left; }
.pigments th:first-child, .pigments td:first-child { position: sticky; left: 0;
  background: #fafaf8; }
.pigments td.look { padding: .15rem; }
.look div { min-width: 4.6rem; padding: .3rem .45rem; border-radius: 3px; font-size: .8rem;
  line-height: 1.25; }
.look b { font-size: .95rem; }
.dot { display: inline-block; width: 1.1em; height: 1.1em; border-radius: 50%;
  border: 1px solid #999; vertical-align: -.2em; margin-right: .5em; }
.swatch { display: inline-block; width: 2.2em; height: 1.3em; vertical-align: -.3em; }
.pairs .swatch + .swatch { margin-right: .6em; }
li { margin: .15rem 0; }
small { color: #555; }
@media print { body { margin: 0; max-width: none; background: none; } .wide { overflow: visible; }
  .look div, .swatch, .dot { print-color-adjust: exact; -webkit-print-color-adjust: exact; } }
)css";

// Writes text within HTML.
std::string plain(const std::string& text) {
  std::string out;
  for (const char c : text) switch (c) {
      case '&': out += "&amp;"; break;
      case '<': out += "&lt;"; break;
      case '>': out += "&gt;"; break;
      case '"': out += "&quot;"; break;
      default: out += c;
    }
  return out;
}

int code_of(double linear) {
  const double x = std::clamp(linear, 0.0, 1.0);
  const double code = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
  return int(std::lround(255 * code));
}

std::string css_color(const dvec3& rgb) {
  return fmt::format("#{:02x}{:02x}{:02x}", code_of(rgb.x), code_of(rgb.y), code_of(rgb.z));
}

// Returns black or white, whichever is read better on a color of this luminance (WCAG 2).
const char* ink_on(const dvec3& rgb) {
  const dvec3 shown = glm::clamp(rgb, dvec3(0), dvec3(1));
  const double light = 0.2126 * shown.x + 0.7152 * shown.y + 0.0722 * shown.z;
  return light > 0.179 ? "#000" : "#fff";
}

std::string swatch(const dvec3& rgb) {
  return fmt::format("<span class=\"swatch\" style=\"background:{}\"></span>", css_color(rgb));
}

std::string lamp_rows(const LampReport& report) {
  std::string html =
      "<h2>The lamps</h2>\n<div class=\"wide\"><table><tr><th>lamp</th><th class=\"text\">what it "
      "is</th><th>kelvin</th><th>D<sub>uv</sub></th><th>u&prime;</th><th>v&prime;</th></tr>\n";
  for (const ReportedLamp& one : report.lamps) {
    const auto found = correlated_temperature(one.white);
    const dvec2 uv = uv_of(one.white);
    html += fmt::format(
        "<tr><td><span class=\"dot\" style=\"background:{}\"></span>{}</td><td class=\"text\">{}"
        "</td><td>{}</td><td>{}</td><td>{:.4f}</td><td>{:.4f}</td></tr>\n",
        css_color(one.white_rgb), plain(one.lamp.name), plain(one.lamp.about),
        found ? fmt::format("{:.0f}", found->kelvin) : "&ndash;",
        found ? fmt::format("{:.4f}", found->duv) : "&ndash;", uv.x, uv.y);
  }
  return html + "</table></div>\n";
}

// Returns whole numbers; -0.4 is 0, not -0.
std::string whole(const dvec3& lab) {
  return fmt::format("{} {} {}", std::lround(lab.x), std::lround(lab.y), std::lround(lab.z));
}

std::string look_cell(const ReportedColor& color, bool is_daylight) {
  const std::string shift =
      is_daylight ? std::string("<b>&nbsp;</b>") : fmt::format("<b>{:.1f}</b>", color.shift);
  return fmt::format(
      "<td class=\"look\"><div style=\"background:{};color:{}\" title=\"L* {:.1f}  a* {:.1f}  "
      "b* {:.1f}\">{}<br>{}</div></td>",
      css_color(color.rgb), ink_on(color.rgb), color.lab.x, color.lab.y, color.lab.z, shift,
      whole(color.lab));
}

std::string pigment_rows(const LampReport& report) {
  const bool adapts = report.settings.adaptation == Adaptation::cat16;
  std::string html =
      "<h2>The pigments</h2>\n<p>Each field shows the colour, how far it is from "
      "daylight (CIEDE2000; 1 to 2 is just seen) and L* a* b*. ";
  html += adapts ? "Eyes are used to each lamp (CAT16), so what is left is what they cannot get "
                   "used to."
                 : "Eyes are used to daylight: the lamp is seen beside a window.";
  html += "</p>\n<div class=\"wide\"><table class=\"pigments\"><tr><th>pigment</th>";
  for (const ReportedLamp& one : report.lamps)
    html += fmt::format("<th>{}</th>", plain(one.lamp.name));
  html += "</tr>\n";
  for (const ReportedPigment& one : report.pigments) {
    html += fmt::format("<tr><td title=\"{}\">{}</td>", plain(one.source), plain(one.name));
    for (size_t i = 0; i < one.colors.size(); i++) html += look_cell(one.colors[i], i == 0);
    html += "</tr>\n";
  }
  return html + "</table></div>\n";
}

std::string shift_rows(const LampReport& report) {
  struct Shift {
    size_t pigment, lamp;
    double value;
  };
  std::vector<Shift> shifts;
  for (size_t k = 0; k < report.pigments.size(); k++)
    for (size_t i = 1; i < report.lamps.size(); i++)
      shifts.push_back({k, i, report.pigments[k].colors[i].shift});
  std::ranges::stable_sort(shifts,
                           [](const Shift& a, const Shift& b) { return a.value > b.value; });
  if (shifts.size() > 10) shifts.resize(10);
  std::string html =
      "<h2>What changes most</h2>\n<table class=\"pairs\"><tr><th>pigment</th><th class=\"text\">"
      "lamp</th><th class=\"text\">daylight, lamp</th><th>&Delta;E<sub>00</sub></th></tr>\n";
  for (const Shift& one : shifts) {
    const ReportedPigment& pigment = report.pigments[one.pigment];
    html += fmt::format(
        "<tr><td>{}</td><td class=\"text\">{}</td><td class=\"text\">{}{}</td>"
        "<td>{:.1f}</td></tr>\n",
        plain(pigment.name), plain(report.lamps[one.lamp].lamp.name), swatch(pigment.colors[0].rgb),
        swatch(pigment.colors[one.lamp].rgb), one.value);
  }
  return html + "</table>\n";
}

std::string pair_rows(const LampReport& report) {
  std::string html = "<h2>Metamers</h2>\n";
  if (report.pairs.empty())
    return html + "<p>No two match under one of these lamps and differ under another.</p>\n";
  html += fmt::format(
      "<p>These match under one lamp (&Delta;E<sub>00</sub> at most {:g}) and differ under another "
      "(at least {:g}): a retouching that is right in the studio shows in the gallery.</p>\n"
      "<div class=\"wide\"><table class=\"pairs\"><tr><th>first</th><th class=\"text\">second</th>"
      "<th class=\"text\">match under</th><th>&Delta;E<sub>00</sub></th><th class=\"text\">differ "
      "under</th><th>&Delta;E<sub>00</sub></th></tr>\n",
      report.settings.near_de00, report.settings.far_de00);
  for (const MetamericPair& pair : report.pairs) {
    const ReportedPigment &a = report.pigments[pair.first], &b = report.pigments[pair.second];
    const auto both = [&](size_t lamp) {
      return swatch(a.colors[lamp].rgb) + swatch(b.colors[lamp].rgb) +
             plain(report.lamps[lamp].lamp.name);
    };
    html += fmt::format(
        "<tr><td>{}</td><td class=\"text\">{}</td><td class=\"text\">{}</td><td>"
        "{:.1f}</td><td class=\"text\">{}</td><td>{:.1f}</td></tr>\n",
        plain(a.name), plain(b.name), both(pair.near_lamp), pair.near_de00, both(pair.far_lamp),
        pair.far_de00);
  }
  return html + "</table></div>\n";
}

std::string error_rows(const LampReport& report) {
  std::string html =
      "<h2>Pictures of three colours</h2>\n<p>How wrong a renderer or a photograph's profile is "
      "that multiplies red, green and blue instead of spectra (&Delta;E<sub>00</sub> over all "
      "pigments).</p>\n<table><tr><th>lamp</th><th>median</th><th>95 %</th><th>max</th>"
      "<th class=\"text\">worst</th></tr>\n";
  for (size_t i = 1; i < report.lamps.size(); i++) {
    const ReportedLamp& one = report.lamps[i];
    html += fmt::format(
        "<tr><td>{}</td><td>{:.1f}</td><td>{:.1f}</td><td>{:.1f}</td>"
        "<td class=\"text\">{}</td></tr>\n",
        plain(one.lamp.name), one.error_median, one.error_p95, one.error_max,
        plain(report.pigments[one.worst_pigment].name));
  }
  return html + "</table>\n";
}

std::string glass_rows(const LampReport& report) {
  if (report.glasses.empty()) return "";
  std::string html =
      "<h2>Glass and gems</h2>\n<p>The index of refraction at 587.6 nm, Abbe's number (high where "
      "colours are hardly separated), and the share of this light that passes 10 mm.</p>\n<table>"
      "<tr><th>name</th><th>n<sub>d</sub></th><th>Abbe</th><th>passes</th><th>index known, nm</th>"
      "</tr>\n";
  for (const Dispersion& one : report.glasses) {
    const auto index = index_at(one, line_d_nm), abbe = abbe_number(one),
               passed = transmittance_at(one, line_d_nm, 0.01);
    html += fmt::format(
        "<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{:.0f} to {:.0f}</td></tr>\n",
        plain(one.name), index ? fmt::format("{:.5f}", *index) : "&ndash;",
        abbe ? fmt::format("{:.2f}", *abbe) : "&ndash;",
        passed ? fmt::format("{:.4f}", *passed) : "&ndash;", one.low_nm, one.high_nm);
  }
  return html + "</table>\n";
}

std::string note_rows(const LampReport& report) {
  if (report.notes.empty()) return "";
  std::string html = "<h2>Notes on the measurements</h2>\n<ul>\n";
  for (size_t i = 0; i < std::min(report.notes.size(), most_notes); i++)
    html +=
        fmt::format("<li>{} {}</li>\n", plain(report.notes[i].where), plain(report.notes[i].what));
  if (report.notes.size() > most_notes)
    html += fmt::format("<li>and {} more</li>\n", report.notes.size() - most_notes);
  return html + "</ul>\n";
}

}  // namespace

std::string lamp_report_html(const LampReport& report) {
  std::string html = fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n<meta name=\"viewport\" "
      "content=\"width=device-width\">\n<title>{0}: under other lamps</title>\n<style>{1}</style>"
      "</head><body>\n<h1>{0}: under other lamps</h1>\n<p>Computed from spectra, for the standard "
      "observer of CIE 1931 (2&deg;). Daylight is {2}. Colours beyond what this screen shows are "
      "cut to what it can.</p>\n",
      plain(report.title), style, daylight_name);
  html += lamp_rows(report);
  if (!report.pigments.empty())
    html += pigment_rows(report) + shift_rows(report) + pair_rows(report) + error_rows(report);
  return html + glass_rows(report) + note_rows(report) + "</body></html>\n";
}

}  // namespace wellspring::spectrum
