// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <set>

#include "scan/tree/box_shadow.h"
#include "scan/tree/choose_nodes.h"
#include "scan/tree/opacity.h"
#include "tests/unit/scan/tree_made.h"

namespace wellspring::test {
namespace {

// Looks from `eye` to `at`.
ScanCamera looking(dvec3 eye, dvec3 at) {
  ScanCamera view;
  view.eye = eye;
  view.forward = vec3(glm::normalize(at - eye));
  view.right = glm::normalize(glm::cross(view.forward, vec3(0.1f, 1, 0)));
  view.up = glm::cross(view.right, view.forward);
  view.width = 1260, view.height = 720;
  view.tan_half_fov = 0.4f;
  view.near = 0.05f;
  return view;
}

bool sees(const ScanCamera& view, dvec3 place) {
  const dvec3 to = place - view.eye;
  const double z = glm::dot(to, dvec3(view.forward));
  return z > double(view.near) && std::abs(glm::dot(to, dvec3(view.right))) < z * 0.7 &&
         std::abs(glm::dot(to, dvec3(view.up))) < z * 0.4;
}

// Returns the points of a solid ball, as a set of particles has them.
PointBlock made_ball(int count, double radius) {
  Rng rng(11);
  PointBlock block;
  while (int(block.size()) < count) {
    const dvec3 place = radius * (2.0 * dvec3(rng.uniform(), rng.uniform(), rng.uniform()) - 1.0);
    if (glm::length(place) <= radius) block.place.push_back(place);
  }
  return block;
}

}  // namespace

TEST(ChooseNodes, the_cut_has_all_points_that_are_seen_and_keeps_its_budget) {
  const PointTree tree =
      make_tree(made_source(made_house(40000, {9, 4, 7}), house_info()), plain_settings());
  Rng rng(1);
  for (int i = 0; i < 12; i++) {
    const dvec3 eye = 12.0 * (dvec3(rng.uniform(), rng.uniform(), rng.uniform()) - 0.5);
    const ScanCamera view = looking(eye, dvec3(0));
    ChooseSettings settings;
    settings.pixels = 0.01f, settings.budget = 1000000;
    const ChosenNodes all = choose_nodes(tree, view, settings);
    // Refined to the end, the cut is leaves, and they hold whatever a brute search sees.
    std::set<std::array<double, 3>> chosen;
    uint64_t points = 0;
    double before = 0;
    for (const ChosenNode& node : all.nodes) {
      EXPECT_TRUE(tree.nodes[node.node].is_leaf());
      const NodePoints of = tree.points_of(node.node);
      for (uint32_t k = 0; k < of.count; k++) {
        const dvec3 place = place_of(of, k);
        chosen.insert({place.x, place.y, place.z});
      }
      points += of.count;
      const dvec3 off = glm::max(of.corner - eye, eye - of.corner - double(of.size));
      const double distance = glm::length(glm::max(off, dvec3(0)));
      EXPECT_GE(distance, before);
      before = distance;
    }
    EXPECT_EQ(points, all.points);
    size_t missing = 0;
    for (const FoundPoint& point : leaf_points(tree))
      missing += sees(view, point.place) &&
                 !chosen.contains({point.place.x, point.place.y, point.place.z});
    EXPECT_EQ(missing, 0u);
    // A budget gives coarser nodes, of which none is below another.
    settings.budget = 20000;
    const ChosenNodes few = choose_nodes(tree, view, settings);
    EXPECT_LE(few.points, settings.budget);
    EXPECT_LE(few.nodes.size(), all.nodes.size());
    std::set<uint32_t> in;
    for (const ChosenNode& node : few.nodes) in.insert(node.node);
    for (const ChosenNode& node : few.nodes) {
      const TreeNode& of = tree.nodes[node.node];
      for (uint32_t k = 0; k < of.children; k++) EXPECT_FALSE(in.contains(of.first_child + k));
    }
  }
}

TEST(ChooseNodes, nodes_are_refined_until_their_spacing_is_that_of_pixels) {
  const PointTree tree =
      make_tree(made_source(made_house(40000, {9, 4, 7}), house_info()), plain_settings());
  ChooseSettings settings;
  settings.budget = 1000000, settings.pixels = 4;
  const ChosenNodes chosen = choose_nodes(tree, looking({0, 0, 60}, dvec3(0)), settings);
  ASSERT_FALSE(chosen.nodes.empty());
  bool is_coarse = false;
  for (const ChosenNode& node : chosen.nodes) {
    EXPECT_TRUE(node.pixels <= settings.pixels || tree.nodes[node.node].is_leaf());
    is_coarse = is_coarse || !tree.nodes[node.node].is_leaf();
  }
  EXPECT_TRUE(is_coarse);
  ScanCamera away = looking({0, 0, 60}, {0, 0, 120});
  EXPECT_TRUE(choose_nodes(tree, away, settings).nodes.empty());
}

TEST(ChooseNodes, what_lies_behind_opaque_nodes_is_left_out) {
  const PointTree tree = make_tree(made_source(made_ball(150000, 4)), plain_settings(3000));
  ChooseSettings settings;
  settings.pixels = 1, settings.budget = 10000000;
  const ScanCamera view = looking({0, 0, 9}, dvec3(0));
  const ChosenNodes all = choose_nodes(tree, view, settings);
  EXPECT_EQ(all.hidden, 0u);
  settings.threshold = 0.9f;
  const ChosenNodes seen = choose_nodes(tree, view, settings);
  EXPECT_GT(seen.hidden, all.points / 10);
  EXPECT_LT(seen.points, all.points);
}

TEST(BoxShadow, hides_what_no_sight_line_reaches) {
  Rng rng(2);
  const auto place = [&](double size) {
    return size * (2.0 * dvec3(rng.uniform(), rng.uniform(), rng.uniform()) - 1.0);
  };
  // Does the way to `at` go through the box?
  const auto is_behind = [](dvec3 eye, dvec3 at, const DoubleBox& box) {
    double from = 0, to = 1;
    for (int axis = 0; axis < 3; axis++) {
      double a = (box.low[axis] - eye[axis]) / (at[axis] - eye[axis]),
             b = (box.high[axis] - eye[axis]) / (at[axis] - eye[axis]);
      from = std::max(from, std::min(a, b)), to = std::min(to, std::max(a, b));
    }
    return from <= to;
  };
  int hidden = 0, shown = 0;
  for (int i = 0; i < 20000; i++) {
    const dvec3 eye = place(6), low = place(2), other_low = place(9);
    const DoubleBox box{low, low + 1.0 + glm::abs(place(2))};
    const DoubleBox other{other_low, other_low + 0.1 + glm::abs(place(0.4))};
    const bool is_in =
        glm::all(glm::lessThan(box.low, eye)) && glm::all(glm::lessThan(eye, box.high));
    bool expected = !is_in;
    for (int k = 0; k < 8 && expected; k++) {
      const dvec3 corner(k & 1 ? other.low.x : other.high.x, k & 2 ? other.low.y : other.high.y,
                         k & 4 ? other.low.z : other.high.z);
      expected = is_behind(eye, corner, box);
    }
    EXPECT_EQ(BoxShadow(eye, box).hides(other), expected);
    (expected ? hidden : shown)++;
  }
  EXPECT_GT(hidden, 200);
  EXPECT_GT(shown, 200);
}

TEST(SampleOpacity, a_convex_body_stops_the_ratio_of_surfaces) {
  const Box cube{vec3(0), vec3(1)};
  for (const float radius : {0.5f, 0.25f, 0.1f}) {
    const Sphere sphere{vec3(0.5f), radius};
    const double expected = 4 * double(pi) * radius * radius / 6;
    EXPECT_NEAR(sample_opacity(cube, {&sphere, 1}, 400000, 1), expected,
                0.01 * std::max(expected, 0.1));
  }
  // The mean over flat boxes, too.
  const Sphere small{vec3(1, 0.5f, 2), 0.5f};
  EXPECT_NEAR(sample_opacity({vec3(0), vec3(2, 1, 4)}, {&small, 1}, 400000, 1),
              double(pi) / (2 * (2 + 4 + 8)), 0.002);
}

TEST(SampleOpacity, random_spheres_stop_what_the_notes_say) {
  Rng rng(4);
  const std::pair<int, double> expected[] = {{100, 0.35}, {400, 0.67}, {1600, 0.82}};
  for (const auto& [count, opacity] : expected) {
    std::vector<Sphere> spheres;
    for (int i = 0; i < count; i++)
      spheres.push_back({0.05f + 0.9f * vec3(rng.uniform(), rng.uniform(), rng.uniform()), 0.05f});
    EXPECT_NEAR(sample_opacity({vec3(0), vec3(1)}, spheres, 100000, 1), opacity, 0.02) << count;
  }
  EXPECT_EQ(sample_opacity({vec3(0), vec3(1)}, {}, 100, 1), 0);
}

TEST(ChooseNodes, nodes_of_which_a_cut_keeps_nothing_are_left_out) {
  const PointTree tree =
      make_tree(made_source(made_house(40000, {9, 4, 7}), house_info()), plain_settings());
  ScanCamera view = looking({-6, 2, -4}, dvec3(0));
  ChooseSettings settings;
  settings.pixels = 0.01f, settings.budget = 1000000;
  const ChosenNodes all = choose_nodes(tree, view, settings);
  view.cuts = {{{1, 0, 0}, 1.5f}};
  const ChosenNodes kept = choose_nodes(tree, view, settings);
  // All leaves that reach beyond the plane are there, and no others.
  const auto reaches = [&](const ChosenNode& one) {
    const TreeNode& node = tree.nodes[one.node];
    return node.corner.x + double(node.size) >= 1.5;
  };
  EXPECT_TRUE(std::ranges::all_of(kept.nodes, reaches));
  EXPECT_EQ(int64_t(kept.nodes.size()), std::ranges::count_if(all.nodes, reaches));
  EXPECT_LT(kept.nodes.size(), all.nodes.size());
}

}  // namespace wellspring::test
