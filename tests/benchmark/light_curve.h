// SPDX-License-Identifier: Apache-2.0
// A technique's error over time on one scene: pictures of 1, 2, 4, ... samples a pixel, each drawn
// afresh and timed as a whole, against a reference.
#pragma once
#include <vector>

#include "light/technique/technique.h"

namespace wellspring::test {

struct CurvePoint {
  int spp = 0;
  double seconds = 0, flip = 0, rmse = 0, relative_mse = 0;
  double cpu_seconds = 0;  // all threads' time, which other work on the machine hardly changes
};

// Ends before a picture would take longer than `longest` seconds; one point at least.
std::vector<CurvePoint> measure_curve(const Technique& technique, const World& world,
                                      const Lights& lights, const View& view,
                                      const TransportSettings& transport, const Frame& reference,
                                      double longest);

// When a curve falls to an error: between two points along the line through their logarithms, a
// little beyond the last one along the line through the last three. 0 seconds: it does not fall so
// far.
struct Reached {
  double seconds = 0;
  bool measured = false;  // else extrapolated
};
Reached time_to_flip(const std::vector<CurvePoint>& curve, double level);

}  // namespace wellspring::test
