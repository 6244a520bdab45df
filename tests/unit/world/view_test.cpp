// SPDX-License-Identifier: Apache-2.0
#include "world/view.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/rng.h"

namespace wellspring::test {
namespace {

constexpr float degrees = pi / 180;

void expect_orthonormal(const View& view) {
  EXPECT_NEAR(length(view.right), 1, 1e-5f);
  EXPECT_NEAR(length(view.up), 1, 1e-5f);
  EXPECT_NEAR(length(view.forward), 1, 1e-5f);
  EXPECT_NEAR(dot(view.right, view.up), 0, 1e-5f);
  EXPECT_NEAR(dot(view.right, view.forward), 0, 1e-5f);
  EXPECT_NEAR(dot(cross(view.right, view.up), -view.forward), 1, 1e-5f);  // right-handed
}

TEST(View, YawAndPitchTurnAsSaid) {
  Scene scene;
  View ahead = make_view(scene, dvec3(0), 0, 0, 1, 64, 64);
  EXPECT_NEAR(ahead.forward.z, -1, 1e-6f);
  View left = make_view(scene, dvec3(0), pi / 2, 0, 1, 64, 64);
  EXPECT_NEAR(left.forward.x, -1, 1e-6f);  // positive turns left
  View up = make_view(scene, dvec3(0), 0, pi / 2, 1, 64, 64);
  EXPECT_NEAR(up.forward.y, 1, 1e-6f);
  for (const View& view : {ahead, left, up}) expect_orthonormal(view);
}

TEST(View, PositiveRollLeansToTheLeft) {
  Scene scene;
  Viewpoint at{.yaw = 0.7f, .pitch = -0.3f};
  View upright = make_view(scene, at, 64, 64);
  at.roll = 30 * degrees;
  View leans = make_view(scene, at, 64, 64);
  expect_orthonormal(leans);
  EXPECT_EQ(leans.forward, upright.forward);
  EXPECT_NEAR(dot(leans.up, -upright.right), 0.5f, 1e-5f);
  EXPECT_NEAR(dot(leans.right, upright.up), 0.5f, 1e-5f);
  at.roll = NAN;
  EXPECT_EQ(make_view(scene, at, 64, 64), upright);
}

TEST(View, RayAndProjectionAreInverse) {
  Scene scene;
  scene.origin = dvec3(100, 200, 300);
  Rng rng(7);
  for (float fov : {5 * degrees, 60 * degrees, 150 * degrees})
    for (int i = 0; i < 200; i++) {
      View view = make_view(scene, dvec3(101, 199, 305), 6 * rng.uniform(),
                            3 * rng.uniform() - 1.5f, fov, 640, 360);
      expect_orthonormal(view);
      float x = 640 * rng.uniform(), y = 360 * rng.uniform();
      Ray ray = view_ray(view, x, y);
      EXPECT_NEAR(length(ray.direction), 1, 1e-5f);
      EXPECT_EQ(ray.origin, vec3(1, -1, 5));
      float distance = 0.1f + 10 * rng.uniform();
      Projected p = project_point(view, ray.origin + ray.direction * distance);
      EXPECT_NEAR(p.x, x, 0.02f);
      EXPECT_NEAR(p.y, y, 0.02f);
      EXPECT_NEAR(p.depth, distance * dot(ray.direction, view.forward), 1e-4f);
    }
}

// A picture is a screen, known by its corners, that an eye looks through.
TEST(View, RaysThroughCornersMeetTheCornersOfTheScreen) {
  Rng rng(11);
  for (int i = 0; i < 500; i++) {
    View view = make_view(Scene(), dvec3(0), 6 * rng.uniform(), 2 * rng.uniform() - 1, 1,
                          64 + int(500 * rng.uniform()), 64 + int(500 * rng.uniform()));
    const vec3 centre = 4.0f * vec3(rng.uniform(), rng.uniform(), rng.uniform());
    const float height = 0.2f + 2 * rng.uniform(), aspect = float(view.width) / float(view.height),
                away = 0.3f + 2 * rng.uniform();
    const vec2 aside = 2.0f * vec2(rng.uniform(), rng.uniform()) - 1.0f;
    view.position = centre + view.right * aside.x + view.up * aside.y - view.forward * away;
    view.tan_half_fov = 0.5f * height / away;
    view.middle = -aside / away;
    for (float u : {0.0f, 0.5f, 1.0f})
      for (float v : {0.0f, 0.5f, 1.0f}) {
        const vec3 place =
            centre + view.right * (height * aspect * (u - 0.5f)) + view.up * (height * (0.5f - v));
        const float x = u * float(view.width), y = v * float(view.height);
        const Ray ray = view_ray(view, x, y);
        const float t = away / dot(ray.direction, view.forward);
        EXPECT_LT(length(ray.origin + t * ray.direction - place), 1e-4f * (1 + t));
        const Projected at = project_point(view, place);
        EXPECT_NEAR(at.x, x, 0.02f);
        EXPECT_NEAR(at.y, y, 0.02f);
        EXPECT_NEAR(at.depth, away, 1e-5f * (1 + away + length(centre)));
        const vec3 d = (place - view.position) / away;  // at a depth of 1
        EXPECT_NEAR(dot(d, right_of_middle(view)), (2 * u - 1) * aspect * view.tan_half_fov, 1e-4f);
        EXPECT_NEAR(dot(d, above_middle(view)), (1 - 2 * v) * view.tan_half_fov, 1e-4f);
      }
    const Projected axis = project_point(view, view.position + view.forward);
    EXPECT_NEAR(axis.x, axis_place(view).x, 1e-2f);
    EXPECT_NEAR(axis.y, axis_place(view).y, 1e-2f);
  }
}

TEST(View, FieldOfViewSpansTheHeight) {
  View view = make_view(Scene(), dvec3(0), 0, 0, 90 * degrees, 200, 100);
  EXPECT_NEAR(view_ray(view, 100, 0).direction.y, std::sqrt(0.5f), 1e-5f);
  EXPECT_NEAR(view_ray(view, 100, 100).direction.y, -std::sqrt(0.5f), 1e-5f);
  EXPECT_GT(view_ray(view, 150, 50).direction.x, 0);  // x grows to the right
}

TEST(View, TargetIsInTheMiddle) {
  Scene scene;
  scene.origin = dvec3(1e6, 0, 0);
  View view =
      make_view_towards(scene, dvec3(1e6, 1, 2), dvec3(1e6 + 3, 0.5, -4), vec3(0, 1, 0), 1, 80, 60);
  expect_orthonormal(view);
  Projected p = project_point(view, vec3(3, 0.5f, -4));
  EXPECT_NEAR(p.x, 40, 1e-3f);
  EXPECT_NEAR(p.y, 30, 1e-3f);
  EXPECT_GT(view.up.y, 0);
}

TEST(View, ParallelUpStillGivesAxes) {
  Scene scene;
  for (vec3 up : {vec3(0, 1, 0), vec3(0, -5, 0), vec3(0), vec3(std::nanf(""), 0, 0)}) {
    expect_orthonormal(make_view_towards(scene, dvec3(0), dvec3(0, 3, 0), up, 1, 8, 8));
    expect_orthonormal(make_view_towards(scene, dvec3(0), dvec3(0, -3, 0), up, 1, 8, 8));
  }
  expect_orthonormal(make_view_towards(scene, dvec3(0), dvec3(0, 0, -2), vec3(0, 0, 1), 1, 8, 8));
  expect_orthonormal(make_view_towards(scene, dvec3(1), dvec3(1), vec3(0, 1, 0), 1, 8, 8));
}

TEST(View, BadNumbersGiveAUsableView) {
  double nan = std::nan("");
  View view = make_view(Scene(), dvec3(nan, 0, 0), float(nan), float(nan), float(nan), 0, -3);
  expect_orthonormal(view);
  EXPECT_TRUE(is_finite(view.position));
  EXPECT_EQ(view.width, 1);
  EXPECT_EQ(view.height, 1);
  EXPECT_TRUE(is_finite(view_ray(view, 0, 0).direction));
  View wide = make_view(Scene(), dvec3(0), 0, 0, 100, 8, 8);
  EXPECT_GT(wide.tan_half_fov, 0);
  EXPECT_TRUE(std::isfinite(wide.tan_half_fov));
}

}  // namespace
}  // namespace wellspring::test
