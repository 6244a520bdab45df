// SPDX-License-Identifier: Apache-2.0
#include "kiosk/observe.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/load_error.h"
#include "base/log.h"
#include "kiosk/face/eyes.h"
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
                       bool moving, FacesSeen faces, bool coming) {
  const bool visitor = faces == FacesSeen::visitor;
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
  gather(state.face_evidence, faces != FacesSeen::none, step, settings.confirm_after);
  if (coming) state.motion_evidence = settings.wake_after;
  if (moving || coming) state.last_motion = time;
  if (visitor) state.last_face = time;

  // Sums of frame times carry rounding, which must not decide about a tick of the clock.
  constexpr double rounding = 1e-6;
  const bool woken = state.motion_evidence >= settings.wake_after - rounding;
  const bool confirmed = visitor && state.face_evidence >= settings.confirm_after - rounding;
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

constexpr double irises_every = 0.2;  // seconds between looks at the irises of one face
constexpr float least_eye_face = 60;  // pixels of a face's box; the irises of smaller ones blur

}  // namespace

struct Observer::Impl {
  ObserverSettings settings;
  std::unique_ptr<FaceFinder> finder;
  MotionWatch motion;
  People people;
  LivenessWatch liveness;
  PresenceState presence;
  Limbs limbs;
  std::optional<Station> station;
  EyeNeeds needs;
  struct Head {
    OneEuro bearing, distance, rotation;
    ExpressionState expression;
    Person person;
    double seen_time = 0, irises_time = -1e9;
    FaceSize size;
    bool is_face = false;  // a mesh has said so
    bool visitor = false;  // it is no picture, and counts
  };
  std::map<uint32_t, Head> heads;
  std::optional<IrisReader> irises;  // absent without the networks' weights
  bool read_irises = false;          // whether this frame reads some: one look a frame
  double last_time = -1e9;
  std::optional<ClassReader> classes;  // only while expressions are asked for
  bool read_classes = false;           // whether this frame reads them: one look a frame

  explicit Impl(const ObserverSettings& s)
      : settings(s),
        finder(make_face_finder(s.face)),
        motion(s.motion),
        people(*finder, s.people),
        liveness(s.liveness),
        limbs({s.mount, graphs_folder(s.face), s.bodies, s.gestures}) {
    if (s.station) station.emplace(*s.station, StationSettings{.mount = s.mount});
    settings.station.reset();  // the station has its own
    if (finder->reads_meshes()) try {
        irises.emplace(graphs_folder(s.face));
      } catch (const LoadError& error) {
        log::warn("no irises: {}", error.what());
      }
    if (!s.expression) return;
    if (!finder->reads_meshes()) {
      log::warn("no expressions: faces have no mesh");
      return;
    }
    try {
      classes.emplace(weights_folder(s.face));
      log::info("expressions are estimated: visitors must be told before they are seen");
    } catch (const LoadError& error) {
      log::warn("no expressions: {}", error.what());
    }
  }

  // Looks at eyes and mouth: how large the face is, and what they do.
  void look_at_eyes(Head& head, const GrayFrame& frame, const Followed& who, const HeadPose& pose) {
    Person& person = head.person;
    if (!who.face.mesh || who.face.box.width < least_eye_face) {
      person.gaze.reset(), person.lids.reset(), person.mouth.reset();
      return;
    }
    const bool due = frame.time - head.irises_time >= irises_every || frame.time < head.irises_time;
    if (!irises || read_irises || !due) return;
    read_irises = true;
    head.irises_time = frame.time;
    FaceMesh mesh = *who.face.mesh;
    irises->read({frame.pixels.data(), frame.width, frame.height}, mesh);
    person.gaze.reset(), person.lids = open_lids(mesh), person.mouth = open_mouth(mesh);
    const float focal = focal_length(settings.mount, frame.width, frame.height);
    add_look(head.size, *iris_width(mesh), focal, pose);
    if (const auto look = look_direction(mesh, pose, focal, frame.width, frame.height))
      person.gaze = seen_place(person.position, *look);
  }

  // Returns where a look from `eyes` in camera direction `look` meets the screen's plane.
  std::optional<vec2> seen_place(vec3 eyes, vec3 look) const {
    const vec3 towards =
        camera_to_screen(settings.mount, look) - camera_to_screen(settings.mount, vec3(0));
    if (!(towards.z < -0.1f)) return {};
    const vec2 place = vec2(eyes + towards * (eyes.z / -towards.z));
    constexpr float far_off = 5;  // metres: nothing is there
    return glm::length(place) < far_off ? std::optional(place) : std::nullopt;
  }

