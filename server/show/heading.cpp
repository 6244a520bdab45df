// SPDX-License-Identifier: Apache-2.0
#include "show/heading.h"

#include <algorithm>
#include <cmath>

#include "cache/predict.h"

namespace wellspring {
namespace {

constexpr double motion_seconds = 0.05;  // in which motion is measured: inputs may come thirty times a second
constexpr size_t most_past = 32;         // views of that time
constexpr float fastest = 25;            // metres a second; more is a jump
constexpr float smallest_leap = 0.5f;    // metres

}  // namespace

bool note_view(Heading& heading, double time, const View& view) {
  std::vector<Heading::PastView>& past = heading.past;
  bool leapt = false;
  if (!past.empty()) {
    float passed = float(time - past.back().time);
    leapt = length(view.position - past.back().view.position) > fastest * passed + smallest_leap;
  }
  auto of_no_use = [&](const Heading::PastView& one) {
    return leapt || time - one.time > motion_seconds || one.view.width != view.width || one.view.height != view.height;
  };
  past.erase(past.begin(), std::find_if_not(past.begin(), past.end(), of_no_use));
  if (past.size() >= most_past) past.erase(past.begin());
  past.push_back({time, view});
  return leapt;
}

View expected_view(const Heading& heading, const View& now, double seconds) {
  // Of a quick turn less than all views are enough.
  for (const Heading::PastView& past : heading.past) {
    double passed = heading.past.back().time - past.time;
    if (!(passed > 0)) break;
    View ahead = extrapolate(past.view, now, float(seconds / passed));
    if (ahead != now) return ahead;
  }
  return now;
}

float expected_turn(const Heading& heading, const View& now, double seconds) {
  return std::acos(std::clamp(dot(now.forward, expected_view(heading, now, seconds).forward), -1.0f, 1.0f));
}

}  // namespace wellspring
