// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "show/storyteller/audience.h"

namespace wellspring {
namespace {

View straight_view() {
  View view;  // at the origin, looking along -Z
  view.position = vec3(1, 2, 3);
  return view;
}

Observation person_at(vec3 position, uint32_t id = 1) {
  Observation observation;
  observation.state = Presence::person;
  Person person;
  person.id = id;
  person.position = position;
  observation.people.push_back(person);
  return observation;
}

TEST(Audience, TheScreenIsAWindow) {
  Person person;
  person.position = {0.2f, 0.1f, viewing_distance + 0.5f};
  Guest guest = place_person(person, straight_view(), 0);
  EXPECT_NEAR(guest.head.x, 1.2f, 1e-6);
  EXPECT_NEAR(guest.head.y, 2.1f, 1e-6);
  EXPECT_NEAR(guest.head.z, 3.5f, 1e-6);  // half a metre behind the camera, which looks along -Z
  EXPECT_TRUE(guest.kiosk);
}

TEST(Audience, NearestFirstOverAllCameras) {
  std::vector<Eye> eyes(2);
  eyes[0].seen = person_at({0.5f, 0, 2});
  eyes[1].seen = person_at({0, 0, 0.8f});
  eyes[0].received = eyes[1].received = 10;
  Audience audience = gather_audience(eyes, straight_view(), 10.5);
  ASSERT_EQ(audience.guests.size(), 2u);
  EXPECT_LT(glm::length(audience.guests[0].head - straight_view().position), 0.3f);
  EXPECT_NE(audience.guests[0].id, audience.guests[1].id);
  EXPECT_EQ(audience.state, Presence::person);
}

TEST(Audience, OldObservationsCountNoMore) {
  std::vector<Eye> eyes(1);
  eyes[0].seen = person_at({0, 0, 1});
  eyes[0].received = 10;
  EXPECT_EQ(gather_audience(eyes, straight_view(), 11).guests.size(), 1u);
  Audience later = gather_audience(eyes, straight_view(), 10 + observation_lifetime + 0.1);
  EXPECT_TRUE(later.guests.empty());
  EXPECT_EQ(later.state, Presence::absent);
}

TEST(Audience, MotionAloneBringsNobody) {
  std::vector<Eye> eyes(1);
  eyes[0].seen = person_at({0, 0, 1});
  eyes[0].seen.state = Presence::motion;
  eyes[0].received = 1;
  Audience audience = gather_audience(eyes, straight_view(), 1);
  EXPECT_EQ(audience.state, Presence::motion);
  EXPECT_TRUE(audience.guests.empty());
}

}  // namespace
}  // namespace wellspring
