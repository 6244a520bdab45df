// SPDX-License-Identifier: Apache-2.0
// Frusta of a screen that is a window, against geometry; how the eye follows a head.
#include "show/kiosk/kiosk.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/rng.h"
#include "show/storyteller/audience.h"

namespace wellspring::test {
namespace {

constexpr float tick = 1 / 30.0f;

struct Window : testing::Test {
  ScreenSize screen{1.06f, 0.6f};
  View rest = make_view(Scene(), dvec3(1, 1.6, 2), 0.4f, -0.1f, 0.9f, 1920, 1080);
  WindowEye eye;
  float distance() const { return rest_distance(screen, rest); }
  View now() const { return through_window(rest, screen, eye.place); }
  // A place of the screen's plane in the exhibit: metres from the screen's middle.
  vec3 on_screen(vec2 at) const {
    return rest.position + rest.forward * distance() + rest.right * at.x + rest.up * at.y;
  }
  void step(const std::vector<vec3>& heads, float dt = tick) {
    watch_heads(eye, heads, screen, rest, dt);
    move_eye(eye, dt);
  }
  void go(const std::vector<vec3>& heads, float seconds) {
    for (float t = 0; t < seconds; t += tick) step(heads);
  }
  // Pixels between where the two views show what lies that far behind the screen's middle.
  float shift(const View& a, const View& b, float depth) const {
    const vec3 place = on_screen({}) + rest.forward * depth;
    const Projected pa = project_point(a, place), pb = project_point(b, place);
    return glm::length(vec2(pa.x - pb.x, pa.y - pb.y));
  }
};

TEST_F(Window, AtRestIsTheViewpointsPicture) {
  EXPECT_EQ(now(), rest);
  // The screen's size is unknown.
  EXPECT_EQ(through_window(rest, ScreenSize(), {0.1f, 0, 0}), rest);
  EXPECT_EQ(place_of_head({0, 0, distance()}, screen, rest), vec3(0));
  EXPECT_EQ(rest_distance(ScreenSize(), rest), viewing_distance);
  go({}, 2);
  EXPECT_EQ(eye.place, vec3(0));
}

// Wherever the eye is, corners of the screen are corners of the picture, and the eye is the head.
TEST_F(Window, FrameStaysForEveryEye) {
  Rng rng(3);
  for (int i = 0; i < 300; i++) {
    screen.height = 0.3f + 1.5f * rng.uniform();
    screen.width = screen.height * 16 / 9;
    const vec3 place =
        distance() * vec3(rng.uniform() - 0.5f, rng.uniform() - 0.5f, 0.5f * rng.uniform() - 0.25f);
    const View view = through_window(rest, screen, place);
    for (float u : {-0.5f, 0.5f})
      for (float v : {-0.5f, 0.5f}) {
        const vec3 corner = on_screen({u * screen.width, v * screen.height});
        const Projected at = project_point(view, corner);
        EXPECT_NEAR(at.x, (0.5f + u) * 1920, 0.05f);
        EXPECT_NEAR(at.y, (0.5f - v) * 1080, 0.05f);
        const Ray ray = view_ray(view, (0.5f + u) * 1920, (0.5f - v) * 1080);
        const vec3 way = corner - view.position;
        EXPECT_LT(glm::length(ray.direction * glm::length(way) - way), 1e-4f);
      }
    EXPECT_EQ(view.forward, rest.forward);
  }
}

// Pictures of another shape cover the screen; what sticks out is cut off.
TEST_F(Window, PicturesCoverTheScreen) {
  EXPECT_FLOAT_EQ(picture_height(screen, rest), 0.6f);
  View square = rest;
  square.width = square.height;
  EXPECT_FLOAT_EQ(picture_height(screen, square), 1.06f);
  EXPECT_FLOAT_EQ(rest_distance(screen, square), 0.53f / rest.tan_half_fov);
}

TEST_F(Window, EyesBeyondReasonAreLimited) {
  const float nan = std::nanf("");
  const vec2 half = rest.tan_half_fov * vec2(16 / 9.0f, 1);
  for (vec3 head :
       {vec3(5, 0, 0.6f), vec3(-0.5f, 0.3f, 0.01f), vec3(0, -9, 1), vec3(0, 0, -1), vec3(0, 0, 40),
        vec3(1e9f, -1e9f, 1e9f), vec3(nan, 0, 1), vec3(0.53f, 0.3f, 0.25f)}) {
    const View view = through_window(rest, screen, place_of_head(head, screen, rest));
    EXPECT_TRUE(is_finite(view.position));
    EXPECT_LT(glm::length(view.position - rest.position), 0.5f);
    EXPECT_LE(std::abs(view.middle.x), 0.51f * half.x);
    EXPECT_LE(std::abs(view.middle.y), 0.51f * half.y);
    EXPECT_GT(view.tan_half_fov, 0.7f * rest.tan_half_fov);
    EXPECT_LT(view.tan_half_fov, 1.4f * rest.tan_half_fov);
    const Projected far = project_point(view, rest.position + 1000.0f * rest.forward);
    EXPECT_TRUE(far.x > 100 && far.x < 1820 && far.y > 100 && far.y < 980) << far.x << " " << far.y;
  }
}

// Screens hang with their middle at 1.4 m: from below more of the ceiling is seen, but a
// storyteller who stands in the picture at rest stays in it.
TEST_F(Window, ChildrenAndWheelchairsSeeTheStoryteller) {
  for (float eye_height : {1.0f, 1.15f, 1.75f, 1.95f})
    for (float away : {0.5f, 0.8f, 1.5f})
      for (float aside : {-0.4f, 0.0f, 0.4f}) {
        eye = {};
        go({vec3(aside, eye_height - 1.4f, away)}, 4);
        const View view = now();
        EXPECT_LT((view.position.y - rest.position.y) * (eye_height - 1.4f), 1) << eye_height;
        EXPECT_EQ(view.position.y > rest.position.y + 0.01f, eye_height > 1.6f);
        const vec3 face = rest.position + 2.5f * rest.forward + 0.1f * rest.up;
        const Projected at = project_point(view, face);
        EXPECT_TRUE(at.x > 400 && at.x < 1520 && at.y > 200 && at.y < 880)
            << at.x << " " << at.y << " from " << eye_height << " " << away << " " << aside;
      }
}

// Within reach the picture is seen from the head itself, so who looks at the head looks out of the
// picture at its viewer.
TEST_F(Window, WhoLooksAtTheGuestLooksOutOfThePicture) {
  for (vec3 head : {vec3(0.1f, 0.05f, 0.65f), vec3(-0.12f, -0.06f, 0.55f)}) {
    eye = {};
    go({head}, 5);
    Person person{.position = head};
    const Guest guest = place_person(person, rest, 1, distance());
    EXPECT_LT(glm::length(guest.head - now().position), 1e-3f);
  }
  // From afar the eye is in the head's direction, seen from the middle of the screen.
  eye = {};
  go({vec3(0.3f, -0.2f, 2)}, 5);
  Person person{.position = vec3(0.3f, -0.2f, 2)};
  const vec3 to_head = place_person(person, rest, 1, distance()).head - on_screen({}),
             to_eye = now().position - on_screen({});
  EXPECT_GT(dot(normalize(to_head), normalize(to_eye)), 1 - 1e-6f);
}

TEST_F(Window, JumpsOfTheHeadAreNoJumpsOfTheView) {
  Rng rng(9);
  vec3 head(0, 0, 0.7f), before(0), speed_before(0);
  for (int i = 0; i < 3000; i++) {
    if (i % 40 == 0) head = vec3(rng.uniform() - 0.5f, rng.uniform() - 0.5f, 0.4f + rng.uniform());
    step({head});
    const vec3 speed = (eye.place - before) / tick;
    EXPECT_LE(glm::length(speed), 0.51f);
    EXPECT_LE(glm::length(speed - speed_before), 0.3f) << i;  // 9 m/s^2
    before = eye.place, speed_before = speed;
  }
}

TEST_F(Window, ArrivesWithoutSwingingAndStandsStill) {
  const vec3 head(0.2f, 0.1f, 0.7f), wanted = place_of_head(head, screen, rest);
  float before = 0;
  for (int i = 0; i < 90; i++) {
    step({head});
    const float gone = dot(eye.place, normalize(wanted));
    EXPECT_GE(gone, before - 1e-6f);
    EXPECT_LE(gone, glm::length(wanted) + 1e-5f);
    before = gone;
  }
  EXPECT_EQ(eye.place, wanted);
  EXPECT_EQ(eye.speed, vec3(0));
}

// The same motion, however often it is computed.
TEST_F(Window, DoesNotDependOnTheRateOfTicks) {
  WindowEye slow, fast;
  slow.aim = fast.aim = {0.15f, -0.1f, 0.05f};
  for (int i = 0; i < 10; i++) {
    move_eye(slow, 0.05f);
    for (int k = 0; k < 10; k++) move_eye(fast, 0.005f);
    EXPECT_LT(glm::length(slow.place - fast.place), 0.01f);
  }
  move_eye(slow, 0);
  move_eye(slow, std::nanf(""));
  EXPECT_TRUE(is_finite(slow.place));
}

TEST_F(Window, TwoWatchersBringItBackSmoothly) {
  const vec3 one(0.25f, 0, 0.7f), other(-0.3f, 0.1f, 1);
  go({one}, 3);
  const vec3 followed = eye.place;
  EXPECT_GT(followed.x, 0.1f);
  vec3 before = followed;
  for (int i = 0; i < 120; i++) {
    step({one, other});
    EXPECT_LT(glm::length(eye.place - before), 0.51f * tick);
    before = eye.place;
  }
  EXPECT_EQ(now(), rest);
  go({one, vec3(0, 0, 4)}, 3);  // who stands far away does not watch
  EXPECT_GT(eye.place.x, 0.1f);
  go({vec3(0.5f, 0, 3)}, 4);
  EXPECT_EQ(now(), rest);
}

TEST_F(Window, HeadsLostForAMomentChangeNothing) {
  const vec3 one(0.25f, 0, 0.7f);
  go({one}, 3);
  const vec3 followed = eye.place;
  for (int i = 0; i < 20; i++) {
    go({}, 0.3f);
    EXPECT_EQ(eye.place, followed);
    go({one}, 0.3f);
    EXPECT_EQ(eye.place, followed);
  }
  go({}, 4);
  EXPECT_EQ(now(), rest);
  go({one}, 0.3f);  // nor does who is seen for a moment
  EXPECT_EQ(now(), rest);
}

// Noise of a standard deviation of 1 cm: what is 5 m behind the screen moves by less than 1.5
// pixels of 1080 rows from tick to tick and by less than 12 in 100 s, what is at the screen not at
// Noise has a standard deviation of 1 cm: things 5 m behind the screen move by less than 1.5 pixels
// of 1080 rows from tick to tick and by less than 12 in 100 s, things at the screen not at all.
// Noise below 1 cm moves nothing.
TEST_F(Window, NoiseOfACentimetreIsHardlySeen) {
  Rng rng(17);
  auto noise = [&] {  // standard deviation 1
    float sum = -6;
    for (int i = 0; i < 12; i++) sum += rng.uniform();
    return sum;
  };
  for (vec3 head : {vec3(0.1f, -0.05f, 0.65f), vec3(-0.3f, 0.1f, 1.5f)}) {
    eye = {};
    go({head}, 3);
    const View still = now();
    float most = 0, moved = 0;
    for (int i = 0; i < 3000; i++) {
      const View before = now();
      step({head + 0.01f * vec3(noise(), noise(), noise())});
      most = std::max(most, shift(still, now(), 5));
      moved = std::max(moved, shift(before, now(), 5));
      EXPECT_LT(shift(still, now(), 0), 0.5f);
    }
    EXPECT_LT(most, 12) << head.z;
    EXPECT_LT(moved, 1.5f) << head.z;
  }
  eye = {};
  go({vec3(0.1f, 0, 0.65f)}, 3);
  const View still = now();
  for (int i = 0; i < 500; i++) {  // at most 1 cm: nothing moves
    step({vec3(0.1f, 0, 0.65f) + 0.01f * normalize(vec3(noise(), noise(), noise()))});
    EXPECT_EQ(now(), still);
  }
}

}  // namespace
}  // namespace wellspring::test
