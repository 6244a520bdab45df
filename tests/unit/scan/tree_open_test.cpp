// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstring>
#include <functional>
#include <gtest/gtest.h>
#include <map>
#include <zlib.h>

#include "base/load_error.h"
#include "image/srgb.h"
#include "scan/tree/octahedral.h"
#include "scan/tree/tree_format.h"
#include "tests/unit/folder.h"
#include "tests/unit/scan/tree_made.h"

namespace wellspring::test {
namespace {

uint32_t crc_of(const std::string& bytes, size_t from, size_t to) {
  return uint32_t(crc32(0, reinterpret_cast<const Bytef*>(bytes.data() + from), uInt(to - from)));
}

// Writes what a wrong program might: sums are right.
std::string with_sums(std::string bytes,
                      const std::function<void(TreeHead&, NodeRecord*)>& change) {
  TreeHead head;
  std::memcpy(&head, bytes.data(), sizeof head);
  std::vector<NodeRecord> table(head.nodes);
  const uint64_t table_at = head.table_at;
  std::memcpy(table.data(), bytes.data() + table_at, table.size() * sizeof(NodeRecord));
  change(head, table.data());
  std::memcpy(bytes.data() + table_at, table.data(), table.size() * sizeof(NodeRecord));
  head.table_sum = crc_of(bytes, size_t(table_at), bytes.size());
  std::memcpy(bytes.data(), &head, sizeof head);
  head.head_sum = crc_of(bytes, 0, offsetof(TreeHead, head_sum));
  std::memcpy(bytes.data(), &head, sizeof head);
  return bytes;
}

float linear_of(uint32_t color, int channel) {
  return image::decode_srgb(uint8_t(color >> (8 * channel)));
}

}  // namespace

TEST(PointTree, damaged_files_are_refused_by_file_and_place) {
  const Folder folder;
  write_tree({made_source(made_house(5000, {9, 4, 7}), house_info())}, folder.file("a.points"),
             plain_settings());
  const std::string good = folder.read("a.points");
  const auto reason = [&](const std::string& bytes) -> std::string {
    const std::string path = folder.write("bad.points", bytes);
    try {
      open_tree(path);
    } catch (const LoadError& error) {
      EXPECT_EQ(error.file, path);
      EXPECT_TRUE(error.where.starts_with("byte ")) << error.where;
      return error.what_;
    }
    return "";
  };
  const auto changed = [&](const std::function<void(TreeHead&, NodeRecord*)>& change) {
    return reason(with_sums(good, change));
  };
  EXPECT_EQ(changed([](TreeHead&, NodeRecord*) {}), "");
  EXPECT_NE(reason(good.substr(0, 50)).find("too short"), std::string::npos);
  EXPECT_NE(reason(good.substr(0, good.size() - 1)).find("its head says"), std::string::npos);
  EXPECT_NE(reason("x" + good.substr(1)).find("is no tree of points"), std::string::npos);
  std::string earlier = good;
  earlier[7] = '1';
  EXPECT_EQ(reason(earlier), "is a tree of points of another version: import its files again");
  EXPECT_NE(changed([](TreeHead& head, NodeRecord*) { head.frame[4] = 1.1; }).find("no rotation"),
            std::string::npos);
  std::string flipped = good;
  flipped[20] ^= 1;
  EXPECT_NE(reason(flipped).find("head is damaged"), std::string::npos);
  flipped = good, flipped[flipped.size() - 30] ^= 1;
  EXPECT_NE(reason(flipped).find("table of nodes is damaged"), std::string::npos);
  EXPECT_NE(changed([](TreeHead& head, NodeRecord*) { head.nodes = 0xffffffff; }).find("outside"),
            std::string::npos);
  EXPECT_NE(changed([](TreeHead& head, NodeRecord*) {
              head.table_at = ~uint64_t(0) - 8;
            }).find("outside"),
            std::string::npos);
  EXPECT_NE(changed([](TreeHead& head, NodeRecord*) { head.points++; }).find("the head says"),
            std::string::npos);
  EXPECT_NE(changed([](TreeHead& head, NodeRecord*) { head.edge = 3; }).find("power of two"),
            std::string::npos);
  // A node that is its own child, one that lies elsewhere, and one with too many points.
  EXPECT_NE(
      changed([](TreeHead&, NodeRecord* table) { table[0].first_child = 0; }).find("elsewhere"),
      std::string::npos);
  EXPECT_NE(changed([](TreeHead&, NodeRecord* table) { table[1].cell[0] ^= 1; }).find("octant"),
            std::string::npos);
  EXPECT_NE(changed([](TreeHead&, NodeRecord* table) {
              table[1].offset = table[2].offset;
            }).find("overlaps"),
            std::string::npos);
  EXPECT_NE(changed([](TreeHead&, NodeRecord* table) { table[1].count = 0xfffffff0; }), "");
  EXPECT_NE(changed([](TreeHead& head, NodeRecord* table) {
              table[0].offset = round_up(head.table_at, 64);
            }).find("beyond"),
            std::string::npos);
  EXPECT_NE(changed([](TreeHead&, NodeRecord* table) { table[2].spacing = NAN; }).find("spacing"),
            std::string::npos);
  EXPECT_NE(changed([](TreeHead& head, NodeRecord* table) {
              table[head.nodes - 1].beneath++;
            }).find("points"),
            std::string::npos);
  EXPECT_NE(changed([](TreeHead& head, NodeRecord*) { head.stations = 5; }).find("station"),
            std::string::npos);
  EXPECT_THROW(open_tree(folder.file("none.points")), LoadError);
}

TEST(PointTree, inner_nodes_are_means_of_all_points_in_voxels) {
  const PointBlock house = made_house(40000, {9, 4, 7});
  TreeSettings settings = plain_settings();
  const PointTree tree = make_tree(made_source(house, house_info()), settings);
  for (uint32_t number = 0; number < tree.nodes.size(); number += 7) {
    const TreeNode& node = tree.nodes[number];
    if (node.is_leaf()) continue;
    struct Sum {
      double weight = 0;
      dvec3 place{0}, color{0};
    };
    std::map<std::array<int, 3>, Sum> voxels;
    const auto voxel = [&](dvec3 place) {
      const glm::ivec3 at((place - node.corner) / (double(node.size) / 128));
      return std::array{at.x, at.y, at.z};
    };
    const std::vector<FoundPoint> all = leaf_points(tree, number);
    EXPECT_EQ(all.size(), node.beneath);
    for (const FoundPoint& point : all) {
      Sum& sum = voxels[voxel(point.place)];
      sum.weight++, sum.place += point.place;
      sum.color +=
          dvec3(linear_of(point.color, 0), linear_of(point.color, 1), linear_of(point.color, 2));
    }
    const NodePoints means = tree.points_of(number);
    ASSERT_EQ(means.count, voxels.size());
    for (uint32_t i = 0; i < means.count; i++) {
      const Sum& sum = voxels[voxel(place_of(means, i))];
      ASSERT_GT(sum.weight, 0);
      EXPECT_LT(glm::length(sum.place / sum.weight - place_of(means, i)), 2 * node.size / 65536);
      for (int channel = 0; channel < 3; channel++) {
        // A code's step is at most 0.0091 wide.
        const double mean = sum.color[channel] / sum.weight;
        EXPECT_NEAR(mean, double(linear_of(means.color[i], channel)), 0.006);
      }
    }
  }
}

TEST(PointTree, normals_of_a_plane_are_found_and_look_at_the_station) {
  Rng rng(5);
  PointBlock block;
  for (int i = 0; i < 20000; i++) {
    const double u = rng.uniform(), v = rng.uniform();
    block.place.push_back({4 * u, 4 * v, 2 * u});
  }
  ScanInfo info;
  const auto least_along = [&](const PointTree& tree, vec3 expected, uint32_t node) {
    float least = 1;
    const NodePoints points = tree.points_of(node);
    for (uint32_t i = 0; i < points.count; i++)
      least = std::min(least, glm::dot(decode_octahedral(points.normal[i]), expected));
    return least;
  };
  const vec3 normal = glm::normalize(vec3(-1, 0, 2));
  for (const double side : {1.0, -1.0}) {
    info.stations = {{"here", dvec3(2, 2, 1) + side * 5.0 * dvec3(normal)}};
    const PointTree tree = make_tree(made_source(block, info), plain_settings(2000));
    ASSERT_EQ(tree.stations.size(), 1u);
    for (uint32_t i = 0; i < tree.nodes.size(); i++)
      EXPECT_GT(least_along(tree, float(side) * normal, i), tree.nodes[i].is_leaf() ? 0.998 : 0.99);
  }
}

TEST(PointTree, spacing_is_that_of_a_surface_on_a_grid_or_at_random) {
  PointBlock grid, random;
  Rng rng(7);
  for (int i = 0; i < 40000; i++) {
    grid.place.push_back({0.01 * (i % 200), 0.3, 0.01 * (i / 200)});
    random.place.push_back({2.0 * rng.uniform(), 0.3, 2.0 * rng.uniform()});
  }
  for (const PointBlock& block : {grid, random}) {
    const PointTree tree = make_tree(made_source(block), plain_settings(5000));
    for (const TreeNode& node : tree.nodes) {
      if (node.is_leaf() && node.count > 1000) {
        EXPECT_NEAR(node.spacing, 0.01, 0.0015);
      }
    }
  }
}

TEST(Octahedral, a_direction_comes_back_and_zero_is_none) {
  Rng rng(9);
  for (int i = 0; i < 1000; i++) {
    const vec3 n = glm::normalize(vec3(rng.uniform(), rng.uniform(), rng.uniform()) - 0.5f);
    const uint16_t code = encode_octahedral(n);
    EXPECT_NE(code, no_normal);
    EXPECT_GT(glm::dot(decode_octahedral(code), n), 0.9998f);
  }
  EXPECT_EQ(encode_octahedral(vec3(0)), no_normal);
  EXPECT_EQ(encode_octahedral(vec3(NAN, 0, 1)), no_normal);
  EXPECT_EQ(decode_octahedral(no_normal), vec3(0));
}

}  // namespace wellspring::test
