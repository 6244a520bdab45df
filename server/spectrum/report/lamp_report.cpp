// SPDX-License-Identifier: Apache-2.0
#include "spectrum/report/lamp_report.h"

#include <algorithm>

#include "spectrum/color.h"
#include "spectrum/observer.h"

namespace wellspring::spectrum {
namespace {

// Returns the value that a share of all do not exceed.
double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  const auto at = values.begin() + ptrdiff_t(share * double(values.size() - 1) + 0.5);
  std::ranges::nth_element(values, at);
  return *at;
}

// Looks at surfaces under one lamp, with eyes that are used to it or to daylight.
class Look {
 public:
  Look(const Spectrum& lamp, const LampObserver& daylight, Adaptation adaptation)
      : lamp_(lamp), daylight_(daylight), adaptation_(adaptation) {}

  // Returns the color that looks the same to eyes used to daylight.
  dvec3 seen(const dvec3& xyz) const {
    return adaptation_ == Adaptation::cat16 ? adapt_cat16(xyz, lamp_.white(), daylight_.white())
                                            : xyz;
  }
  ReportedColor color(const Spectrum& reflectance) const {
    ReportedColor color;
    color.xyz = lamp_.xyz(reflectance);
    color.lab = lab_of(seen(color.xyz), daylight_.white());
    color.rgb = rgb_of(seen(color.xyz));
    // White is the lamp's own here: what is asked is how wrong products of three numbers are.
    const dvec3 product = rgb_of(daylight_.xyz(reflectance)) * rgb_of(lamp_.white());
    color.rgb_error =
        ciede2000(lab_of(color.xyz, lamp_.white()), lab_of(xyz_of_rgb(product), lamp_.white()));
    return color;
  }
  const dvec3& white() const { return lamp_.white(); }

 private:
  LampObserver lamp_;
  const LampObserver& daylight_;
  Adaptation adaptation_;
};

void add_up_errors(const std::vector<ReportedPigment>& pigments, size_t i, ReportedLamp& lamp) {
  std::vector<double> errors;
  for (size_t k = 0; k < pigments.size(); k++) {
    const ReportedColor& color = pigments[k].colors[i];
    errors.push_back(color.rgb_error);
    if (color.rgb_error > pigments[lamp.worst_pigment].colors[i].rgb_error) lamp.worst_pigment = k;
    if (color.shift > pigments[lamp.most_shifted].colors[i].shift) lamp.most_shifted = k;
  }
  lamp.error_median = quantile(errors, 0.5);
  lamp.error_p95 = quantile(errors, 0.95);
  lamp.error_max = quantile(errors, 1);
}

// Returns under which lamps two pigments are nearest and farthest.
MetamericPair compare_pair(const LampReport& report, size_t first, size_t second) {
  MetamericPair pair{first, second, 0, 0, 1e9, 0};
  for (size_t i = 0; i < report.lamps.size(); i++) {
    const double difference =
        ciede2000(report.pigments[first].colors[i].lab, report.pigments[second].colors[i].lab);
    if (difference < pair.near_de00) pair.near_de00 = difference, pair.near_lamp = i;
    if (difference > pair.far_de00) pair.far_de00 = difference, pair.far_lamp = i;
  }
  return pair;
}

void find_metamers(LampReport& report) {
  for (size_t i = 0; i < report.pigments.size(); i++)
    for (size_t k = i + 1; k < report.pigments.size(); k++) {
      const MetamericPair pair = compare_pair(report, i, k);
      if (pair.near_de00 <= report.settings.near_de00 && pair.far_de00 >= report.settings.far_de00)
        report.pairs.push_back(pair);
    }
  std::ranges::stable_sort(report.pairs, [](const MetamericPair& a, const MetamericPair& b) {
    return a.far_de00 - a.near_de00 > b.far_de00 - b.near_de00;
  });
  if (report.pairs.size() > report.settings.most_pairs)
    report.pairs.erase(report.pairs.begin() + ptrdiff_t(report.settings.most_pairs),
                       report.pairs.end());
}

}  // namespace

LampReport make_lamp_report(const std::string& title, const LampReportSettings& settings,
                            const std::vector<LampSpectrum>& lamps,
                            const std::vector<NamedSpectrum>& pigments) {
  LampReport report;
  report.title = title, report.settings = settings;
  report.lamps.push_back({.lamp = *find_lamp(daylight_name)});
  for (const LampSpectrum& one : lamps)
    if (one.name != daylight_name) report.lamps.push_back({.lamp = one});
  const LampObserver daylight(report.lamps[0].lamp.power);
  std::vector<Look> looks;
  for (ReportedLamp& one : report.lamps) {
    looks.emplace_back(one.lamp.power, daylight, settings.adaptation);
    one.white = looks.back().white();
    const dvec3 rgb = glm::max(rgb_of(one.white), dvec3(0));
    one.white_rgb = rgb / std::max({rgb.x, rgb.y, rgb.z});
  }
  for (const NamedSpectrum& one : pigments) {
    ReportedPigment pigment{one.name, one.source, {}};
    for (const Look& look : looks) {
      pigment.colors.push_back(look.color(one.spectrum));
      pigment.colors.back().shift =
          ciede2000(pigment.colors.front().lab, pigment.colors.back().lab);
    }
    report.pigments.push_back(std::move(pigment));
  }
  if (pigments.empty()) return report;
  for (size_t i = 0; i < report.lamps.size(); i++)
    add_up_errors(report.pigments, i, report.lamps[i]);
  find_metamers(report);
  return report;
}

}  // namespace wellspring::spectrum
