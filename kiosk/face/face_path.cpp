// SPDX-License-Identifier: Apache-2.0
#include "kiosk/face/face_path.h"

#include <algorithm>
#include <cmath>

namespace wellspring::kiosk {

namespace {

constexpr double pace_over = 0.25, width_over = 0.5;  // seconds
constexpr double most_ahead = 0.5;                    // seconds that a pace is believed
constexpr double longest_gap = 1;                     // seconds after which no more is allowed
constexpr float near = 0.45f, quick = 1.3f;           // widths, and widths a second
constexpr float alike = 0.22f, grows = 0.25f;         // logarithm of sizes, and a second of it

vec2 middle_of(const Box& box) { return {box.center_x(), box.center_y()}; }

}  // namespace

void add_place(FacePath& path, double time, const Box& face) {
  const double step = time - path.time;
  if (!path.started || !(step > 0)) {
    const vec2 pace = path.started ? path.pace : vec2(0);
    path = {true, time, middle_of(face), pace, face.width};
    return;
  }
  const vec2 now = (middle_of(face) - path.middle) / float(step);
  path.pace += float(1 - std::exp(-step / pace_over)) * (now - path.pace);
  path.width += float(1 - std::exp(-step / width_over)) * (face.width - path.width);
  path.time = time, path.middle = middle_of(face);
}

Box predict(const FacePath& path, double time) {
  const float ahead = float(std::clamp(time - path.time, 0.0, most_ahead));
  const vec2 middle = path.middle + ahead * path.pace;
  return {middle.x - path.width / 2, middle.y - path.width / 2, path.width, path.width};
}

std::optional<float> misfit(const FacePath& path, double time, const Box& face) {
  if (!path.started || !(path.width > 0) || !(face.width > 0)) return {};
  const float gap = float(std::clamp(time - path.time, 0.0, longest_gap));
  const vec2 off = middle_of(face) - middle_of(predict(path, time));
  const float away = glm::length(off) / path.width / (near + quick * gap);
  const float size = std::abs(std::log(face.width / path.width)) / (alike + grows * gap);
  const float worst = std::max(away, size);
  return worst < 1 ? std::optional(0.5f * (away + size)) : std::nullopt;
}

}  // namespace wellspring::kiosk
