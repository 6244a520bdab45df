// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <limits>
#include <map>
#include <set>

#include "base/load_error.h"
#include "tests/unit/folder.h"
#include "tests/unit/scan/tree_made.h"

namespace wellspring::test {
namespace {

// Fails unless each point that was given is in one leaf, once, within half a step.
void expect_all_points(const PointTree& tree, const std::vector<dvec3>& given) {
  std::vector<FoundPoint> found = leaf_points(tree);
  ASSERT_EQ(found.size(), given.size());
  double step = 0;
  for (const FoundPoint& point : found) step = std::max(step, point.step);
  // Points that are found are taken away, so that none serves twice.
  std::map<std::array<int64_t, 3>, std::vector<FoundPoint>> cells;
  const auto cell = [step](dvec3 place) {
    const dvec3 at = glm::floor(place / (4 * step));
    return std::array{int64_t(at.x), int64_t(at.y), int64_t(at.z)};
  };
  for (const FoundPoint& point : found) cells[cell(point.place)].push_back(point);
  size_t lost = 0;
  for (const dvec3& place : given) {
    bool is_found = false;
    for (int i = 0; i < 27 && !is_found; i++) {
      auto at = cell(place - tree.origin);
      at[0] += i % 3 - 1, at[1] += i / 3 % 3 - 1, at[2] += i / 9 - 1;
      const auto near = cells.find(at);
      if (near == cells.end()) continue;
      for (size_t k = 0; k < near->second.size() && !is_found; k++) {
        const FoundPoint& point = near->second[k];
        const dvec3 off = glm::abs(point.place + tree.origin - place);
        is_found = std::max({off.x, off.y, off.z}) <= 0.5 * point.step * (1 + 1e-6) + 4e-9;
        if (is_found) near->second.erase(near->second.begin() + long(k));
      }
    }
    lost += !is_found;
  }
  EXPECT_EQ(lost, 0u);
}

PointBlock block_of(std::vector<dvec3> places) {
  PointBlock block;
  block.place = std::move(places);
  return block;
}

}  // namespace

TEST(WriteTree, each_point_lies_in_one_leaf_once) {
  const Folder folder;
  const PointBlock house = made_house(20000, {9, 4, 7});
  const std::string path = folder.file("house.points");
  const TreeReport report = write_tree({made_source(house, house_info())}, path, plain_settings());
  EXPECT_EQ(report.points, 20000u);
  EXPECT_FALSE(std::filesystem::exists(path + ".work"));
  const PointTree tree = open_tree(path);
  EXPECT_EQ(tree.points, 20000u);
  EXPECT_TRUE(tree.has_color && tree.has_intensity && tree.has_classes);
  EXPECT_GT(tree.nodes.size(), 40u);
  for (const TreeNode& node : tree.nodes) {
    if (node.is_leaf()) {
      EXPECT_LE(node.count, 500u);
    }
  }
  expect_all_points(tree, house.place);
  // Surfaces have 20000 points on 350 square metres.
  EXPECT_NEAR(tree.density, 20000 / 350.0, 20);
}

TEST(WriteTree, colours_and_classes_stay_with_their_points) {
  const PointBlock house = made_house(3000, {9, 4, 7});
  const PointTree tree = make_tree(made_source(house, house_info()), plain_settings());
  std::multiset<std::array<uint32_t, 3>> given, found;
  for (size_t i = 0; i < house.size(); i++) {
    const auto& c = house.color[i];
    given.insert({uint32_t(c[0] | c[1] << 8 | c[2] << 16), house.classification[i],
                  uint32_t(house.place[i].x * 100)});
  }
  for (const FoundPoint& point : leaf_points(tree))
    found.insert({point.color & 0xffffff, point.classification,
                  uint32_t((point.place.x + tree.origin.x) * 100)});
  size_t same = 0;
  for (const auto& point : given) same += found.contains(point);
  EXPECT_GT(same, 2900u);  // the others lie at the limit of a centimetre
}

TEST(WriteTree, one_point_is_a_tree) {
  const PointTree tree = make_tree(made_source(block_of({{1, 2, 3}})), plain_settings());
  ASSERT_EQ(tree.nodes.size(), 1u);
  EXPECT_EQ(tree.points, 1u);
  expect_all_points(tree, {{1, 2, 3}});
  EXPECT_GT(tree.nodes[0].spacing, 0);
  EXPECT_EQ(tree.points_of(0).normal[0], 0x8080);
}

TEST(WriteTree, points_in_one_place_are_not_split_for_ever) {
  std::vector<dvec3> places(1000000, dvec3(5, 6, 7));
  places.push_back({5, 6, 8});
  const PointTree tree = make_tree(made_source(block_of(places)), plain_settings());
  EXPECT_LE(tree.nodes.size(), 3u);
  EXPECT_EQ(leaf_points(tree).size(), 1000001u);
}

TEST(WriteTree, places_that_are_no_numbers_are_counted) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const Folder folder;
  const TreeReport report = write_tree(
      {made_source(block_of({{0, 0, 0}, {nan, 0, 0}, {1, 1, 1}, {0, infinity, 0}, {0, 0, 1e300}}))},
      folder.file("a.points"), plain_settings());
  EXPECT_EQ(report.points, 2u);
  EXPECT_EQ(report.dropped, 3u);
  EXPECT_EQ(leaf_points(open_tree(folder.file("a.points"))).size(), 2u);
  EXPECT_THROW(make_tree(made_source(block_of({{nan, 0, 0}})), plain_settings()), LoadError);
}

