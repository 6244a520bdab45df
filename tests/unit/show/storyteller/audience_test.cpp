// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <optional>
#include <set>

#include "show/storyteller/audience.h"

namespace wellspring::test {
namespace {

View straight_view() {
  View view;  // at the origin, looking along -Z
  view.position = vec3(1, 2, 3);
  return view;
}

Observation person_at(vec3 position, uint32_t id = 1) {
  Observation observation{.state = Presence::person};
  observation.people.push_back({.id = id, .position = position});
  return observation;
}

TEST(Audience, TheScreenIsAWindow) {
  Person person{.position = {0.2f, 0.1f, viewing_distance + 0.5f}};
  Guest guest = place_person(person, straight_view(), 1);
  EXPECT_NEAR(guest.head.x, 1.2f, 1e-6);
  EXPECT_NEAR(guest.head.y, 2.1f, 1e-6);
  EXPECT_NEAR(guest.head.z, 3.5f, 1e-6);  // half a metre behind the camera, which looks along -Z
  EXPECT_TRUE(guest.kiosk);
}

TEST(Audience, NearestFirstOverAllCameras) {
  std::vector<Eye> eyes(2);
  eyes[1].number = 2;
  eyes[0].seen = person_at({0.5f, 0, 2});
  eyes[1].seen = person_at({0, 0, 0.8f});
  eyes[0].received = eyes[1].received = 10;
  Audience audience = gather_audience(eyes, "", straight_view(), 10.5);
  ASSERT_EQ(audience.guests.size(), 2u);
  EXPECT_LT(glm::length(audience.guests[0].head - straight_view().position), 0.3f);
  EXPECT_NE(audience.guests[0].id, audience.guests[1].id);
  EXPECT_EQ(audience.state, Presence::person);
}

TEST(Audience, OldObservationsCountNoMore) {
  std::vector<Eye> eyes(1);
  eyes[0].seen = person_at({0, 0, 1});
  eyes[0].received = 10;
  EXPECT_EQ(gather_audience(eyes, "", straight_view(), 11).guests.size(), 1u);
  Audience later = gather_audience(eyes, "", straight_view(), 10 + observation_lifetime + 0.1);
  EXPECT_TRUE(later.guests.empty());
  EXPECT_EQ(later.state, Presence::absent);
}

TEST(Audience, WhoStandsAtAMarkIsNoGuest) {
  std::vector<Eye> eyes(1);
  eyes[0].seen = person_at({0, 0, 1});
  eyes[0].seen.calibration = CalibrationStep{CalibrationStep::What::far_mark, 2, 0.5f};
  eyes[0].received = 1;
  Audience audience = gather_audience(eyes, "", straight_view(), 1);
  EXPECT_EQ(audience.state, Presence::absent);
  EXPECT_TRUE(audience.guests.empty());
  EXPECT_EQ(audience.calibration, eyes[0].seen.calibration);
  EXPECT_FALSE(
      gather_audience(eyes, "", straight_view(), 1 + observation_lifetime + 0.1).calibration);
}

TEST(Audience, MotionAloneBringsNobody) {
  std::vector<Eye> eyes(1);
  eyes[0].seen = person_at({0, 0, 1});
  eyes[0].seen.state = Presence::motion;
  eyes[0].received = 1;
  Audience audience = gather_audience(eyes, "", straight_view(), 1);
  EXPECT_EQ(audience.state, Presence::motion);
  EXPECT_TRUE(audience.guests.empty());
}

// Two cameras of one kiosk.
struct TwoCameras : testing::Test {
  std::vector<Eye> eyes{2};
  TwoCameras() { eyes[1].number = 2; }
  Audience audience;
  double now = 10;
  void see(std::optional<vec3> left, std::optional<vec3> right) {
    eyes[0].seen = left ? person_at(*left, 4) : Observation{};
    eyes[1].seen = right ? person_at(*right, 9) : Observation{};
    eyes[0].received = eyes[1].received = now += 0.1;
    audience = gather_audience(eyes, "", straight_view(), now, audience);
  }
};

TEST_F(TwoCameras, OnePersonSeenTwiceIsOneGuest) {
  see(vec3(0, 0, 1), vec3(0.2f, 0.1f, 1.1f));
  ASSERT_EQ(audience.guests.size(), 1u);
  EXPECT_NEAR(audience.guests[0].head.x, straight_view().position.x + 0.1f, 1e-3f);
  EXPECT_NEAR(audience.nearest, 1.05f, 1e-3f);
  see(vec3(0, 0, 1), vec3(0.6f, 0, 1));
  EXPECT_EQ(audience.guests.size(), 1u) << "a guest stays one when measures part";
}

TEST_F(TwoCameras, AGuestKeepsItsNumberWhicheverCameraHasIt) {
  see(vec3(0, 0, 1), {});
  const uint64_t id = audience.guests.at(0).id;
  see(vec3(0, 0, 1), vec3(0.1f, 0, 1));
  EXPECT_EQ(audience.guests.at(0).id, id);
  see({}, vec3(0.3f, 0, 1));
  ASSERT_EQ(audience.guests.size(), 1u);
  EXPECT_EQ(audience.guests[0].id, id);
  now += 20;  // long gone: somebody new may have that camera's number
  see({}, vec3(0.3f, 0, 1));
  EXPECT_NE(audience.guests.at(0).id, id);
}

TEST_F(TwoCameras, TwoPeopleStayTwo) {
  see(vec3(-0.4f, 0, 1), vec3(0.4f, 0, 1));
  EXPECT_EQ(audience.guests.size(), 2u);
  // Both cameras see both, who stand close together.
  eyes[0].seen.people.push_back(person_at({-0.1f, 0, 1}, 5).people[0]);
  eyes[1].seen = person_at({-0.4f, 0, 1.05f}, 8);
  eyes[1].seen.people.push_back(person_at({-0.1f, 0, 1.05f}, 9).people[0]);
  eyes[0].received = eyes[1].received = now += 0.1;
  audience = gather_audience(eyes, "", straight_view(), now, Audience{});
  EXPECT_EQ(audience.guests.size(), 2u);
}

TEST_F(TwoCameras, WhoWasTakenForOneByMistakePartsAgain) {
  see(vec3(0, 0, 1), vec3(0.2f, 0, 1));
  ASSERT_EQ(audience.guests.size(), 1u);
  see(vec3(-0.5f, 0, 1), vec3(0.7f, 0, 1));
  ASSERT_EQ(audience.guests.size(), 2u);
  see({}, vec3(0.7f, 0, 1));
  EXPECT_EQ(audience.guests.size(), 1u);
}

TEST(Audience, GuestsOfAnyNumberOfCamerasAreKeptApart) {
  std::set<uint64_t> ids;
  const uint32_t cameras[] = {1, 2, 255, 256, 257, 511, 512, 0x1000000},
                 people[] = {0, 1, 0xffffff, 0x1000000, 0x1000001, 0xffffffff};
  for (uint32_t camera : cameras)
    for (uint32_t person : people) {
      const Guest guest = place_person(Person{.id = person}, straight_view(), camera);
      EXPECT_TRUE(ids.insert(guest.id).second) << "camera " << camera << ", person " << person;
      EXPECT_GT(guest.id, 0xffffffffu) << "below are visitors, and who is seen by no camera";
    }
}

TEST_F(TwoCameras, NumbersAreForgotten) {
  for (uint32_t i = 1; i < 3000; i++) {
    eyes[0].seen = person_at({0, 0, 1}, i);
    eyes[0].received = now += 0.5;
    audience = gather_audience(eyes, "", straight_view(), now, audience);
  }
  EXPECT_LT(audience.known.size(), 30u);
}

}  // namespace
}  // namespace wellspring::test