  void express(Head& head, const GrayFrame& frame, const Face& face) {
    FaceClasses now;
    const bool read =
        !read_classes && frame.time - head.expression.read_time >= settings.expressions.read_every;
    if (read)
      now = classes->read({frame.pixels.data(), frame.width, frame.height},
                          cut_of_marks(*face.marks));
    read_classes |= read;
    head.person.expression = step_expression(head.expression, settings.expressions, frame.time,
                                             *face.mesh, read ? &now : nullptr);
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
    const float focal = focal_length(mount, frame.width, frame.height);
    std::optional<HeadPose> pose;
    if (who.face.marks) pose = solve_head_pose(*who.face.marks, focal, frame.width, frame.height);
    vec3 raw = pose ? pose->position * size_of(head.size)
                    : face_in_camera(who.face.box, focal, frame.width, frame.height);
    vec3 bearing =
        step_one_euro(head.bearing, bearing_filter, frame.time, {raw.x / raw.z, raw.y / raw.z, 0});
    vec3 away = step_one_euro(head.distance, distance_filter, frame.time, {std::log(raw.z), 0, 0});
    vec3 camera = vec3(bearing.x, bearing.y, 1) * std::exp(away.x);
    head.person.id = who.id;
    head.person.position = camera_to_screen(mount, camera);
    const vec3 rotation =
        pose ? rotation_on_screen(mount, pose->rotation) : crude_rotation(head.person, who, camera);
    head.person.rotation = step_one_euro(head.rotation, rotation_filter, frame.time, rotation);
    head.is_face |= who.face.mesh || who.face.box.width < least_mesh_face;
    if (pose) look_at_eyes(head, frame, who, *pose);
    if (classes && who.face.mesh && needs.expression) express(head, frame, who.face);
    head.person.confidence = std::clamp(who.face.confidence, 0.f, 1.f);
    head.seen_time = frame.time;
    return head.person;
  }

  EyeParts parts() const {
    EyeParts out;
    out.faces = finder->finds_landmarks();
    if (settings.expression) out.expression = classes.has_value();
    if (out.faces == true) out.mesh = finder->reads_meshes();
    out.bodies = limbs.sees_bodies();
    out.hands = limbs.sees_hands();
    if (station) out.objects = true;
    return out;
  }

  Observation finish(double time, bool moving, FacesSeen faces) {
    Observation out;
    out.time = time;
    out.parts = parts();
    // Who turns away and stays is still there.
    if (presence.now == Presence::person && limbs.somebody_stays_near(time))
      faces = FacesSeen::visitor;
    out.state =
        step_presence(presence, settings.presence, time, moving, faces, limbs.somebody_comes());
    out.bodies = limbs.bodies(time);
    const double hold = settings.presence.hold_person;
    if (out.state == Presence::person)
      for (const auto& [id, head] :
           heads) {  // a person just lost stays where they were, less and less surely
        double age = time - head.seen_time;
        if (age < 0 || age > hold || !head.visitor) continue;
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
  if (frame.time < m.last_time) {
    for (const auto& head : m.heads) m.limbs.forget(head.first), m.liveness.forget(head.first);
    m.heads.clear();
  }
  m.last_time = frame.time;
  Motion motion = m.motion.step(frame);
  FacesSeen faces = FacesSeen::none;
  m.read_classes = false;
  m.read_irises = false;
  std::vector<PersonInView> in_view;
  for (const Followed& who : m.people.step(frame, motion)) {
    if (!who.visible) continue;
    const LivenessState& alive = m.liveness.step(frame, who.id, who.face.box);
    Impl::Head& head = m.heads[who.id];
    const Person& person = m.place(head, frame, who);
    head.person.liveness = liveness(alive);
    head.visitor = m.liveness.counts(alive) && (!m.finder->reads_meshes() || head.is_face);
    if (!head.visitor && alive.evidence >= 0) faces = std::max(faces, FacesSeen::unsure);
    if (!head.visitor) continue;
    faces = FacesSeen::visitor;
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
    if (gone) m.limbs.forget(head.first), m.liveness.forget(head.first);
    return gone;
  });
  Observation seen = m.finish(frame.time, motion.moving, faces);
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
  return impl_->finish(time, false, FacesSeen::none);
}

}  // namespace wellspring::kiosk
