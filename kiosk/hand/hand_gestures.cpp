// SPDX-License-Identifier: Apache-2.0
#include "kiosk/hand/hand_gestures.h"

#include <algorithm>
#include <cmath>

namespace wellspring::kiosk {

namespace {

constexpr double kept = 2;           // seconds of moments
constexpr double longest_gap = 0.5;  // seconds
constexpr double recovery = 0.8;     // seconds after a motion in which the way back is none
constexpr float same_sign = 0.8f;    // share of the moments that must show it
constexpr int least_moments = 3;

float turn_between(float from, float to) { return std::remainder(to - from, 2 * pi); }

}  // namespace

void HandGestures::forget() {
  moments_.clear();
  told_ = false;
}

std::string HandGestures::step(double time, const HandShape& shape, vec3 palm, float clockwise) {
  if (!std::isfinite(time) || !is_finite(palm) || !std::isfinite(clockwise)) return {};
  if (!moments_.empty() &&
      (time <= moments_.back().time || time - moments_.back().time > longest_gap)) {
    if (time == moments_.back().time) return {};
    forget();
    told_at_ = std::min(told_at_, time);
  }
  moments_.push_back({time, palm, shape.pose, shape.upright ? shape.fingers : -1, clockwise});
  while (time - moments_.front().time > kept) moments_.pop_front();
  for (std::string found : {swipe(), turn()})
    if (!found.empty()) {
      told_at_ = time;
      return found;
    }
  return held_sign(time);
}

// Returns a sign once while it is held.
std::string HandGestures::held_sign(double time) {
  const int fingers = moments_.back().fingers;
  size_t like = 0, all = 0;
  float way = 0;
  double shown = 0;
  for (size_t i = moments_.size(); i-- > 0;) {
    const Moment& one = moments_[i];
    if (time - one.time > held) break;
    shown = time - one.time;
    all++, like += one.fingers == fingers;
    if (i + 1 < moments_.size()) way += glm::length(vec2(moments_[i + 1].palm) - vec2(one.palm));
  }
  const bool rests = way < still * float(std::max(shown, 0.1));
  const bool same = float(like) >= same_sign * float(all);
  if (fingers < 1 || !same) {
    told_ = false;
    return {};
  }
  const bool long_enough = int(all) >= least_moments && shown >= held - 0.12;
  if (told_ || !long_enough || !rests || time - told_at_ < recovery) return {};
  told_ = true;
  return fingers == 5 ? "stop" : std::to_string(fingers);
}

std::string HandGestures::swipe() const {
  const Moment& now = moments_.back();
  for (size_t i = moments_.size(); i-- > 0;) {
    const Moment& one = moments_[i];
    if (now.time - one.time > swipe_time || one.time < told_at_ + recovery) break;
    if (one.pose == HandPose::fist) break;
    const vec3 way = now.palm - one.palm;
    if (std::abs(way.x) >= swiped && std::abs(way.x) > 2 * std::abs(way.y))
      return way.x < 0 ? "swipe_left" : "swipe_right";
  }
  return {};
}

std::string HandGestures::turn() const {
  const Moment& now = moments_.back();
  if (now.pose != HandPose::fist && now.pose != HandPose::pinch) return {};
  for (size_t i = moments_.size(); i-- > 0;) {
    const Moment& one = moments_[i];
    if (now.time - one.time > turn_time || one.time < told_at_ + recovery) break;
    if (one.pose != now.pose && one.pose != HandPose::other) break;
    const float angle = turn_between(one.roll, now.roll);
    if (std::abs(angle) >= turned && one.pose == now.pose)
      return angle < 0 ? "turn_left" : "turn_right";
  }
  return {};
}

}  // namespace wellspring::kiosk
