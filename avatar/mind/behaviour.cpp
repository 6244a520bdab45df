// SPDX-License-Identifier: Apache-2.0
#include "avatar/mind/behaviour.h"

#include <algorithm>

namespace wellspring::avatar {
namespace {

constexpr double same_person_seconds =
    1.5;  // a new number at the place of one lost this short is the same person
constexpr double no_second_greeting =
    20;                                // nor is anybody greeted twice within this time at one place
constexpr double group_seconds = 1.5;  // who comes this soon after a greeting was greeted with it
constexpr double motion_hold = 2.5;    // keeps noticing after the last motion
constexpr float same_place = 0.7f;     // metres
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

}  // namespace wellspring::avatar
