// SPDX-License-Identifier: Apache-2.0
// Fewer splats stand for many.
#include <gtest/gtest.h>

#include "splat_draw_reference.h"

namespace wellspring::test {
using namespace wellspring::scan;

namespace {

// A dense ball of small flat splats, coloured in broad stripes.
SplatSet make_ball(int count) {
  SplatSet set;
  set.degree = 1;
  Rng rng(1);
  for (int i = 0; i < count; i++) {
    const float z = 2 * rng.uniform() - 1, around = 2 * pi * rng.uniform();
    const vec3 normal(std::sqrt(1 - z * z) * std::cos(around), z,
                      std::sqrt(1 - z * z) * std::sin(around));
    const float size = 1.2f * std::sqrt(4 * pi / float(count));
    const vec3 side = glm::normalize(cross(normal, vec3(0.3f, 0.9f, 0.31f)));
    const quat turn = glm::quat_cast(mat3(side, cross(normal, side), normal));
    add_splat(set, normal + vec3(0, 0, -4), size * vec3(1, 0.6f, 0.05f), turn,
              0.4f + 0.6f * rng.uniform(), vec3(0.5f + 0.4f * std::sin(4 * z), 0.5f, 0.4f));
  }
  for (vec3& v : set.harmonics) v = vec3(0.05f);
  return set;
}

double difference(const SplatPlanes& a, const SplatPlanes& b) {
  std::vector<ReferencePixel> other(b.light.size());
  for (size_t i = 0; i < other.size(); i++)
    for (int c = 0; c < 3; c++) other[i].code[c] = display_code(double(b.light[i][c]));
  return signal_to_noise(a, other);
}

}  // namespace

TEST(SplatLevels, a_merged_splat_has_the_moments_of_its_parts) {
  SplatSet set;
  const quat turn = glm::angleAxis(0.4f, glm::normalize(vec3(1, 1, 0)));
  add_splat(set, vec3(0.1f, 0.5f, 0.5f), vec3(0.1f, 0.1f, 0.01f), turn, 0.5f, vec3(1, 0, 0));
  add_splat(set, vec3(0.9f, 0.5f, 0.5f), vec3(0.1f, 0.1f, 0.01f), turn, 0.5f, vec3(0, 0, 1));
  const SplatSet merged = merge_in_cells(set, 1);
  ASSERT_EQ(merged.size(), 1u);
  EXPECT_LT(glm::length(merged.place[0] - vec3(0.5f)), 1e-6f);
  EXPECT_LT(glm::length(merged.color[0] - vec3(0.5f, 0, 0.5f)), 1e-6f);
  mat3 axes = glm::mat3_cast(turn), found = glm::mat3_cast(merged.turn[0]);
  for (int k = 0; k < 3; k++) axes[k] *= set.scale[0][k], found[k] *= merged.scale[0][k];
  mat3 expected = axes * glm::transpose(axes);
  expected[0][0] += 0.16f;
  const mat3 spread = found * glm::transpose(found);
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++) EXPECT_NEAR(spread[i][k], expected[i][k], 1e-6f);
  EXPECT_LT(merged.opacity[0], 0.5f);
}

TEST(SplatLevels, splats_of_other_sizes_or_cells_stay_apart) {
  SplatSet set;
  for (float x : {0.2f, 0.4f, 1.5f})
    add_splat(set, vec3(x, 0.5f, 0.5f), vec3(0.1f), quat(1, 0, 0, 0), 0.5f, vec3(1));
  add_splat(set, vec3(0.3f, 0.5f, 0.5f), vec3(7), quat(1, 0, 0, 0), 0.5f, vec3(1));
  EXPECT_EQ(merge_in_cells(set, 1).size(), 3u);
}

TEST(SplatLevels, every_splat_is_in_one_leaf_and_boxes_hold_what_is_below) {
  const SplatSet set = make_ball(20000);
  const SplatTree tree = make_splat_tree(set);
  std::vector<int> times(set.size());
  for (size_t n = 0; n < tree.nodes.size(); n++) {
    const SplatNode& node = tree.nodes[n];
    if (node.child_count == 0)
      for (uint32_t i = node.first; i < node.first + node.count; i++) {
        times[tree.order[i]]++;
        EXPECT_TRUE(glm::all(glm::lessThanEqual(node.low, set.place[tree.order[i]] - tree.middle)));
      }
    uint32_t below = 0;
    for (uint32_t c = node.first_child; c < node.first_child + node.child_count; c++) {
      EXPECT_GT(c, n);
      EXPECT_TRUE(glm::all(glm::lessThanEqual(node.low, tree.nodes[c].low)));
      EXPECT_TRUE(glm::all(glm::greaterThanEqual(node.high, tree.nodes[c].high)));
      below += tree.nodes[c].count;
    }
    if (node.child_count != 0) {
      EXPECT_LT(node.count, below);
    }
  }
  EXPECT_EQ(times, std::vector<int>(set.size(), 1));
}

TEST(SplatLevels, far_away_few_splats_look_like_all) {
  const SplatSet set = make_ball(60000);
  const ShownSplats shown = make_shown_splats(set);
  const PlacedSplats at{&shown};
  SplatDrawer drawer;
  SplatPlanes all, few;
  SplatDrawing settings;
  for (double away : {6.0, 30.0}) {
    const ScanCamera view = make_test_view(240, 180, dvec3(0, 0, away));
    settings.project.cell_pixels = 0;
    drawer.draw(all, {&at, 1}, view, settings);
    settings.project.cell_pixels = 1;
    drawer.draw(few, {&at, 1}, view, settings);
    EXPECT_EQ(all.looked_at, 60000);
    EXPECT_LT(few.looked_at, away > 10 ? 4000 : 60001);
    EXPECT_GT(difference(few, all), 36) << away;
  }
}

TEST(SplatLevels, a_budget_is_kept) {
  const SplatSet set = make_ball(60000);
  const ShownSplats shown = make_shown_splats(set);
  const PlacedSplats at{&shown};
  SplatDrawer drawer;
  SplatPlanes all, few;
  SplatDrawing settings;
  settings.project.cell_pixels = 0;
  const ScanCamera view = make_test_view(240, 180);
  drawer.draw(all, {&at, 1}, view, settings);
  settings.project.budget = 15000;
  drawer.draw(few, {&at, 1}, view, settings);
  EXPECT_LE(few.looked_at, 15000);
  EXPECT_GT(few.looked_at, 5000);
  EXPECT_GT(difference(few, all), 26);
}

}  // namespace wellspring::test