TEST(WriteTree, promises_of_counts_and_bounds_need_not_hold) {
  ScanInfo info;
  info.points = 7, info.is_counted = true, info.is_bounded = true;
  info.low = dvec3(0), info.high = dvec3(1);
  const Folder folder;
  const std::vector<dvec3> places{{0, 0, 0}, {100, 0, 0}, {0, -50, 3}};
  const TreeReport report =
      write_tree({made_source(block_of(places), info)}, folder.file("a.points"), plain_settings());
  ASSERT_EQ(report.notices.size(), 1u);
  EXPECT_NE(report.notices[0].find("promises 7 points and has 3"), std::string::npos);
  expect_all_points(open_tree(folder.file("a.points")), places);
}

TEST(WriteTree, places_far_from_zero_keep_half_a_millimetre) {
  Rng rng(3);
  std::vector<dvec3> places;
  for (int i = 0; i < 2000; i++)
    places.push_back(dvec3(1e7, 5e6, 300) +
                     400.0 * dvec3(rng.uniform(), rng.uniform(), 0.1 * rng.uniform()));
  places.push_back({0, 0, 0});  // lies ten thousand kilometres aside, as wrong ones do
  const PointTree tree = make_tree(made_source(block_of(places)), plain_settings());
  expect_all_points(tree, places);
  for (const TreeNode& node : tree.nodes) {
    if (node.is_leaf()) {
      EXPECT_LE(node.size, 32);
    }
  }
  for (const FoundPoint& point : leaf_points(tree)) EXPECT_LE(point.step, 0.0005);
}

TEST(WriteTree, the_up_axis_and_the_unit_are_turned_into_ours) {
  ScanInfo info;
  info.unit = 0.01;
  const auto place_in = [&](UpAxis up, double turn) {
    TreeSettings settings = plain_settings();
    settings.up = up, settings.turn = turn;
    const PointTree tree = make_tree(made_source(block_of({{100, 200, 300}}), info), settings);
    return tree.origin + leaf_points(tree)[0].place;
  };
  const auto expect_near = [](dvec3 a, dvec3 b) { EXPECT_LT(glm::length(a - b), 1e-6); };
  expect_near(place_in(UpAxis::y, 0), {1, 2, 3});
  expect_near(place_in(UpAxis::z, 0), {1, 3, -2});
  expect_near(place_in(UpAxis::x, 0), {3, 1, 2});
  expect_near(place_in(UpAxis::y, 1.5707963267948966), {3, 2, -1});
}

TEST(WriteTree, wide_colours_are_told_from_narrow_ones_by_the_whole) {
  PointBlock dark = block_of({{0, 0, 0}}), bright = block_of({{1, 0, 0}});
  dark.color = {{200, 0, 0}}, bright.color = {{65535, 51400, 0}};
  ScanInfo info;
  info.fields.color = true, info.color_max = 0;
  const Folder folder;
  const std::string path = folder.file("a.points");
  write_tree({made_source(dark, info, "dark"), made_source(bright, info, "bright")}, path,
             plain_settings());
  std::set<uint32_t> colors;
  for (const FoundPoint& point : leaf_points(open_tree(path))) colors.insert(point.color);
  EXPECT_EQ(colors, (std::set<uint32_t>{0x000001, 0x00c8ff}));
  const PointTree narrow = make_tree(made_source(dark, info), plain_settings());
  EXPECT_EQ(leaf_points(narrow)[0].color, 200u);
}

