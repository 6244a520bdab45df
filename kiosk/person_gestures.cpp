// SPDX-License-Identifier: Apache-2.0
#include "kiosk/person_gestures.h"

#include <map>

#include "kiosk/gesture/hand.h"
#include "kiosk/gesture/spot.h"

namespace wellspring::kiosk {

namespace {

constexpr double told_for = 0.5;  // seconds: observations may be thinned out

struct Arm {
  HandTracker hand;
  GestureSpotter spotter;
  std::string gesture;
  double recognised = -1e9;
  Arm(const GestureModels& models, bool mirrored) : hand(mirrored), spotter(models) {}
};

}  // namespace

struct PersonGestures::Impl {
  const GestureModels* models;
  bool mirrored;
  std::map<uint32_t, Arm> arms;
};

PersonGestures::PersonGestures(const GestureModels* models, bool mirrored)
    : impl_(std::make_unique<Impl>(Impl{models, mirrored, {}})) {}
PersonGestures::~PersonGestures() = default;

std::string PersonGestures::step(const GrayFrame& frame, uint32_t id, const Box& face) {
  if (!impl_->models || frame.bgr.empty() || frame.width < 1) return {};
  Arm& arm = impl_->arms.try_emplace(id, *impl_->models, impl_->mirrored).first->second;
  const float scale = float(frame.color_width) / float(frame.width);
  const HeadInView head{vec2(face.center_x(), face.center_y()) * scale, face.width * scale};
  const ColorView view{frame.color_width, frame.color_height, frame.bgr.data()};
  const std::optional<HandSeen> hand = arm.hand.step(view, head, frame.time);
  const std::optional<vec2> place = hand ? std::optional(hand->place) : std::nullopt;
  if (const auto found = arm.spotter.step(frame.time, place)) {
    arm.gesture = found->label;
    arm.recognised = frame.time;
  }
  return frame.time - arm.recognised < told_for ? arm.gesture : std::string();
}

void PersonGestures::forget(uint32_t id) { impl_->arms.erase(id); }

}  // namespace wellspring::kiosk
