// SPDX-License-Identifier: Apache-2.0
// Light on what moves (light/known/skin_light.h) gets few samples where it is small in all
// pictures, and none where nobody sees it.
#pragma once

namespace wellspring::show {

inline constexpr double least_interval = 0.2;  // seconds: it is found no more often

// How often and by how much light on what moves is found.
struct SkinPace {
  int samples = 0;      // each time; 0: nothing is traced, and nothing smoothed
  double interval = 0;  // seconds from one time to the next
  bool operator==(const SkinPace&) const = default;
};
// `pixels`: of whoever sees most of it. `known`: samples that a place has already, on average.
SkinPace plan_skin(float pixels, double samples_per_second, float known);

}  // namespace wellspring::show
