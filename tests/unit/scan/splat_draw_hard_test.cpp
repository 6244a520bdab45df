// SPDX-License-Identifier: Apache-2.0
// Sets and views that are hard to draw.
#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include "splat_draw_reference.h"

namespace wellspring::test {
using namespace wellspring::scan;

namespace {

constexpr quat no_turn(1, 0, 0, 0);
constexpr float infinite = std::numeric_limits<float>::infinity();
constexpr float no_number = std::numeric_limits<float>::quiet_NaN();

void expect_sound(const SplatPlanes& picture) {
  for (size_t i = 0; i < picture.light.size(); i++) {
    ASSERT_TRUE(is_finite(picture.light[i])) << i;
    ASSERT_TRUE(picture.clear[i] >= 0 && picture.clear[i] <= 1) << i;
    ASSERT_GT(picture.depth[i], 0) << i;
  }
}

// Draws in both orders; what is returned is in the order of middles.
SplatPlanes draw_both(const SplatSet& set, const ScanCamera& view) {
  SplatDrawing settings;
  settings.by_pixel = true;
  expect_sound(draw_set(set, view, settings));
  settings.by_pixel = false;
  const SplatPlanes picture = draw_set(set, view, settings);
  expect_sound(picture);
  return picture;
}

void expect_equal(const SplatPlanes& a, const SplatPlanes& b) {
  EXPECT_EQ(a.light, b.light);
  EXPECT_EQ(a.clear, b.clear);
  EXPECT_EQ(a.depth, b.depth);
}

void expect_nothing(const SplatPlanes& picture) {
  for (size_t i = 0; i < picture.light.size(); i++) {
    ASSERT_EQ(picture.light[i], vec3(0));
    ASSERT_EQ(picture.clear[i], 1);
    ASSERT_TRUE(std::isinf(picture.depth[i]));
  }
}

}  // namespace

TEST(SplatDrawHard, an_empty_set_is_clear) {
  expect_nothing(draw_both(SplatSet(), make_test_view(33, 17)));
}

TEST(SplatDrawHard, one_splat_is_where_it_is) {
  SplatSet set;
  add_splat(set, vec3(1, 0.5f, -4), vec3(0.05f), no_turn, 0.9f, vec3(0, 1, 0));
  const SplatPlanes picture = draw_both(set, make_test_view(65, 65));
  const size_t most =
      size_t(std::min_element(picture.clear.begin(), picture.clear.end()) - picture.clear.begin());
  EXPECT_EQ(most % 65, 48u);  // 32.5 + 65 / 4
  EXPECT_EQ(most / 65, 24u);
  EXPECT_NEAR(picture.depth[most], 4, 0.01);
  EXPECT_EQ(picture.drawn, 1);
}

TEST(SplatDrawHard, splats_of_no_size_are_not_seen) {
  SplatSet set;
  add_splat(set, vec3(0, 0, -4), vec3(0), no_turn, 1, vec3(1));
  expect_nothing(draw_both(set, make_test_view(33, 17)));
  // A line has no area either.
  set.scale[0] = vec3(1, 0, 0);
  expect_nothing(draw_both(set, make_test_view(33, 17)));
  // Sets that were trained without the filter have it a pixel large, as opaque as it is.
  set.scale[0] = vec3(0);
  SplatDrawing settings;
  settings.project.keep_opacity = true;
  const SplatPlanes dot = draw_set(set, make_test_view(33, 17), settings);
  EXPECT_NEAR(dot.clear[8 * 33 + 16], 0.01f, 1e-3f);
  EXPECT_EQ(dot.clear[8 * 33 + 19], 1);
}

TEST(SplatDrawHard, splats_of_a_kilometre_fill_the_picture) {
  SplatSet set;
  for (int i = 0; i < 3000; i++)
    add_splat(set, vec3(0, 0, -4 - 0.01f * float(i)), vec3(1000, 1000, 1 + float(i)), no_turn, 0.3f,
              vec3(0.5f));
  const SplatPlanes picture = draw_both(set, make_test_view(300, 200));
  for (size_t i = 0; i < picture.light.size(); i++) {
    ASSERT_NEAR(picture.light[i].x, 0.2140f, 0.005f);
    ASSERT_LT(picture.clear[i], 1 / 255.0f);
  }
}

TEST(SplatDrawHard, a_quaternion_of_zero_turns_nothing) {
  SplatSet set, turned;
  add_splat(set, vec3(0, 0, -4), vec3(0.1f, 0.5f, 0.1f), quat(0, 0, 0, 0), 0.9f, vec3(1));
  add_splat(turned, vec3(0, 0, -4), vec3(0.1f, 0.5f, 0.1f), no_turn, 0.9f, vec3(1));
  expect_equal(draw_both(set, make_test_view(33, 17)), draw_both(turned, make_test_view(33, 17)));
}

TEST(SplatDrawHard, splats_that_are_not_numbers_are_left_out) {
  const SplatSet sound = make_random_splats(300, 2, 1);
  SplatSet set = sound;
  for (int i = 0; i < 6; i++) {
    const float bad = i % 2 == 0 ? no_number : infinite;
    const vec3 place(0, 0, -3), size(0.5f);
    add_splat(set, vec3(0, bad, -3), size, no_turn, 1, vec3(1));
    add_splat(set, place, vec3(0.5f, bad, 0.5f), no_turn, 1, vec3(1));
    add_splat(set, place, size, quat(bad, 0, 0, 0), 1, vec3(1));
    add_splat(set, place, size, no_turn, bad, vec3(1));
    add_splat(set, place, size, no_turn, 1, vec3(1, bad, 1));
    add_splat(set, place, size, no_turn, 1, vec3(1));
    set.harmonics.back().y = bad;
  }
  expect_equal(draw_both(set, make_test_view(40, 30)), draw_both(sound, make_test_view(40, 30)));
}

TEST(SplatDrawHard, huge_numbers_stay_sound) {
  SplatSet set = make_random_splats(300, 3, 2);
  for (float huge : {1e9f, 1e20f, 3e38f}) {
    add_splat(set, vec3(0, 0, -3), vec3(huge), no_turn, 0.5f, vec3(1));
    add_splat(set, vec3(huge, 0, -3), vec3(0.5f), no_turn, 0.5f, vec3(1));
    add_splat(set, vec3(0, 0, -3), vec3(0.5f), quat(huge, huge, 0, 0), 0.5f, vec3(huge));
  }
  draw_both(set, make_test_view(40, 30));
}

TEST(SplatDrawHard, the_eye_may_be_inside_a_splat) {
  SplatSet set = make_random_splats(300, 1, 3);
  Rng rng(4);
  for (float z : {-0.5f, 0.0f, 0.5f, -0.1001f})
    add_splat(set, vec3(0.01f, 0.02f, z), vec3(1, 2, 1.5f), random_turn(rng), 0.6f, vec3(0.7f));
  ScanCamera view = make_test_view(60, 40);
  draw_both(set, view);
  view.eye = dvec3(0.01, 0.02, -0.5);  // in the middle of one
  draw_both(set, view);
}

TEST(SplatDrawHard, a_million_splats_in_a_pixel_are_bounded) {
  SplatSet set;
  for (int i = 0; i < 1000000; i++)
    add_splat(set, vec3(0, 0, -4), vec3(0.02f), no_turn, 0.02f + 1e-7f * float(i),
              vec3(0.5f, 0.25f, 1));
  SplatDrawing settings;
  settings.project.cell_pixels = 0;
  const ShownSplats shown = make_shown_splats(set);
  const PlacedSplats at{&shown};
  SplatDrawer drawer;
  for (bool by_pixel : {false, true}) {
    SplatPlanes picture;
    settings.by_pixel = by_pixel;
    drawer.draw(picture, {&at, 1}, make_test_view(65, 65), settings);
    expect_sound(picture);
    EXPECT_EQ(picture.drawn, 1000000);
    const size_t middle = 32 * 65 + 32;
    EXPECT_NEAR(display_code(double(picture.light[middle].x)), 0.5, 0.005);
    EXPECT_LT(picture.clear[middle], 1 / 255.0f);
    EXPECT_NEAR(picture.depth[middle], 4, 1e-3);
  }
  // Merged they are few, and as opaque.
  SplatPlanes merged;
  settings.by_pixel = false;
  settings.project.budget = 1000;
  drawer.draw(merged, {&at, 1}, make_test_view(65, 65), settings);
  expect_sound(merged);
}

TEST(SplatDrawHard, opacities_too_small_to_be_seen_are_left_out) {
  SplatSet set;
  for (float opacity : {1e-45f, 1e-38f, 0.0f, -1.0f, 0.0039f})
    add_splat(set, vec3(0, 0, -4), vec3(1), no_turn, opacity, vec3(1));
  expect_nothing(draw_both(set, make_test_view(33, 17)));
  add_splat(set, vec3(0, 0, -4), vec3(1), no_turn, 0.0040f, vec3(1));
  EXPECT_EQ(draw_both(set, make_test_view(33, 17)).drawn, 1);
}

TEST(SplatDrawHard, an_eye_far_away_sees_nothing_and_no_nonsense) {
  const SplatSet set = make_random_splats(300, 3, 6);
  for (double far : {1e7, 1e15, 1e30, 1e300}) {
    draw_both(set, make_test_view(40, 30, dvec3(far, 0, 0)));
    draw_both(set, make_test_view(40, 30, dvec3(far, -far, far)));
  }
  expect_nothing(draw_both(set, make_test_view(40, 30, dvec3(1e7, 0, 1e7))));
}

TEST(SplatDrawHard, a_view_in_a_mirror_shows_the_set_from_left_to_right) {
  const SplatSet set = make_random_splats(500, 0, 7);
  ScanCamera view = make_test_view(64, 40), mirrored = view;
  mirrored.right = -view.right;
  const SplatPlanes a = draw_both(set, view), b = draw_both(set, mirrored);
  for (size_t i = 0; i < a.clear.size(); i++)
    ASSERT_NEAR(a.clear[i], b.clear[i / 64 * 64 + 63 - i % 64], 0.008) << i;
}

TEST(SplatDrawHard, the_number_of_threads_changes_nothing) {
  const SplatSet set = make_random_splats(20000, 3, 8);
  const ScanCamera view = make_test_view(150, 100);
  for (bool by_pixel : {false, true}) {
    SplatDrawing settings;
    settings.by_pixel = by_pixel;
    const SplatPlanes many = draw_set(set, view, settings);
    oneapi::tbb::global_control one(oneapi::tbb::global_control::max_allowed_parallelism, 1);
    expect_equal(draw_set(set, view, settings), many);
  }
}

TEST(SplatDrawHard, a_drawer_forgets_the_picture_before) {
  const ShownSplats large = make_shown_splats(make_random_splats(3000, 1, 9)),
                    small = make_shown_splats(make_random_splats(100, 1, 10));
  const PlacedSplats first{&large}, second{&small};
  SplatDrawer used, fresh;
  SplatPlanes picture, expected;
  std::vector<float> surface(100 * 80, 3.5f);
  SplatDrawing behind;
  behind.surface = surface;
  used.draw(picture, {&first, 1}, make_test_view(100, 80), behind);
  used.draw(picture, {&second, 1}, make_test_view(50, 70), {});
  fresh.draw(expected, {&second, 1}, make_test_view(50, 70), {});
  expect_equal(picture, expected);
}

}  // namespace wellspring::test
