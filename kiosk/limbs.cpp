// SPDX-License-Identifier: Apache-2.0
#include "kiosk/limbs.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/load_error.h"
#include "base/log.h"
#include "kiosk/body/bodies.h"
#include "kiosk/gesture/hand.h"
#include "kiosk/gesture/spot.h"
#include "kiosk/hand/hands.h"

namespace wellspring::kiosk {

namespace {

constexpr double told_for = 0.5;  // seconds a gesture is reported: observations may be thinned out
constexpr size_t most_reads = 1;  // hands that are read in a frame: two take turns
constexpr float far_hands = 3;    // metres; hands of who is farther are not looked for

}  // namespace

struct Limbs::Impl {
  struct BothArms {
    HandTracker skin;
    GestureSpotter spotter;
    HandTracks hands;
    Limbs::Arms told;
    double recognised = -1e9;
    BothArms(const GestureModels& models, const Mount& mount)
        : skin(mount.mirrored), spotter(models), hands(mount) {}
  };

  LimbSettings settings;
  std::optional<BodyWatch> bodies;
  std::optional<HandReader> reader;
  std::map<uint32_t, BothArms> arms;
  double last_time = -1e9;

  std::optional<HandSeen> follow_skin(BothArms& both, const GrayFrame& frame, const Box& face) {
    if (frame.bgr.empty() || frame.width < 1) return {};
    const float scale = float(frame.color_width) / float(frame.width);
    const HeadInView head{vec2(face.center_x(), face.center_y()) * scale, face.width * scale};
    auto seen =
        both.skin.step({frame.color_width, frame.color_height, frame.bgr.data()}, head, frame.time);
    if (seen) seen->pixel /= scale;
    return seen;
  }

  // Returns the place of a pixel as trajectory.h has it.
  vec2 place_of(vec2 pixel, const Box& face) const {
    vec2 place = (pixel - vec2(face.center_x(), face.center_y())) / (shoulder_width * face.width);
    if (!settings.mount.mirrored) place.x = -place.x;
    return place;
  }

  void follow_arms(const GrayFrame& frame, const PersonInView& person, size_t& reads) {
    BothArms& both = arms.try_emplace(person.id, *settings.gestures, settings.mount).first->second;
    // Skin is followed only where landmarks show no hand; a hand that moves may be one of them.
    std::optional<HandSeen> skin;
    if (!reader || both.hands.followed() == 0) skin = follow_skin(both, frame, person.face);
    std::optional<vec2> place = skin ? std::optional(skin->place) : std::nullopt;
    both.told.hands.clear();
    std::string found;
    if (reader && person.depth < far_hands) {
      const float tenth =
          0.1f * focal_length(settings.mount, frame.width, frame.height) / person.depth;
      std::vector<Cut> squares;
      if (both.hands.followed() < 2) {
        if (bodies)
          for (const Forearm& arm : bodies->tracks().forearms(person.id, frame.time))
            squares.push_back(arm.has_elbow ? hand_cut_of_arm(arm.elbow, arm.wrist, tenth)
                                            : hand_cut_of_place(arm.wrist, tenth));
        if (skin) squares.push_back(hand_cut_of_place(skin->pixel, tenth));
      }
      const GrayView picture{frame.pixels.data(), frame.width, frame.height};
      const TintView tint{frame.bgr.data(), frame.color_width, frame.color_height};
      const HandLook look{frame.time, frame.width, frame.height,
                          person.eye, squares,     most_reads - std::min(most_reads, reads)};
      both.told.hands = both.hands.step(look, [&](const Cut& square) {
        reads++;
        return reader->read(picture, tint, square);
      });
      found = both.hands.gesture();
      if (const auto tip = both.hands.index_tip()) place = place_of(*tip, person.face);
    }
    if (const auto spotted = both.spotter.step(frame.time, place); spotted && found.empty())
      found = spotted->label;
    if (!found.empty()) both.told.gesture = found, both.recognised = frame.time;
    if (!(frame.time - both.recognised < told_for)) both.told.gesture.clear();
  }
};

Limbs::Limbs(const LimbSettings& settings) : impl_(std::make_unique<Impl>()) {
  Impl& m = *impl_;
  m.settings = settings;
  if (settings.weights.empty()) return;  // the finder of faces has said so
  try {
    if (settings.bodies) m.bodies.emplace(settings.weights, settings.mount);
  } catch (const LoadError& error) {
    log::warn("nobody is seen from afar: {}", error.what());
  }
  try {
    if (settings.gestures) m.reader.emplace(settings.weights);
  } catch (const LoadError& error) {
    log::warn("hands by the colour of skin alone: {}", error.what());
  }
}
Limbs::~Limbs() = default;

void Limbs::step(const GrayFrame& frame, std::span<const Box> zones,
                 std::span<const PersonInView> people, bool hands) {
  Impl& m = *impl_;
  if (frame.time < m.last_time) m.arms.clear();
  m.last_time = frame.time;
  hands &= m.settings.gestures != nullptr;
  if (m.bodies) {
    std::vector<FaceInView> faces;
    for (const PersonInView& person : people)
      faces.push_back({person.id, person.face, person.depth});
    // Wrists are looked for while the nearest has fewer than two hands that are followed.
    const auto first = people.empty() ? m.arms.end() : m.arms.find(people[0].id);
    const bool wanted =
        hands && m.reader && (first == m.arms.end() || first->second.hands.followed() < 2);
    m.bodies->step(frame, zones, faces, wanted);
  }
  if (!hands) {
    m.arms.clear();
    return;
  }
  size_t reads = 0;
  for (const PersonInView& person : people) m.follow_arms(frame, person, reads);
}

Limbs::Arms Limbs::arms_of(uint32_t id) const {
  const auto found = impl_->arms.find(id);
  return found == impl_->arms.end() ? Arms{} : found->second.told;
}

void Limbs::forget(uint32_t id) { impl_->arms.erase(id); }

std::vector<wire::Body> Limbs::bodies(double time) const {
  return impl_->bodies ? impl_->bodies->tracks().bodies(time) : std::vector<wire::Body>();
}

bool Limbs::somebody_comes() const {
  return impl_->bodies && impl_->bodies->tracks().somebody_comes();
}

bool Limbs::somebody_stays_near(double time) const {
  return impl_->bodies && impl_->bodies->tracks().somebody_stays_near(time);
}

std::optional<bool> Limbs::sees_bodies() const {
  if (!impl_->settings.bodies) return {};
  return impl_->bodies.has_value();
}

std::optional<bool> Limbs::sees_hands() const {
  if (!impl_->settings.gestures) return {};
  return impl_->reader.has_value();
}

}  // namespace wellspring::kiosk
