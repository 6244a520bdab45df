// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "splat_draw_reference.h"

namespace wellspring::test {
using namespace wellspring::scan;

namespace {

SplatDrawing every_splat(bool by_pixel) {
  SplatDrawing settings;
  settings.by_pixel = by_pixel;
  settings.project.cell_pixels = 0;
  return settings;
}

// Expects what comes through, and depths, to be the reference's but for few pixels.
void expect_like(const SplatPlanes& picture, const std::vector<ReferencePixel>& reference,
                 double decibels) {
  EXPECT_GE(signal_to_noise(picture, reference), decibels);
  size_t other_depths = 0;
  for (size_t i = 0; i < reference.size(); i++) {
    ASSERT_NEAR(picture.clear[i], reference[i].clear, 0.008) << i;
    const bool same = std::isinf(reference[i].depth)
                          ? std::isinf(picture.depth[i])
                          : std::abs(double(picture.depth[i]) / reference[i].depth - 1) < 1e-3;
    other_depths += !same;
  }
  EXPECT_LE(other_depths, reference.size() / 200);
}

}  // namespace

TEST(SplatDraw, random_sets_are_like_the_reference_at_every_degree) {
  const ScanCamera view = make_test_view(80, 60);
  for (int degree = 0; degree <= 3; degree++)
    for (bool by_pixel : {false, true}) {
      SCOPED_TRACE(degree);
      const SplatSet set = make_random_splats(1000, degree, uint64_t(degree));
      expect_like(draw_set(set, view, every_splat(by_pixel)),
                  draw_reference(set, {}, view, by_pixel), 48);
    }
}

TEST(SplatDraw, floors_and_walls_are_like_the_reference) {
  const ScanCamera view = make_test_view(90, 60);
  const SplatSet set = make_floor_and_wall(3);
  for (bool by_pixel : {false, true})
    expect_like(draw_set(set, view, every_splat(by_pixel)), draw_reference(set, {}, view, by_pixel),
                48);
}

TEST(SplatDraw, the_picture_is_of_the_place_where_the_set_stands) {
  PlacedSplats at;
  at.turn = glm::angleAxis(0.7f, glm::normalize(vec3(1, 2, 3)));
  at.scale = 2.5;
  at.shift = dvec3(4e6, -20, 5e6);
  ScanCamera view = make_test_view(80, 60);
  view.axis = vec2(25, 41);  // not opposite the middle
  view.offset = vec2(0.1f, 0.8f);
  view.eye = at.shift + glm::dquat(at.turn) * dvec3(0.5, 0, 0);
  view.forward = at.turn * view.forward;
  view.right = at.turn * view.right;
  view.up = at.turn * view.up;
  const SplatSet set = make_random_splats(800, 3, 11);
  expect_like(draw_set(set, view, every_splat(false), at), draw_reference(set, at, view, false),
              46);
}

TEST(SplatDraw, splats_are_hidden_behind_a_surface_and_blended_before_it) {
  const ScanCamera view = make_test_view(90, 60);
  const SplatSet set = make_random_splats(1000, 1, 5);
  std::vector<float> surface(90 * 60, std::numeric_limits<float>::infinity());
  for (size_t i = 0; i < surface.size(); i++)
    if (i % 90 > 30) surface[i] = 3.2f + 0.02f * float(i % 90);
  for (bool by_pixel : {false, true}) {
    SplatDrawing settings = every_splat(by_pixel);
    settings.surface = surface;
    expect_like(draw_set(set, view, settings), draw_reference(set, {}, view, by_pixel, surface),
                46);
  }
  SplatDrawing settings = every_splat(false);
  std::fill(surface.begin(), surface.end(), 0.05f);
  settings.surface = surface;
  for (float clear : draw_set(set, view, settings).clear) ASSERT_EQ(clear, 1);
}

// Planes cross in each pixel where they do in truth, whatever way the eye turns.
TEST(SplatDraw, flat_splats_are_as_far_as_their_planes) {
  SplatSet set;
  const quat turn = glm::angleAxis(0.9f, glm::normalize(vec3(0.3f, 1, 0)));
  add_splat(set, vec3(0.1f, 0, -4), vec3(1.2f, 1.2f, 0), turn, 1, vec3(1));
  const ScanCamera view = make_test_view(64, 64);
  const SplatPlanes picture = draw_set(set, view, every_splat(true));
  const vec3 normal = turn * vec3(0, 0, 1);
  int compared = 0;
  for (int y = 0; y < 64; y++)
    for (int x = 0; x < 64; x++) {
      const size_t i = size_t(y * 64 + x);
      const vec3 ray((float(x) + 0.5f - 32) / 64, (32 - float(y) - 0.5f) / 64, -1);
      const float depth = dot(normal, set.place[0]) / dot(normal, ray);
      if (std::isinf(picture.depth[i])) continue;
      compared++;
      ASSERT_NEAR(picture.depth[i] / depth, 1, 2e-3) << x << ' ' << y;
    }
  EXPECT_GT(compared, 300);
}

TEST(SplatDraw, by_pixel_nothing_pops_when_splats_change_their_order) {
  // Two splats cross; where the eye is decides whose middle is nearer.
  SplatSet set;
  add_splat(set, vec3(0.05f, 0, -3), vec3(0.8f, 0.8f, 0.001f), glm::angleAxis(0.6f, vec3(0, 1, 0)),
            0.95f, vec3(1, 0, 0));
  add_splat(set, vec3(-0.05f, 0, -3), vec3(0.8f, 0.8f, 0.001f),
            glm::angleAxis(-0.6f, vec3(0, 1, 0)), 0.95f, vec3(0, 0, 1));
  const auto change = [&](bool by_pixel) {
    ScanCamera left = make_test_view(64, 64), right = left;
    left.forward = glm::normalize(vec3(-1e-3f, 0, -1)), right.forward = vec3(1e-3f, 0, -1);
    left.right = vec3(-left.forward.z, 0, left.forward.x);
    right.right = vec3(1, 0, 1e-3f);
    const SplatPlanes a = draw_set(set, left, every_splat(by_pixel)),
                      b = draw_set(set, right, every_splat(by_pixel));
    double sum = 0;
    for (size_t i = 0; i < a.light.size(); i++) sum += double(glm::length(a.light[i] - b.light[i]));
    return sum / double(a.light.size());
  };
  EXPECT_GT(change(false), 0.1);
  EXPECT_LT(change(true), 0.02);
}

TEST(SplatDraw, small_splats_keep_their_light) {
  // Smaller than a pixel they fade instead of becoming a pixel large.
  const auto sum = [](float size) {
    SplatSet set;
    add_splat(set, vec3(0, 0, -4), vec3(size), quat(1, 0, 0, 0), 0.6f, vec3(1));
    float hidden = 0;
    for (float clear : draw_set(set, make_test_view(64, 64)).clear) hidden += 1 - clear;
    return hidden;
  };
  EXPECT_NEAR(sum(0.1f) / sum(0.05f), 4, 0.2);
  EXPECT_NEAR(sum(0.05f) / sum(0.025f), 4, 0.4);
}

TEST(SplatDraw, laid_over_a_picture_it_is_blended_in_display_codes) {
  SplatSet set;
  add_splat(set, vec3(0, 0, -4), vec3(1), quat(1, 0, 0, 0), 0.5f, vec3(0.8f));
  const ScanCamera view = make_test_view(37, 21);
  const SplatPlanes picture = draw_set(set, view);
  std::vector<vec3> linear(37 * 21, vec3(0.25f));
  lay_over(linear, picture, 2);
  const size_t middle = 10 * 37 + 18;
  EXPECT_NEAR(
      display_code(2 * double(linear[middle].x)),
      0.8 * (1 - double(picture.clear[middle])) + double(picture.clear[middle]) * display_code(0.5),
      1e-4);
  // Nothing changes if it is as bright as what is behind, however opaque it is.
  std::fill(linear.begin(), linear.end(), vec3(0.603827f));
  lay_over(linear, picture, 1);
  for (vec3 v : linear) ASSERT_NEAR(v.x, 0.603827f, 1e-3);
}

TEST(SplatDraw, splats_are_cut_by_their_middles) {
  PlacedSplats at;
  at.turn = glm::angleAxis(0.4f, glm::normalize(vec3(1, 2, 3)));
  at.scale = 2;
  at.shift = dvec3(3, -1, 2);
  ScanCamera view = make_test_view(80, 60);
  view.eye = at.shift;
  view.forward = at.turn * view.forward, view.right = at.turn * view.right,
  view.up = at.turn * view.up;
  const SplatSet set = make_random_splats(800, 1, 5);
  SplatSet left = set;
  const ScanCut cut{glm::normalize(vec3(1, 0.2f, 0)), 3.1f};
  size_t lost = 0;
  for (size_t i = 0; i < set.size(); i++) {
    const dvec3 place = glm::dquat(at.turn) * (at.scale * dvec3(set.place[i])) + at.shift;
    if (glm::dot(place, dvec3(cut.normal)) < double(cut.offset)) left.opacity[i] = 0, lost++;
  }
  ASSERT_TRUE(lost > 100 && lost < 700) << lost;
  const PlacedSplats whole = at;
  const std::vector<ScanCut> cuts{cut};
  at.cuts = cuts;
  for (bool by_pixel : {false, true})
    expect_like(draw_set(set, view, every_splat(by_pixel), at),
                draw_reference(left, whole, view, by_pixel), 46);
}

}  // namespace wellspring::test
