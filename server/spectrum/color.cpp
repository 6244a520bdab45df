// SPDX-License-Identifier: Apache-2.0
#include "spectrum/color.h"

#include <algorithm>
#include <cmath>

#include "spectrum/lamps.h"
#include "spectrum/observer.h"

namespace wellspring::spectrum {
namespace {

constexpr double degree_angle = 3.14159265358979323846 / 180;

double lab_response(double t) {
  constexpr double edge = 6.0 / 29;
  return t > edge * edge * edge ? std::cbrt(t) : t / (3 * edge * edge) + 4.0 / 29;
}

double hue_of(double a, double b) {
  if (a == 0 && b == 0) return 0;
  const double hue = std::atan2(b, a) / degree_angle;
  return hue < 0 ? hue + 360 : hue;
}

// Returns the share of the rotation that blue colours get, of their mean chroma.
double chroma_share(double chroma) {
  const double c7 = std::pow(chroma, 7);
  return std::sqrt(c7 / (c7 + 6103515625.0));  // 25^7
}

// The matrix of CAT16 to responses of sharpened cones.
dvec3 cones_of(const dvec3& xyz) {
  return {0.401288 * xyz.x + 0.650173 * xyz.y - 0.051461 * xyz.z,
          -0.250268 * xyz.x + 1.204414 * xyz.y + 0.045854 * xyz.z,
          -0.002079 * xyz.x + 0.048952 * xyz.y + 0.953127 * xyz.z};
}
const glm::dmat3& from_cones() {
  static const glm::dmat3 made =
      glm::inverse(glm::dmat3(cones_of({1, 0, 0}), cones_of({0, 1, 0}), cones_of({0, 0, 1})));
  return made;
}

// The primaries and white of Rec. 709, by their chromaticities.
const glm::dmat3& rec709() {
  static const glm::dmat3 made = [] {
    const auto at = [](double x, double y) { return dvec3(x / y, 1, (1 - x - y) / y); };
    glm::dmat3 primaries(at(0.64, 0.33), at(0.30, 0.60), at(0.15, 0.06));
    const dvec3 scale = glm::inverse(primaries) * at(0.3127, 0.3290);
    for (int i = 0; i < 3; i++) primaries[i] *= scale[i];
    return primaries;
  }();
  return made;
}

// Returns u and v of CIE 1960.
dvec2 old_uv(const dvec3& xyz) {
  const dvec2 uv = uv_of(xyz);
  return {uv.x, uv.y * 2 / 3};
}

dvec2 blackbody_uv(double mired) { return old_uv(xyz_of(blackbody(1e6 / mired))); }

}  // namespace

dvec3 lab_of(const dvec3& xyz, const dvec3& white) {
  const double x = lab_response(xyz.x / white.x), y = lab_response(xyz.y / white.y),
               z = lab_response(xyz.z / white.z);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

double ciede2000(const dvec3& lab, const dvec3& other) {
  const double mean_ab = 0.5 * (std::hypot(lab.y, lab.z) + std::hypot(other.y, other.z));
  const double stretch = 1 + 0.5 * (1 - chroma_share(mean_ab));
  const double a1 = lab.y * stretch, a2 = other.y * stretch;
  const double c1 = std::hypot(a1, lab.z), c2 = std::hypot(a2, other.z);
  const double h1 = hue_of(a1, lab.z), h2 = hue_of(a2, other.z);
  const bool is_grey = c1 * c2 == 0;
  double turn = is_grey ? 0 : h2 - h1;
  if (turn > 180) turn -= 360;
  if (turn < -180) turn += 360;
  double hue = h1 + h2;
  if (!is_grey) {
    if (std::abs(h1 - h2) > 180) hue += hue < 360 ? 360 : -360;
    hue /= 2;
  }
  const double light = 0.5 * (lab.x + other.x), chroma = 0.5 * (c1 + c2);
  const auto cosine = [](double angle) { return std::cos(angle * degree_angle); };
  const double t = 1 - 0.17 * cosine(hue - 30) + 0.24 * cosine(2 * hue) +
                   0.32 * cosine(3 * hue + 6) - 0.20 * cosine(4 * hue - 63);
  const double off = (light - 50) * (light - 50);
  const double by_light = (other.x - lab.x) / (1 + 0.015 * off / std::sqrt(20 + off));
  const double by_chroma = (c2 - c1) / (1 + 0.045 * chroma);
  const double by_hue =
      2 * std::sqrt(c1 * c2) * std::sin(0.5 * turn * degree_angle) / (1 + 0.015 * chroma * t);
  const double blue = (hue - 275) / 25;
  const double rotation =
      -2 * chroma_share(chroma) * std::sin(60 * std::exp(-blue * blue) * degree_angle);
  return std::sqrt(std::max(0.0, by_light * by_light + by_chroma * by_chroma + by_hue * by_hue +
                                     rotation * by_chroma * by_hue));
}

dvec2 uv_of(const dvec3& xyz) {
  const double sum = xyz.x + 15 * xyz.y + 3 * xyz.z;
  return sum > 0 ? dvec2(4 * xyz.x, 9 * xyz.y) / sum : dvec2(0);
}

dvec3 adapt_cat16(const dvec3& xyz, const dvec3& from, const dvec3& to, double degree) {
  const dvec3 gain = degree * (cones_of(to) / cones_of(from)) + (1 - degree);
  return from_cones() * (gain * cones_of(xyz));
}

dvec3 rgb_of(const dvec3& xyz) {
  static const glm::dmat3 inverse = glm::inverse(rec709());
  return inverse * xyz;
}

dvec3 xyz_of_rgb(const dvec3& rgb) { return rec709() * rgb; }

std::optional<ColorTemperature> correlated_temperature(const dvec3& xyz) {
  const dvec2 uv = old_uv(xyz);
  const auto distance = [&](double mired) { return glm::distance(uv, blackbody_uv(mired)); };
  constexpr double coolest = 40, warmest = 1000, step = 20;  // 25000 K and 1000 K
  double best = coolest;
  for (double mired = coolest; mired <= warmest; mired += step)
    if (distance(mired) < distance(best)) best = mired;
  double low = std::max(best - step, coolest), high = std::min(best + step, warmest);
  while (high - low > 1e-3) {  // thirds rather than golden sections: it is called once a lamp
    const double left = low + (high - low) / 3, right = high - (high - low) / 3;
    (distance(left) < distance(right) ? high : low) =
        distance(left) < distance(right) ? right : left;
  }
  const double mired = 0.5 * (low + high);
  const double away = std::round(distance(mired) * 1e4) / 1e4;  // as exactly as it is ever told
  if (!(away <= 0.05)) return {};
  const bool is_above = away == 0 || uv.y > blackbody_uv(mired).y;
  return ColorTemperature{1e6 / mired, is_above ? away : -away};
}

}  // namespace wellspring::spectrum
