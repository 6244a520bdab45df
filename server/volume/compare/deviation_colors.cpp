// SPDX-License-Identifier: Apache-2.0
#include "volume/compare/deviation_colors.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace wellspring::volume {

namespace {

constexpr vec3 not_found_color{0.18f, 0.18f, 0.18f};
constexpr vec3 distance_ramp[] = {{0.01f, 0.05f, 0.40f},
                                  {0.15f, 0.40f, 0.85f},
                                  {1, 1, 1},
                                  {0.95f, 0.65f, 0.10f},
                                  {0.50f, 0.12f, 0.00f}};
constexpr vec3 angle_ramp[] = {
    {0.01f, 0.01f, 0.12f}, {0.02f, 0.12f, 0.35f}, {0.05f, 0.40f, 0.35f}, {0.95f, 0.80f, 0.15f}};

vec3 ramp_color(std::span<const vec3> ramp, double at) {
  const double place = std::clamp(at, 0.0, 1.0) * double(ramp.size() - 1);
  const size_t before = std::min(size_t(place), ramp.size() - 2);
  return glm::mix(ramp[before], ramp[before + 1], float(place - double(before)));
}

// Puts ticks at multiples of 1, 2 or 5 times a power of ten.
void add_ticks(ColorScale& scale) {
  const double rough = (scale.high - scale.low) / 8;
  const double power = std::pow(10, std::floor(std::log10(rough)));
  double step = power * 10;
  for (double factor : {5.0, 2.0, 1.0})
    if (power * factor >= rough * 0.9999) step = power * factor;
  for (double i = std::ceil(scale.low / step - 1e-9); i <= scale.high / step + 1e-9; i++)
    scale.ticks.push_back({i * step, (i * step - scale.low) / (scale.high - scale.low)});
}

}  // namespace

ColorScale distance_scale(double range_mm) {
  ColorScale scale{Shown::distance, -range_mm, range_mm, "mm", {}};
  add_ticks(scale);
  return scale;
}

ColorScale angle_scale(double range_degrees) {
  ColorScale scale{Shown::normal_angle, 0, range_degrees, "degrees", {}};
  add_ticks(scale);
  return scale;
}

vec3 scale_color(const ColorScale& scale, double value) {
  const double at = (value - scale.low) / (scale.high - scale.low);
  if (!std::isfinite(at)) return not_found_color;
  if (scale.shown == Shown::distance) return ramp_color(distance_ramp, at);
  return ramp_color(angle_ramp, at);
}

std::vector<vec3> deviation_colors(const ColorScale& scale,
                                   const std::vector<Deviation>& deviations) {
  std::vector<vec3> colors;
  colors.reserve(deviations.size());
  for (const Deviation& one : deviations) {
    const double value = scale.shown == Shown::distance ? one.distance * 1000.0
                                                        : glm::degrees(double(one.normal_angle));
    colors.push_back(one.found ? scale_color(scale, value) : not_found_color);
  }
  return colors;
}

}  // namespace wellspring::volume
