// SPDX-License-Identifier: Apache-2.0
// The conservator's table: how pigments look under lamps, how far from daylight, which of them
// match under one lamp and not under another (metamers), and what a renderer of three colours would
// make of them.
#pragma once
#include <string>
#include <vector>

#include "base/vec.h"
#include "spectrum/glass.h"
#include "spectrum/lamps.h"
#include "spectrum/measured.h"

namespace wellspring::spectrum {

// The lamp that all others are compared with.
inline constexpr const char* daylight_name = "D65";

// Says what eyes are used to: always to daylight, so that a candle's light is orange; or to each
// lamp after a while (CAT16), so that only what adaptation cannot undo is left.
enum class Adaptation : uint8_t { none, cat16 };

struct LampReportSettings {
  Adaptation adaptation = Adaptation::cat16;
  double near_de00 = 2;  // metamers differ by at most this under one lamp,
  double far_de00 = 5;   // and by at least this under another
  size_t most_pairs = 40;
};

// Holds how a pigment looks under one lamp. X, Y and Z are as measured; Y of white is 1.
struct ReportedColor {
  dvec3 xyz{0}, lab{0};
  dvec3 rgb{0};          // linear Rec. 709 to show it by
  double shift = 0;      // CIEDE2000 from its look in daylight
  double rgb_error = 0;  // CIEDE2000 of a renderer that multiplies red, green and blue
};

struct ReportedPigment {
  std::string name, source;
  std::vector<ReportedColor> colors;  // one for each lamp
};

struct ReportedLamp {
  LampSpectrum lamp;
  dvec3 white{1}, white_rgb{1};  // X, Y, Z; and to show it by, as bright as it can be
  // Over all pigments: CIEDE2000 of a renderer of three colours.
  double error_median = 0, error_p95 = 0, error_max = 0;
  size_t worst_pigment = 0, most_shifted = 0;
};

// Names two pigments that look alike under one lamp and differ under another.
struct MetamericPair {
  size_t first, second, near_lamp, far_lamp;
  double near_de00, far_de00;
};

struct LampReport {
  std::string title;
  LampReportSettings settings;
  std::vector<ReportedLamp> lamps;  // daylight first
  std::vector<ReportedPigment> pigments;
  std::vector<MetamericPair> pairs;  // the farthest first
  std::vector<Dispersion> glasses;
  std::vector<SpectraNote> notes;
};

// Compares pigments under daylight and the lamps.
LampReport make_lamp_report(const std::string& title, const LampReportSettings& settings,
                            const std::vector<LampSpectrum>& lamps,
                            const std::vector<NamedSpectrum>& pigments);

// These write it for a terminal, for spreadsheets, for programs, and as a page that needs nothing
// else.
std::string lamp_report_text(const LampReport& report);
std::string lamp_report_csv(const LampReport& report);
std::string lamp_report_json(const LampReport& report);
std::string lamp_report_html(const LampReport& report);

}  // namespace wellspring::spectrum
