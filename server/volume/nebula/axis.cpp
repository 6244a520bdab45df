// SPDX-License-Identifier: Apache-2.0
#include "volume/nebula/axis.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <vector>

namespace wellspring::volume {

namespace {

// Holds moments of a picture's light about a place.
struct Moments {
  double light = 0;
  glm::dvec2 first{0};
  double xx = 0, xy = 0, yy = 0;

  void add(glm::dvec2 place, double weight) {
    light += weight, first += weight * place;
    xx += weight * place.x * place.x, xy += weight * place.x * place.y;
    yy += weight * place.y * place.y;
  }
};

template <class Act>
void each_lit_pixel(const image::LinearImage& picture, const Act& act) {
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      const vec3 color = picture.color[size_t(y) * size_t(picture.width) + size_t(x)];
      const double light = double(color.x) + double(color.y) + double(color.z);
      if (light > 0) act(glm::dvec2(x + 0.5, y + 0.5), light);
    }
}

// Returns the distance within which `part` of the weight lies. Sorts `found`.
double weighted_quantile(std::vector<std::pair<double, double>>& found, double part) {
  std::sort(found.begin(), found.end());
  double all = 0, sum = 0;
  for (const auto& [distance, weight] : found) all += weight;
  for (const auto& [distance, weight] : found)
    if ((sum += weight) >= part * all) return distance;
  return found.empty() ? 0 : found.back().first;
}

}  // namespace

glm::dvec2 PictureAxis::along_and_beside(glm::dvec2 place) const {
  const glm::dvec2 from = place - centre;
  const double c = std::cos(angle), s = std::sin(angle);
  return {from.x * c - from.y * s, -from.x * s - from.y * c};
}

PictureAxis propose_axis(const image::LinearImage& picture) {
  PictureAxis axis{{0.5 * picture.width, 0.5 * picture.height}, 0};
  Moments whole;
  each_lit_pixel(picture, [&](glm::dvec2 place, double light) { whole.add(place, light); });
  if (whole.light <= 0) return axis;
  axis.centre = whole.first / whole.light;
  Moments central;
  each_lit_pixel(picture,
                 [&](glm::dvec2 place, double light) { central.add(place - axis.centre, light); });
  const double apart = central.xx - central.yy, mixed = 2 * central.xy;
  if (std::hypot(apart, mixed) <= 1e-9 * (central.xx + central.yy)) return axis;
  axis.angle = -0.5 * std::atan2(mixed, apart);  // y runs downwards
  if (axis.angle <= -glm::half_pi<double>()) axis.angle += glm::pi<double>();
  return axis;
}

std::optional<double> propose_tilt(const image::LinearImage& picture, const PictureAxis& axis) {
  // The shapes are what is brighter than these parts of the brightest light.
  constexpr double thresholds[] = {0.7, 0.5, 0.35, 0.25, 0.15};
  constexpr int fewest_pixels = 30;
  constexpr double roundest = 0.75;  // rounder shapes may be anything
  double brightest = 0;
  each_lit_pixel(picture,
                 [&](glm::dvec2, double light) { brightest = std::max(brightest, light); });
  double best = roundest;
  for (const double threshold : thresholds) {
    Moments shape;
    each_lit_pixel(picture, [&](glm::dvec2 place, double light) {
      if (light >= threshold * brightest) shape.add(axis.along_and_beside(place), 1);
    });
    if (shape.light < fewest_pixels) continue;
    const glm::dvec2 mean = shape.first / shape.light;
    const double along = shape.xx / shape.light - mean.x * mean.x,
                 beside = shape.yy / shape.light - mean.y * mean.y;
    if (beside > 0) best = std::min(best, std::sqrt(std::max(0.0, along) / beside));
  }
  if (best >= roundest) return {};
  return std::asin(best);
}

glm::dvec2 light_extent(const image::LinearImage& picture, const PictureAxis& axis, double part) {
  std::vector<std::pair<double, double>> along, beside;
  each_lit_pixel(picture, [&](glm::dvec2 place, double light) {
    const glm::dvec2 at = glm::abs(axis.along_and_beside(place));
    along.emplace_back(at.x, light), beside.emplace_back(at.y, light);
  });
  return glm::max(glm::dvec2(weighted_quantile(along, part), weighted_quantile(beside, part)) + 0.5,
                  0.5);
}

}  // namespace wellspring::volume
