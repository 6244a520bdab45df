// SPDX-License-Identifier: Apache-2.0
#include "kiosk/calibrate.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace wellspring::kiosk {
namespace {

constexpr double steady_for = 2;   // seconds
constexpr float steady = 0.04f;    // metres to the middle of the places seen meanwhile
constexpr float step_back = 1.4f;  // factor to the first mark's distance, at least
constexpr float most_aside = 5 * pi / 180;

}  // namespace

Mount solve_mount(const Mount& mount, vec3 at_near, vec3 at_far, std::optional<float> eyes) {
  const vec3 a = screen_to_camera(mount, at_near), way = screen_to_camera(mount, at_far) - a;
  const float length = far_mark - near_mark, aside2 = way.x * way.x + way.y * way.y;
  if (!is_finite(a) || !is_finite(way) || !(way.z > 0.2f * length) || aside2 > 0.5f * length)
    throw std::runtime_error("the second mark was not seen behind the first");
  if (std::abs(std::atan2(way.x, way.z)) > most_aside)
    throw std::runtime_error("the camera looks to the side; turn it to the middle and begin again");
  // Distances grow with the focal length; ways across do not.
  const float longer = std::sqrt(length * length - aside2) / way.z;
  Mount solved = mount;
  solved.fov = 2 * std::atan(std::tan(0.5f * mount.fov) / longer);
  solved.offset = vec3(0);
  auto place = [&](vec3 camera) {
    return camera_to_screen(solved, {camera.x, camera.y, camera.z * longer});
  };
  // The eyes are as high at both marks.
  auto rise = [&](float pitch) {
    solved.pitch = pitch;
    return std::abs(place(a + way).y - place(a).y);
  };
  const float tilt = std::atan2(way.y, way.z * longer);
  solved.pitch = rise(tilt) < rise(-tilt) ? tilt : -tilt;
  const vec3 seen = place(a);
  solved.offset = {-seen.x, eyes ? *eyes - seen.y : mount.offset.y, near_mark - seen.z};
  return solved;
}

bool Calibration::step(const Observation& seen) {
  if (found_.size() == 2) return true;
  if (seen.people.size() != 1) {
    looks_.clear();
    return false;
  }
  looks_.push_back({seen.time, seen.people[0].position});
  std::erase_if(looks_, [&](const Look& look) { return look.time < seen.time - steady_for; });
  vec3 middle(0);
  for (const Look& look : looks_) middle += look.place / float(looks_.size());
  auto apart = [&](const Look& look) { return glm::length(look.place - middle) > steady; };
  if (std::any_of(looks_.begin(), looks_.end(), apart)) {
    looks_.erase(looks_.begin());
    return false;
  }
  if (seen.time - looks_.front().time < 0.9 * steady_for) return false;
  if (found_.size() == 1 && middle.z < step_back * found_[0].z) return false;
  found_.push_back(middle);
  looks_.clear();
  return found_.size() == 2;
}

CalibrationStep Calibration::now() const {
  using What = CalibrationStep::What;
  if (found_.size() == 2) return {What::done, 0, 1};
  double kept_still = 0;  // seconds
  for (auto look = looks_.rbegin(); look != looks_.rend(); look++) {
    if (glm::length(look->place - looks_.back().place) > steady) break;
    kept_still = looks_.back().time - look->time;
  }
  return {found_.empty() ? What::near_mark : What::far_mark, found_.empty() ? near_mark : far_mark,
          float(std::min(kept_still / (0.9 * steady_for), 1.0))};
}

std::string Calibration::advice() const {
  if (found_.size() == 2) return "Thank you.";
  char text[160];
  std::snprintf(text, sizeof text,
                "%s %.1f m straight before the middle of the screen, look at its middle and keep "
                "still.",
                found_.empty() ? "Stand" : "Now step back: stand",
                double(found_.empty() ? near_mark : far_mark));
  return text;
}

}  // namespace wellspring::kiosk
