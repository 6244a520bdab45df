// SPDX-License-Identifier: Apache-2.0
#include "kiosk/observe.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "base/load_error.h"
#include "base/log.h"
#include "kiosk/face/face_finder.h"
#include "kiosk/face/head_pose.h"
#include "kiosk/limbs.h"
#include "kiosk/station/station.h"

namespace wellspring::kiosk {

namespace {

void gather(double& evidence, bool cue, double step, double enough) {
  evidence = std::clamp(evidence + (cue ? step : -step), 0.0, enough);
}

}  // namespace

Presence step_presence(PresenceState& state, const PresenceSettings& settings, double time,
                       bool moving, bool face, bool coming) {
  if (!std::isfinite(time)) return state.now;
  if (!state.started) {
    state.started = true;
    state.since = state.last_time = time;
  }
  if (time < state.last_time) {  // the clock was set back, so every age is kept as it is
    double shift = time - state.last_time;
    state.since += shift;
    state.last_motion += shift;
    state.last_face += shift;
    state.last_time = time;
  }
  double step = std::min(time - state.last_time, settings.longest_step);
  state.last_time = time;
  gather(state.motion_evidence, moving, step, settings.wake_after);
  gather(state.face_evidence, face, step, settings.confirm_after);
  if (coming) state.motion_evidence = settings.wake_after;
  if (moving || coming) state.last_motion = time;
  if (face) state.last_face = time;

  // Sums of frame times carry rounding, which must not decide about a tick of the clock.
  constexpr double rounding = 1e-6;
  const bool woken = state.motion_evidence >= settings.wake_after - rounding;
  const bool confirmed = state.face_evidence >= settings.confirm_after - rounding;
  const bool quiet = time - std::max(state.last_motion, state.last_face) > settings.hold_motion;

  Presence next = state.now;
  switch (state.now) {
    case Presence::absent:
      if (confirmed) next = Presence::person;
      else if (woken) next = Presence::motion;
      break;
    case Presence::motion:
      if (confirmed) next = Presence::person;
      else if (quiet) next = Presence::absent;
      break;
    case Presence::person:
      if (time - state.last_face > settings.hold_person)
        next = quiet ? Presence::absent : Presence::motion;
      break;
  }
  if (next != state.now) {
    state.now = next;
    state.since = time;
    if (next != Presence::person) state.face_evidence = 0;
    if (next == Presence::absent) state.motion_evidence = 0;
  }
  return state.now;
}

namespace {

// Bearings are steady and must not lag; the distance follows the box's size, which trembles by a
// few per cent.
constexpr OneEuroSettings bearing_filter{1.5f, 8.f, 1.f};    // tangents
constexpr OneEuroSettings distance_filter{0.5f, 1.5f, 1.f};  // logarithm of metres

std::string folder_of_graphs(const ObserverSettings& settings) {
  if (!settings.graphs.empty()) return settings.graphs;
  const std::filesystem::path weights = weights_folder(settings.face);
  return (weights.parent_path() / "human").string();
}

}  // namespace

struct Observer::Impl {
  ObserverSettings settings;
  std::unique_ptr<FaceFinder> finder;
  MotionWatch motion;
  People people;
  PresenceState presence;
  Limbs limbs;
  std::optional<Station> station;
  EyeNeeds needs;
  struct Head {
    OneEuro bearing, distance, rotation;
    ExpressionState expression;
    Person person;
    double seen_time = 0;
  };
  std::map<uint32_t, Head> heads;
  double last_time = -1e9;
  std::optional<ClassReader> classes;  // only while expressions are asked for
  bool read_classes = false;           // whether this frame reads them: one look a frame

  explicit Impl(const ObserverSettings& s)
      : settings(s),
        finder(make_face_finder(s.face)),
        motion(s.motion),
        people(*finder, s.people),
        limbs({s.mount, folder_of_graphs(s), s.bodies, s.gestures}) {
    if (s.station) station.emplace(*s.station, StationSettings{.mount = s.mount});
    settings.station.reset();  // the station has its own
    if (!s.expression) return;
    const std::string folder = weights_folder(s.face);
    try {
      classes.emplace(folder);
      log::info("expressions are estimated: visitors must be told before they are seen");
    } catch (const LoadError& error) {
      log::warn("no expressions: {}", error.what());
    }
  }

  void express(Head& head, const GrayFrame& frame, const FaceMarks& marks, const HeadPose& pose) {
    FaceClasses now;
    const bool read =
        !read_classes && frame.time - head.expression.read_time >= settings.expressions.read_every;
    if (read)
      now = classes->read({frame.pixels.data(), frame.width, frame.height}, cut_of_marks(marks));
    read_classes |= read;
    const float focal = focal_length(settings.mount, frame.width);
    head.person.expression = step_expression(
        head.expression, settings.expressions, frame.time,
        face_plane(marks, pose, focal, frame.width, frame.height), read ? &now : nullptr);
  }

