// SPDX-License-Identifier: Apache-2.0
#include "light_curve.h"

#include <cmath>
#include <ctime>

#include "base/clock.h"
#include "judge/compare.h"
#include "judge/flip.h"
#include "report.h"

namespace wellspring::test {
namespace {

// Quick pictures are timed thrice and the median counts; the picture is the same each time.
CurvePoint measure(const Technique& technique, const World& world, const Lights& lights,
                   const View& view, const StillSettings& settings, const Frame& reference) {
  std::vector<double> seconds, cpu_seconds;
  Frame frame;
  do {
    double began = seconds_now();
    std::clock_t cpu = std::clock();
    frame = render_still(technique, world, lights, view, settings);
    seconds.push_back(seconds_now() - began);
    cpu_seconds.push_back(double(std::clock() - cpu) / CLOCKS_PER_SEC);
  } while (seconds.size() < 3 && seconds[0] < 0.1);
  return {settings.spp,           quantile(seconds, 0.5),         flip(frame, reference),
          rmse(frame, reference), relative_mse(frame, reference), quantile(cpu_seconds, 0.5)};
}

}  // namespace

std::vector<CurvePoint> measure_curve(const Technique& technique, const World& world,
                                      const Lights& lights, const View& view,
                                      const TransportSettings& transport, const Frame& reference,
                                      double longest) {
  std::vector<CurvePoint> curve;
  StillSettings settings;
  settings.transport = transport;
  constexpr int most = 1 << 14;
  for (settings.spp = 1; settings.spp <= most; settings.spp *= 2) {
    settings.seed = 1000 + uint64_t(settings.spp);
    curve.push_back(measure(technique, world, lights, view, settings, reference));
    if (2 * curve.back().seconds > longest) break;
  }
  return curve;
}

Reached time_to_flip(const std::vector<CurvePoint>& curve, double level) {
  if (curve.empty()) return {};
  if (curve[0].flip <= level) return {curve[0].seconds, true};
  auto along = [&](const CurvePoint& a, const CurvePoint& b) {
    double slope = std::log(b.flip / a.flip) / std::log(b.seconds / a.seconds);
    return slope < -0.01 ? a.seconds * std::pow(level / a.flip, 1 / slope) : 0;
  };
  for (size_t i = 1; i < curve.size(); i++)
    if (curve[i].flip <= level) return {along(curve[i - 1], curve[i]), true};
  constexpr double farthest = 8;  // times the last point's
  double seconds = curve.size() > 2 ? along(curve[curve.size() - 3], curve.back()) : 0;
  return {seconds < farthest * curve.back().seconds ? seconds : 0, false};
}

}  // namespace wellspring::test
