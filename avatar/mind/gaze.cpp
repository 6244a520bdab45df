// SPDX-License-Identifier: Apache-2.0
#include "avatar/mind/gaze.h"

#include <algorithm>

#include "avatar/body/body.h"

namespace wellspring::avatar {
namespace {

constexpr double same_person_seconds =
    1.5;  // a new number where another one was lost this short ago is the same person
constexpr double no_second_greeting = 20;  // nobody is greeted twice within this time at one place
// whoever comes this soon after a greeting was greeted with it
constexpr double group_seconds = 1.5;
constexpr double motion_hold = 2.5;  // noticing goes on for so long after the last motion
constexpr float same_place = 0.7f;   // metres
constexpr size_t most_people = 32;

using Person = BehaviourState::Person;

void see_people(BehaviourState& state, const StorytellerInput& input, double now) {
  std::vector<const Guest*> unknown;
  std::vector<uint8_t> was_here;
  for (Person& person : state.people) {
    was_here.push_back(person.here);
    person.here = false;
  }
  auto see = [&](Person& person, const Guest& guest, bool before) {
    // Flashes of a detector do not add up to a person.
    if (!person.greeted && !before && now - person.last_seen > 0.5) person.first_seen = now;
    person.id = guest.id;
    person.head = guest.head;
    person.rotation = guest.rotation;
    person.last_seen = now;
    person.here = true;
  };
  for (const Guest& guest : input.guests) {
    if (!guest.kiosk || !is_finite(guest.head)) continue;
    size_t i = 0;
    while (i < state.people.size() && (state.people[i].here || state.people[i].id != guest.id)) i++;
    if (i < state.people.size()) see(state.people[i], guest, was_here[i]);
    else unknown.push_back(&guest);
  }
  for (const Guest* guest : unknown) {
    int nearest = -1;
    float least = same_place;
    for (size_t i = 0; i < was_here.size(); i++) {
      const Person& person = state.people[i];
      bool recent = now - person.last_seen < same_person_seconds || was_here[i] ||
                    (person.greeted && now - person.greeted_at < no_second_greeting);
      float distance = glm::length(person.head - guest->head);
      if (!person.here && recent && distance < least) least = distance, nearest = int(i);
    }
    if (nearest >= 0) {
      see(state.people[size_t(nearest)], *guest, was_here[size_t(nearest)]);
    } else if (state.people.size() < most_people) {
      Person person;
      person.first_seen = now;
      see(state.people.emplace_back(person), *guest, true);
    }
  }
  std::erase_if(state.people, [&](const Person& person) {
    return !person.here && now - person.last_seen > (person.greeted ? no_second_greeting : 1.0);
  });
}

}  // namespace

const char* to_string(Mood mood) {
  switch (mood) {
    case Mood::idle: return "idle";
    case Mood::noticing: return "noticing";
    case Mood::greeting: return "greeting";
    case Mood::attending: return "attending";
    case Mood::telling: return "telling";
    case Mood::farewell: return "farewell";
  }
  return "idle";
}

void decide(BehaviourState& state, const StorytellerInput& input, double now,
            StorytellerEvents& events) {
  events = {};
  if (input.visit != state.visit) {
    state.visit = input.visit;
    state.people.clear();
    state.company = false;
    state.last_greeting = -1e30;
  }
  see_people(state, input, now);
  bool anyone = false;
  for (const Person& person : state.people) anyone = anyone || person.here;
  if (anyone) state.last_company = now;
  if (input.kiosk_motion) state.last_motion = now;
  auto become = [&](Mood mood) {
    if (state.mood == mood) return;
    state.mood = mood;
    state.since = now;
  };

  for (Person& person : state.people) {
    if (!person.here || person.greeted || now - person.first_seen < confirm_seconds) continue;
    person.greeted = true;
    person.greeted_at = now;
    state.company = true;
    if (input.met || now - state.last_greeting < group_seconds) continue;
    state.last_greeting = now;
    state.addressed = person.id;
    events.greeted = true;
    events.guest = person.id;
    state.mood = Mood::greeting;
    state.since = now;
  }
  const bool lost = state.company && !anyone && now - state.last_company >= lost_seconds;
  if (input.parting || (lost && !input.staying)) {
    events.farewelled = true;
    events.guest = state.addressed;
    state.company = false;
    state.people.clear();
    become(Mood::farewell);
  }
  bool greeting = state.mood == Mood::greeting && now - state.since < greeting_seconds;
  bool parting =
      state.mood == Mood::farewell && now - state.since < farewell_seconds && !input.staying;
  if (greeting || parting) return;
  bool stirred =
      anyone || now - state.last_motion < motion_hold || (!state.people.empty() && !state.company);
  if (input.telling) become(Mood::telling);
  else if (state.company) become(Mood::attending);
  else if (stirred) become(Mood::noticing);
  else become(Mood::idle);
}

namespace {

constexpr float nine_tenths =
    3.89f;  // times 1 / rate: the time of nine tenths of a critically damped step
constexpr float eye_rate = nine_tenths / eye_seconds, head_rate = nine_tenths / head_seconds,
                calm_head_rate = 3.5f, torso_rate = nine_tenths / torso_seconds;
constexpr float eye_reach_yaw = 22_deg,
                eye_reach_pitch = 15_deg;  // beyond these the head must come along
constexpr float head_reach = 55_deg, torso_reach = 18_deg;
constexpr float torso_showing = 30_deg;  // the chest's reach while the feet stay with a listener

float nearest_turn(float angle, float to) {
  return angle + 2 * pi * std::round((to - angle) / (2 * pi));
}

// Chooses the guest to look at: kiosk guests before remote ones, the nearest first, the present one
// kept unless another is clearly nearer. nullptr: nobody.
const Guest* choose_guest(const GazeState& state, std::span<const Guest> guests, vec3 from,
                          float radius) {
  const Guest* best = nullptr;
  float least = 1e30f;
  for (const Guest& guest : guests) {
    float distance = glm::length(guest.head - from);
    bool kept = state.at_guest && state.guest == guest.id;
    if (!guest.kiosk && distance > radius + (kept ? 0.5f : 0)) continue;
    float rank = distance - (kept ? 0.3f : 0) + (guest.kiosk ? 0 : 1e6f);
    if (rank < least) least = rank, best = &guest;
  }
  return best;
}

void choose_target(GazeState& state, const BehaviourState& behaviour, const GazeInput& input,
                   vec3 from, Rng& rng, double now) {
  float heading = input.heading;
  bool motion = input.kiosk_motion, humanlike = input.humanlike;
  const float radius = behaviour.mood == Mood::telling ? listener_radius : remote_radius;
  const Guest* guest = choose_guest(state, input.guests, from, radius);
  if (guest && guest->kiosk) {
    state.kiosk_known = true;
    state.kiosk_place = guest->head;
  }
  // A kiosk's guest who is out of sight for a moment is still there.
  const bool unseen = behaviour.company && state.kiosk_known;
  state.listener = guest    ? std::optional(guest->head)
                   : unseen ? std::optional(state.kiosk_place)
                            : std::nullopt;
  if (input.look && is_finite(*input.look) && behaviour.mood != Mood::farewell) {
    state.at_guest = false;
    state.guest = 0;
    state.target = *input.look;
    return;
  }
  bool waits = behaviour.mood == Mood::farewell || behaviour.company || motion ||
               behaviour.mood == Mood::greeting;
  if (!(guest && guest->kiosk) && waits && (!guest || behaviour.mood != Mood::telling)) {
    state.at_guest = false;
    state.guest = 0;
    state.target = state.kiosk_known ? state.kiosk_place : vec3(0, from.y, 1.5f);
    return;
  }
  if (guest && !guest->kiosk && humanlike && now >= state.glance_until) {
    // A long look is followed by a short rest for both.
    state.glancing_away = state.at_guest && !state.glancing_away;
    state.glance_until = now + (state.glancing_away ? 1.2 + 1.5 * double(rng.uniform())
                                                    : 8 + 6 * double(rng.uniform()));
    if (state.glancing_away) state.wander_until = 0;
  }
  if (guest && (guest->kiosk || !humanlike || !state.glancing_away)) {
    state.at_guest = true;
    state.guest = guest->id;
    state.target = guest->head;
    return;
  }
  if (!guest) state.glance_until = 0, state.glancing_away = false;
  state.at_guest = false;
  state.guest = 0;
  if (!humanlike) {
    state.wander = {0, -2_deg, 4};
  } else if (now >= state.wander_until) {
    float wide = rng.uniform() < 0.2f ? 40_deg : 18_deg;
    float yaw = (rng.uniform() + rng.uniform() - 1) * wide;
    state.wander = {yaw, -8_deg + 11_deg * rng.uniform(), 2.5f + 4 * rng.uniform()};
    state.wander_until = now + 1.5 + 3.5 * double(rng.uniform());
  }
  float yaw = heading + state.wander.x, pitch = state.wander.y;
  state.target = from + state.wander.z * vec3(std::sin(yaw) * std::cos(pitch), std::sin(pitch),
                                              std::cos(yaw) * std::cos(pitch));
}

float yaw_of(vec3 way, float otherwise) {
  return glm::length(vec2(way.x, way.z)) > 1e-3f ? std::atan2(way.x, way.z) : otherwise;
}

}  // namespace

float way_round(float turn, float before) {
  const float most = before > 150_deg ? 190_deg : before < -150_deg ? 150_deg : 170_deg;
  return most - (most - turn - 2 * pi * std::floor((most - turn) / (2 * pi)));
}

vec3 eyes_origin(const Rig& rig, float heading) {
  vec3 axis = rig.character->joints[size_t(rig.root)].center;
  axis.y = 0;
  return axis + glm::angleAxis(heading, vec3(0, 1, 0)) * (rig.eyes_center - axis);
}

vec3 gaze_point(const GazeState& state, const Rig& rig, float heading) {
  float yaw = state.yaw.value + state.saccade.x, pitch = state.pitch.value + state.saccade.y;
  float distance = 1 / std::clamp(state.nearness.value, 0.01f, 4.0f);
  return eyes_origin(rig, heading) + distance * vec3(std::sin(yaw) * std::cos(pitch),
                                                     std::sin(pitch),
                                                     std::cos(yaw) * std::cos(pitch));
}

bool tick_gaze(GazeState& state, const Rig& rig, const BehaviourState& behaviour,
               const GazeInput& input, Rng& rng, double now, float dt) {
  float heading = input.heading;
  vec3 from = eyes_origin(rig, heading);
  vec3 before = state.target;
  choose_target(state, behaviour, input, from, rng, now);
  vec3 way = state.target - from;
  float distance = std::max(glm::length(way), 0.25f);
  float flat = glm::length(vec2(way.x, way.z));
  float pitch = std::atan2(way.y, std::max(flat, 1e-3f));

  if (!input.humanlike || !input.saccades) {
    state.saccade = vec2(0);
  } else if (now >= state.next_saccade) {
    float reach = state.at_guest ? 0.5_deg : 1.2_deg;
    state.saccade = reach * (2.0f * vec2(rng.uniform(), rng.uniform()) - 1.0f);
    state.next_saccade = now + 0.35 + 1.4 * double(rng.uniform());
  }
  // Head and chest take their shares of the turn.
  const float turn = way_round(yaw_of(way, heading) - heading, state.turn);
  state.turn = turn;
  bool eyes = rig.eyes_move;
  const float chest = input.look && state.listener ? torso_showing : torso_reach;
  float torso = std::clamp(0.25f * turn, -chest, chest);
  float head = eyes ? 0.85f * std::copysign(std::max(std::abs(turn) - 3_deg, 0.0f), turn) : turn;
  if (eyes) head = std::clamp(head, turn - eye_reach_yaw, turn + eye_reach_yaw);
  if (state.listener) {
    const float to = way_round(yaw_of(*state.listener - from, heading) - heading);
    head = std::clamp(head, to - most_away, to + most_away);
  }
  head = std::clamp(head, torso - head_reach, torso + head_reach);
  // The eyes stop at the ends of their sockets, on the way that the head goes.
  const float yaw = heading + std::clamp(turn, head - eye_limit_yaw, head + eye_limit_yaw);
  float nod =
      eyes ? std::clamp(0.65f * pitch, pitch - eye_reach_pitch, pitch + eye_reach_pitch) : pitch;
  nod = std::clamp(nod, -32_deg, 28_deg);

  bool jump = state.begun && glm::length(state.target - before) > 0.35f * distance;
  if (!state.begun) {
    state.yaw = {yaw, 0};
    state.pitch = {pitch, 0};
    state.nearness = {1 / distance, 0};
    state.head_yaw = {heading + head, 0};
    state.head_pitch = {nod, 0};
    state.torso_yaw = {torso, 0};
    state.begun = true;
  }
  state.yaw.value = nearest_turn(state.yaw.value, heading);
  state.head_yaw.value = nearest_turn(state.head_yaw.value, heading);
  settle(state.yaw, yaw, eye_rate, dt);
  settle(state.pitch, pitch, eye_rate, dt);
  settle(state.nearness, 1 / distance, eye_rate, dt);
  bool meant = state.at_guest || input.look || behaviour.mood != Mood::idle;
  float rate = meant ? head_rate : calm_head_rate;
  settle(state.head_yaw, heading + head, rate, dt);
  settle(state.head_pitch, nod, rate, dt);
  settle(state.torso_yaw, torso, torso_rate, dt);
  return jump;
}

}  // namespace wellspring::avatar