  // Guesses without landmarks: somebody looks at the screen, but for what eyes and profiles show.
  vec3 crude_rotation(const Person& person, const Followed& who, vec3 camera) {
    const Mount& mount = settings.mount;
    constexpr float profile_yaw = 0.9f;  // radians
    vec3 angles =
        yaw_pitch_roll(rotation_as_seen(mount, rotation_to_center(person.position), camera));
    if (who.face.view != FaceView::frontal)
      angles.x = who.face.view == FaceView::image_left ? profile_yaw : -profile_yaw;
    if (who.face.eyes) {
      const vec2 d = (*who.face.eyes)[1] - (*who.face.eyes)[0];
      angles.z = std::atan2(-d.y, d.x);
    }
    people.tilt(who.id, angles.z);
    return rotation_on_screen(mount, rotation_matrix(angles), camera);
  }

  const Person& place(Head& head, const GrayFrame& frame, const Followed& who) {
    const Mount& mount = settings.mount;
    const float focal = focal_length(mount, frame.width);
    std::optional<HeadPose> pose;
    if (who.face.marks) pose = solve_head_pose(*who.face.marks, focal, frame.width, frame.height);
    vec3 raw =
        pose ? pose->position : face_in_camera(who.face.box, focal, frame.width, frame.height);
    vec3 bearing =
        step_one_euro(head.bearing, bearing_filter, frame.time, {raw.x / raw.z, raw.y / raw.z, 0});
    vec3 away = step_one_euro(head.distance, distance_filter, frame.time, {std::log(raw.z), 0, 0});
    vec3 camera = vec3(bearing.x, bearing.y, 1) * std::exp(away.x);
    head.person.id = who.id;
    head.person.position = camera_to_screen(mount, camera);
    const vec3 rotation =
        pose ? rotation_on_screen(mount, pose->rotation) : crude_rotation(head.person, who, camera);
    head.person.rotation = step_one_euro(head.rotation, rotation_filter, frame.time, rotation);
    if (classes && pose && needs.expression) express(head, frame, *who.face.marks, *pose);
    head.person.confidence = std::clamp(who.face.confidence, 0.f, 1.f);
    head.seen_time = frame.time;
    return head.person;
  }

  EyeParts parts() const {
    EyeParts out;
    out.faces = finder->finds_landmarks();
    if (settings.expression) out.expression = classes.has_value();
    out.bodies = limbs.sees_bodies();
    out.hands = limbs.sees_hands();
    if (station) out.objects = true;
    return out;
  }

  Observation finish(double time, bool moving, bool face) {
    Observation out;
    out.time = time;
    out.parts = parts();
    out.state = step_presence(presence, settings.presence, time, moving,
                              face || limbs.somebody_stays_near(time), limbs.somebody_comes());
    out.bodies = limbs.bodies(time);
    const double hold = settings.presence.hold_person;
    if (out.state == Presence::person)
      for (const auto& [id, head] :
           heads) {  // a person just lost stays where they were, less and less surely
        double age = time - head.seen_time;
        if (age < 0 || age > hold) continue;
        Person person = head.person;
        person.confidence *= float(1 - age / hold);
        if (age > 0) person.hands.clear();
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
  m.read_classes = false;
  std::vector<PersonInView> in_view;
  for (const Followed& who : m.people.step(frame, motion, m.motion)) {
    if (who.picture) {
      m.heads.erase(who.id);
      continue;
    }
    if (!who.visible) continue;
    face = true;
    const Person& person = m.place(m.heads[who.id], frame, who);
    const float depth = screen_to_camera(m.settings.mount, person.position).z;
    in_view.push_back({who.id, who.face.box, depth, person.position});
  }
  m.limbs.step(frame, motion.zones, in_view, m.needs.gestures);
  for (const PersonInView& one : in_view) {
    Limbs::Arms arms = m.limbs.arms_of(one.id);
    Person& person = m.heads[one.id].person;
    person.hands = std::move(arms.hands);
    person.gesture = std::move(arms.gesture);
  }
  std::erase_if(m.heads, [&](const auto& head) {
    const bool gone = frame.time - head.second.seen_time > m.settings.people.recall;
    if (gone) m.limbs.forget(head.first);
    return gone;
  });
  Observation seen = m.finish(frame.time, motion.moving, face);
  if (!m.station) return seen;
  // Who holds something to the camera may hide their face with it.
  if (seen.state != Presence::absent) seen.holding = m.station->step(frame);
  else m.station->forget();
  return seen;
}

void Observer::need(const EyeNeeds& needs) {
  Impl& m = *impl_;
  m.needs = needs;
  for (auto& [id, head] : m.heads) {
    if (!needs.expression) head.expression = {}, head.person.expression.reset();
    if (!needs.gestures) {
      m.limbs.forget(id);
      head.person.gesture.clear(), head.person.hands.clear();
    }
  }
}

Observation Observer::step_blind(double time) {
  impl_->last_time = std::max(impl_->last_time, time);
  return impl_->finish(time, false, false);
}

}  // namespace wellspring::kiosk
