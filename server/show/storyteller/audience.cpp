// SPDX-License-Identifier: Apache-2.0
#include "show/storyteller/audience.h"

#include <algorithm>
#include <limits>

namespace wellspring::show {

Guest place_person(const Person& person, const View& kiosk_view, uint32_t eye, float away) {
  Guest guest;
  // Ids of different cameras are kept apart in the upper bits, those of visitors are below them.
  guest.id = uint64_t(eye) << 32 | person.id;
  guest.kiosk = true;
  guest.rotation = person.rotation;
  guest.gesture = person.gesture;
  if (const auto& seen = person.expression)
    guest.expression = Emotions{
        {seen->joy, seen->sadness, seen->anger, seen->fear, seen->disgust, seen->surprise}};
  float behind = std::clamp(person.position.z, 0.2f, 20.0f) - away;
  guest.head = kiosk_view.position + kiosk_view.right * person.position.x +
               kiosk_view.up * person.position.y - kiosk_view.forward * behind;
  return guest;
}

namespace {

constexpr float same_place = 0.4f;     // metres between two cameras' measures of one head
constexpr float other_place = 1;       // likewise, from which they were taken for one by mistake
constexpr double remembered_for = 10;  // seconds that a number is kept for who is out of sight

struct SeenPerson {
  Guest guest;
  float confidence = 0;
  size_t eye = 0;
  size_t known = 0;  // index into Audience::known
};

KnownPerson& find_known(std::vector<KnownPerson>& known, uint64_t person, double now) {
  for (KnownPerson& one : known)
    if (one.person == person) return one;
  known.push_back({person, person, now, now});
  return known.back();
}

// Pairs of cameras' people that are one, nearest first; of one camera nobody is two.
void join_people(const std::vector<SeenPerson>& seen, std::vector<KnownPerson>& known) {
  struct Pair {
    float away;
    size_t a, b;
  };
  std::vector<Pair> pairs;
  for (size_t a = 0; a < seen.size(); a++)
    for (size_t b = a + 1; b < seen.size(); b++) {
      float away = glm::length(seen[a].guest.head - seen[b].guest.head);
      if (seen[a].eye == seen[b].eye) continue;
      if (away < same_place) pairs.push_back({away, a, b});
      KnownPerson &one = known[seen[a].known], &other = known[seen[b].known];
      if (away > other_place && one.guest == other.guest) {
        KnownPerson& parted = one.guest == one.person ? other : one;
        parted.guest = parted.person;
      }
    }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const Pair& a, const Pair& b) { return a.away < b.away; });
  auto has_one_of = [&](uint64_t guest, size_t eye) {
    return std::any_of(seen.begin(), seen.end(), [&](const SeenPerson& other) {
      return other.eye == eye && known[other.known].guest == guest;
    });
  };
  for (const Pair& pair : pairs) {
    KnownPerson &a = known[seen[pair.a].known], &b = known[seen[pair.b].known];
    if (a.guest == b.guest) continue;
    KnownPerson& first = a.since <= b.since ? a : b;
    KnownPerson& second = &first == &a ? b : a;
    if (has_one_of(first.guest, seen[&second == &a ? pair.a : pair.b].eye)) continue;
    second.guest = first.guest;
  }
}

// Places by how sure cameras are of them; the rest is as the surest has it.
void add_guest(std::vector<Guest>& guests, std::vector<float>& weights, const SeenPerson& one,
               uint64_t id) {
  const float weight = std::max(one.confidence, 1e-3f);
  for (size_t i = 0; i < guests.size(); i++) {
    Guest& guest = guests[i];
    if (guest.id != id) continue;
    guest.head += (one.guest.head - guest.head) * (weight / (weights[i] + weight));
    weights[i] += weight;
    if (!guest.expression) guest.expression = one.guest.expression;
    if (guest.gesture.empty()) guest.gesture = one.guest.gesture;
    return;
  }
  guests.push_back(one.guest);
  guests.back().id = id;
  weights.push_back(weight);
}

}  // namespace

Audience gather_audience(const std::vector<Eye>& eyes, const std::string& kiosk,
                         const View& kiosk_view, double now, const Audience& before, float away) {
  Audience audience;
  audience.known = before.known;
  std::erase_if(audience.known,
                [&](const KnownPerson& one) { return now - one.seen > remembered_for; });
  std::vector<SeenPerson> seen;
  float pointing_from = std::numeric_limits<float>::max();  // metres of who points
  for (size_t i = 0; i < eyes.size(); i++) {
    const Eye& eye = eyes[i];
    if (eye.kiosk != kiosk || now - eye.received > observation_lifetime) continue;
    if (eye.seen.calibration) {
      audience.calibration = eye.seen.calibration;
      continue;
    }
    audience.state = std::max(audience.state, eye.seen.state);
    // A camera that knows the object itself is believed before one that knows its class.
    if (eye.seen.holding && (!audience.holding || audience.holding->id.empty()))
      audience.holding = eye.seen.holding;
    if (eye.seen.state != Presence::person) continue;
    for (const Person& person : eye.seen.people) {
      Guest guest = place_person(person, kiosk_view, eye.number, away);
      KnownPerson& known = find_known(audience.known, guest.id, now);
      known.seen = now;
      for (const Hand& hand : person.hands) {
        const float far = glm::length(person.position);
        if (!hand.points_at || far >= pointing_from) continue;
        audience.points_at = hand.points_at;
        pointing_from = far;
      }
      seen.push_back({guest, person.confidence, i, size_t(&known - audience.known.data())});
    }
  }
  join_people(seen, audience.known);
  std::stable_sort(seen.begin(), seen.end(), [](const SeenPerson& a, const SeenPerson& b) {
    return a.confidence > b.confidence;
  });
  std::vector<float> weights;
  for (const SeenPerson& one : seen)
    add_guest(audience.guests, weights, one, audience.known[one.known].guest);
  auto distance = [&](const Guest& guest) { return glm::length(guest.head - kiosk_view.position); };
  std::stable_sort(audience.guests.begin(), audience.guests.end(),
                   [&](const Guest& a, const Guest& b) { return distance(a) < distance(b); });
  if (!audience.guests.empty()) {
    const vec3 first = audience.guests.front().head - kiosk_view.position;
    audience.nearest = std::max(away - dot(first, kiosk_view.forward), 0.0f);
    audience.aside = dot(first, kiosk_view.right);
  }
  return audience;
}

}  // namespace wellspring::show
