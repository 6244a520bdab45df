// SPDX-License-Identifier: Apache-2.0
#include "kiosk/observe.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "kiosk/one_euro.h"
#include "kiosk/turn.h"

namespace wellspring {

namespace {

// Bearings are steady and must not lag; the distance follows the box's size, which trembles by a
// few per cent.
constexpr OneEuroSettings bearing_filter{1.5f, 8.f, 1.f};    // tangents
constexpr OneEuroSettings distance_filter{0.5f, 1.5f, 1.f};  // logarithm of metres
constexpr OneEuroSettings rotation_filter{1.2f, 1.5f, 1.f};  // radians

}  // namespace

struct Observer::Impl {
  ObserverSettings settings;
  FaceFinder finder;
  MotionWatch motion;
  People people;
  PresenceState presence;
  struct Head {
    OneEuro bearing, distance, rotation;
    Turn turn;
    Person person;
    double seen_time = 0;
  };
  std::map<uint32_t, Head> heads;
  GrayFrame previous;
  double last_time = -1e9;

  explicit Impl(const ObserverSettings& s)
      : settings(s), finder(s.face), motion(s.motion), people(finder, s.people) {}

  const Person& place(Head& head, const GrayFrame& frame, const Followed& who) {
    const Mount& mount = settings.mount;
    const float focal = focal_length(mount, frame.width);
    vec3 raw = face_in_camera(who.face.box, focal, frame.width, frame.height);
    vec3 bearing =
        step_one_euro(head.bearing, bearing_filter, frame.time, {raw.x / raw.z, raw.y / raw.z, 0});
    vec3 away = step_one_euro(head.distance, distance_filter, frame.time, {std::log(raw.z), 0, 0});
    vec3 camera = vec3(bearing.x, bearing.y, 1) * std::exp(away.x);
    head.person.id = who.id;
    head.person.position = camera_to_screen(mount, camera);
    const float rest =
        yaw_pitch_roll(rotation_as_seen(mount, rotation_to_center(head.person.position), camera)).y;
    const mat3 seen = head.turn.step(previous, frame, who.face, who.seen, rest);
    people.tilt(who.id, yaw_pitch_roll(seen).z);
    const vec3 rotation = rotation_on_screen(mount, seen, camera);
    head.person.rotation = step_one_euro(head.rotation, rotation_filter, frame.time, rotation);
    head.person.confidence = std::clamp(who.face.confidence, 0.f, 1.f);
    head.seen_time = frame.time;
    return head.person;
  }

  Observation finish(double time, bool moving, bool face) {
    Observation out;
    out.time = time;
    out.state = step_presence(presence, settings.presence, time, moving, face);
    const double hold = settings.presence.hold_person;
    if (out.state == Presence::person)
      for (const auto& [id, head] :
           heads) {  // one just lost stays where it was, less and less surely
        double age = time - head.seen_time;
        if (age < 0 || age > hold) continue;
        Person person = head.person;
        person.confidence *= float(1 - age / hold);
        out.people.push_back(person);
      }
    std::sort(out.people.begin(), out.people.end(), [](const Person& a, const Person& b) {
      return glm::dot(a.position, a.position) < glm::dot(b.position, b.position);
    });
    return out;
  }
};

Observer::Observer(const ObserverSettings& settings) : impl_(std::make_unique<Impl>(settings)) {}
Observer::~Observer() = default;

Observation Observer::step(const GrayFrame& frame) {
  Impl& m = *impl_;
  if (frame.time < m.last_time) m.heads.clear();
  m.last_time = frame.time;
  Motion motion = m.motion.step(frame);
  bool face = false;
  for (const Followed& who : m.people.step(frame, motion, m.motion)) {
    if (who.picture) {
      m.heads.erase(who.id);
      continue;
    }
    if (!who.visible) continue;
    face = true;
    m.place(m.heads[who.id], frame, who);
  }
  std::erase_if(m.heads, [&](const auto& head) {
    return frame.time - head.second.seen_time > m.settings.people.recall;
  });
  m.previous = frame;
  return m.finish(frame.time, motion.moving, face);
}

Observation Observer::step_blind(double time) {
  impl_->last_time = std::max(impl_->last_time, time);
  return impl_->finish(time, false, false);
}

}  // namespace wellspring
