// SPDX-License-Identifier: Apache-2.0
#include "show/storyteller/audience.h"

#include <algorithm>

namespace wellspring {

Guest place_person(const Person& person, const View& kiosk_view, uint32_t eye_index) {
  Guest guest;
  // Ids of different cameras are kept apart in the upper bits.
  guest.id = (eye_index + 1) << 24 | (person.id & 0xffffffu);
  guest.kiosk = true;
  guest.rotation = person.rotation;
  guest.gesture = person.gesture;
  if (const auto& seen = person.expression)
    guest.expression = Emotions{
        {seen->joy, seen->sadness, seen->anger, seen->fear, seen->disgust, seen->surprise}};
  float behind = std::clamp(person.position.z - viewing_distance, -0.4f, 20.0f);
  guest.head = kiosk_view.position + kiosk_view.right * person.position.x +
               kiosk_view.up * person.position.y - kiosk_view.forward * behind;
  return guest;
}

Audience gather_audience(const std::vector<Eye>& eyes, const View& kiosk_view, double now) {
  Audience audience;
  for (size_t i = 0; i < eyes.size(); i++) {
    const Eye& eye = eyes[i];
    if (now - eye.received > observation_lifetime) continue;
    audience.state = std::max(audience.state, eye.seen.state);
    if (eye.seen.state != Presence::person) continue;
    for (const Person& person : eye.seen.people)
      audience.guests.push_back(place_person(person, kiosk_view, uint32_t(i)));
  }
  auto distance = [&](const Guest& guest) { return glm::length(guest.head - kiosk_view.position); };
  std::stable_sort(audience.guests.begin(), audience.guests.end(),
                   [&](const Guest& a, const Guest& b) { return distance(a) < distance(b); });
  return audience;
}

}  // namespace wellspring