TEST(WriteTree, a_scan_without_colour_says_so) {
  const PointTree tree = make_tree(made_source(block_of({{0, 0, 0}})), plain_settings());
  EXPECT_FALSE(tree.has_color || tree.has_intensity || tree.has_classes);
  EXPECT_EQ(tree.points_of(0).classification, nullptr);
  EXPECT_EQ(leaf_points(tree)[0].color, 0x00bfbfbfu);
}

TEST(WriteTree, many_chunks_make_the_same_leaves_as_one) {
  const PointBlock house = made_house(30000, {9, 4, 7});
  const Folder folder;
  TreeSettings settings = plain_settings();
  settings.chunk_points = 2000;
  write_tree({made_source(house, house_info())}, folder.file("a.points"), settings);
  const PointTree tree = open_tree(folder.file("a.points"));
  expect_all_points(tree, house.place);
  const PointTree whole = make_tree(made_source(house, house_info()), plain_settings());
  ASSERT_EQ(tree.nodes.size(), whole.nodes.size());
  for (size_t i = 0; i < tree.nodes.size(); i++) {
    EXPECT_EQ(tree.nodes[i].count, whole.nodes[i].count);
    EXPECT_EQ(tree.nodes[i].corner, whole.nodes[i].corner);
    EXPECT_NEAR(tree.nodes[i].spacing, whole.nodes[i].spacing, 0.02 * whole.nodes[i].spacing);
  }
}

TEST(WriteTree, memory_stays_within_its_bound) {
  const PointBlock house = made_house(200000, {9, 4, 7});
  const Folder folder;
  TreeSettings settings = plain_settings();
  for (const uint64_t memory : {uint64_t(40) << 20, uint64_t(64) << 20}) {
    settings.memory = memory;
    const TreeReport report =
        write_tree({made_source(house, house_info())}, folder.file("a.points"), settings);
    EXPECT_LE(report.most_held, memory);
    EXPECT_GT(report.most_held, memory / 8);
  }
}

// Stops an import each time it has told of progress so many times, and goes on.
TEST(WriteTree, what_was_broken_off_goes_on_to_the_same_bytes) {
  const PointBlock one = made_house(20000, {9, 4, 7}), two = made_house(15000, {3, 8, 2}, 2);
  const Folder folder;
  TreeSettings settings = plain_settings();
  settings.chunk_points = 4000;
  int reads = 0;
  ScanInfo info = house_info();
  info.stations = {{"gate", dvec3(3, 1, 2)}};
  info.notices = {"A notice."};
  TreeSource first = made_source(one, info, "one"), second = made_source(two, info, "two");
  const std::vector<TreeSource> plain{first, second};
  const auto counted = [&reads](TreeSource& source) {
    source.open = [&reads, open = source.open] {
      reads++;
      return open();
    };
  };
  counted(first), counted(second);
  write_tree(plain, folder.file("whole.points"), settings);
  struct Broken {};
  TreeReport report;
  int breaks = 0, reads_before_building = 0;
  for (bool is_done = false; !is_done; breaks++) {
    ASSERT_LT(breaks, 200);
    int told = 0;
    const auto tell = [&](double, const char* stage) {
      if (std::string(stage) == "building" && reads_before_building == 0)
        reads_before_building = reads;
      if (++told > breaks) throw Broken();
    };
    try {
      report = write_tree({first, second}, folder.file("parts.points"), settings, tell);
      is_done = true;
    } catch (const Broken&) {}
  }
  EXPECT_GE(breaks, 10);
  EXPECT_EQ(reads, reads_before_building);  // nothing was read once points were distributed
  EXPECT_EQ(report.notices.size(), 2u);
  EXPECT_EQ(folder.read("parts.points"), folder.read("whole.points"));
  EXPECT_EQ(open_tree(folder.file("parts.points")).stations.size(), 2u);
  EXPECT_FALSE(std::filesystem::exists(folder.file("parts.points.work")));
}

TEST(WriteTree, a_source_that_fails_is_named) {
  const Folder folder;
  TreeSource bad{"bad.las", []() -> std::unique_ptr<PointSource> {
                   throw LoadError("bad.las", "byte 7", "is damaged");
                 }};
  try {
    write_tree({made_source(made_house(100, dvec3(1))), bad}, folder.file("a.points"),
               plain_settings());
    FAIL();
  } catch (const LoadError& error) {
    EXPECT_EQ(error.file, "bad.las");
  }
  EXPECT_THROW(write_tree({}, folder.file("a.points"), plain_settings()), LoadError);
}

}  // namespace wellspring::test
