// SPDX-License-Identifier: Apache-2.0
// Places, heights and postures of bodies from their points.
#include "kiosk/body/body_place.h"

#include <gtest/gtest.h>

#include "unit/kiosk/body/made_body.h"

namespace wellspring::test {
namespace {

const Mount level;

BodyView view_of(const Mount& mount) {
  return {focal_length(mount, made_width, made_height), made_width, made_height};
}

BodyMeasure measured(const MadeBody& body, const KnownDepth& known = {},
                     const Mount& mount = level) {
  const auto found = measure_body(marks_of(body, mount), view_of(mount), mount, known);
  EXPECT_TRUE(found);
  return found.value_or(BodyMeasure{});
}

TEST(BodyPlace, AnAdultIsPlacedWithoutAFace) {
  for (float z : {2.f, 4.f, 6.f})
    for (float turned : {0.f, 0.8f, 1.5f}) {
      MadeBody body;
      body.feet = {0.4f, -1.2f, z}, body.turned = turned;
      const vec3 place = camera_to_screen(level, measured(body).shoulders);
      SCOPED_TRACE(testing::Message() << z << " m, turned by " << turned);
      EXPECT_NEAR(place.z, z, 0.06f * z);
      EXPECT_NEAR(place.x, 0.4f, 0.1f);
      EXPECT_NEAR(place.y, body.feet.y + shoulder_share * body.height, 0.1f);
    }
}

TEST(BodyPlace, ACameraThatLooksDownSeesTheSamePlace) {
  Mount mount;
  mount.pitch = -0.25f, mount.offset = {0, 0.4f, 0};
  MadeBody body;
  body.feet = {0, -1.3f, 5};
  const vec3 place = camera_to_screen(mount, measured(body, {}, mount).shoulders);
  EXPECT_NEAR(place.z, 5, 0.5f);
  EXPECT_NEAR(place.y, body.feet.y + shoulder_share * body.height, 0.15f);
}

TEST(BodyPlace, AFaceTellsHowFarAndHowTallSomebodyIs) {
  for (float height : {1.05f, 1.35f, 1.85f}) {
    MadeBody body;
    body.feet = {0, -1.1f, 3.5f}, body.height = height;
    const BodyMeasure found = measured(body, {.face = 3.5f, .floor = {}});
    EXPECT_TRUE(found.sized);
    EXPECT_NEAR(found.height, height, 0.05f);
    ASSERT_TRUE(found.ankles);
    EXPECT_NEAR(*found.ankles, -1.1f + ankle_share * height, 0.05f);
    // Without it an adult is assumed, and no height is told.
    EXPECT_EQ(measured(body).height, 0);
  }
}

TEST(BodyPlace, TheFloorTellsAChildFromAnAdultFarAway) {
  MadeBody child;
  child.feet = {0.5f, -1.2f, 5}, child.height = 1.1f;
  const BodyMeasure found =
      measured(child, {.face = {}, .floor = -1.2f + ankle_share * child.height});
  EXPECT_TRUE(found.sized);
  EXPECT_NEAR(camera_to_screen(level, found.shoulders).z, 5, 0.3f);
  EXPECT_NEAR(found.height, 1.1f, 0.1f);
}

TEST(BodyPlace, HeightIsKnownFromWhatIsSeen) {
  MadeBody body;
  body.feet = {0, -1.2f, 2.2f}, body.cut_below = 470;
  const BodyMeasure found = measured(body, {.face = 2.2f, .floor = {}});
  EXPECT_FALSE(found.ankles);
  EXPECT_NEAR(found.height, body.height, 0.1f);
}

TEST(BodyPlace, WhoSitsIsTold) {
  MadeBody body;
  body.feet = {0, -1.2f, 3.5f};
  EXPECT_EQ(measured(body).seated, std::optional(false));
  body.seated = true;
  const BodyMeasure found = measured(body, {.face = 3.5f, .floor = {}});
  EXPECT_EQ(found.seated, std::optional(true));
  EXPECT_NEAR(found.height, body.height, 0.12f);
  EXPECT_FALSE(found.ankles);  // feet on a rest tell no floor
  // Without hips and knees nobody can say.
  body.cut_below = 300;
  const auto unknown = measure_body(marks_of(body), view_of(level), level);
  ASSERT_TRUE(unknown);
  EXPECT_FALSE(unknown->seated);
}

TEST(BodyPlace, ARaisedHandIsAboveTheShoulders) {
  MadeBody body;
  EXPECT_FALSE(measured(body).raised_hand);
  body.raised = true;
  EXPECT_TRUE(measured(body).raised_hand);
  BodyMarks marks = marks_of(body);
  marks.at(BodyPoint::right_wrist).score = 0.1f;
  EXPECT_FALSE(measure_body(marks, view_of(level), level)->raised_hand);
}

TEST(BodyPlace, WithoutShouldersNothingIsMeasured) {
  BodyMarks marks = marks_of({});
  marks.at(BodyPoint::left_shoulder).score = marks.at(BodyPoint::right_shoulder).score = 0;
  EXPECT_FALSE(measure_body(marks, view_of(level), level));
  EXPECT_FALSE(measure_body(BodyMarks{}, view_of(level), level));
  // One shoulder and the hips are enough.
  marks = marks_of({});
  marks.at(BodyPoint::left_shoulder).score = 0;
  EXPECT_TRUE(measure_body(marks, view_of(level), level));
}

TEST(BodyPlace, AFaceBelongsToTheBodyWhoseHeadIsInIt) {
  const BodyMarks marks = marks_of({});
  const Box face = face_of(marks, 4);
  EXPECT_TRUE(has_face(marks, face));
  EXPECT_FALSE(has_face(marks, {face.x + 3 * face.width, face.y, face.width, face.height}));
}

}  // namespace
}  // namespace wellspring::test
