// SPDX-License-Identifier: Apache-2.0
#include "kiosk/gesture/trajectory.h"

#include <cmath>

namespace wellspring::kiosk {

Code orientation_code(vec2 step) {
  const float turns = std::atan2(step.y, step.x) / (2 * pi);
  const int code = int(std::lround(turns * orientation_codes));
  return Code((code + orientation_codes) % orientation_codes);
}

bool OrientationCoder::step(const HandPlace& seen, std::vector<CodedStep>& out) {
  const auto [time, place] = seen;
  const bool valid = std::isfinite(time) && std::isfinite(place.x) && std::isfinite(place.y) &&
                     std::abs(place.x) < reach && std::abs(place.y) < reach;
  if (!valid || (started_ && !(time > last_time_))) return false;
  const float passed = float(time - last_time_);
  if (!started_ || passed > away ||
      glm::length(place - last_) > quickest * std::max(passed, 0.05f)) {
    started_ = true;
    last_time_ = anchor_time_ = stay_time_ = time;
    last_ = before_ = anchor_ = stay_ = place;
    return true;
  }
  // The middle one of three places, smoothed by its neighbours (1, 2, 1): one frame late.
  const vec2 smooth = (before_ + 2.f * last_ + place) * 0.25f;
  const double smooth_time = last_time_;
  before_ = last_;
  last_ = place;
  last_time_ = time;
  const bool rested = smooth_time - stay_time_ > rest;
  if (glm::length(smooth - stay_) > 1.5f * code_step) {
    stay_ = smooth;
    stay_time_ = smooth_time;
  } else if (rested) return false;
  const float far = glm::length(smooth - anchor_);
  if (far < code_step) return false;
  // A hand that paused did not creep: it left just now.
  const double begin = std::max(anchor_time_, smooth_time - std::max(0.2, 1.0 * passed));
  const int steps = int(far / code_step);
  const vec2 one = (smooth - anchor_) / far * code_step;
  const double pace = (smooth_time - begin) * code_step / far;
  for (int i = 0; i < steps; i++) {
    out.push_back(
        {orientation_code(one), begin + i * pace, begin + (i + 1) * pace, anchor_, anchor_ + one});
    anchor_ += one;
  }
  anchor_time_ = begin + steps * pace;
  return rested;
}

double OrientationCoder::resting(double time) const { return started_ ? time - stay_time_ : 0; }

std::vector<std::vector<CodedStep>> code_motions(const HandPath& path) {
  OrientationCoder coder;
  std::vector<std::vector<CodedStep>> motions;
  std::vector<CodedStep> fresh;
  for (const HandPlace& seen : path.places) {
    fresh.clear();
    if (coder.step(seen, fresh) || motions.empty()) motions.emplace_back();
    motions.back().insert(motions.back().end(), fresh.begin(), fresh.end());
  }
  std::erase_if(motions, [](const auto& motion) { return motion.empty(); });
  return motions;
}

std::vector<CodedStep> code_path(const HandPath& path) {
  std::vector<CodedStep> longest;
  for (auto& motion : code_motions(path))
    if (motion.size() > longest.size()) longest = std::move(motion);
  return longest;
}

}  // namespace wellspring::kiosk
