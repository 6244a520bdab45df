// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <vector>

#include "base/rng.h"
#include "scan/tree/particle_tree.h"

namespace wellspring::test {
using namespace wellspring::scan;
namespace {

// Fills a box with spheres that overlap so far that no line passes through a cell in its inside,
// wherever cells are split.
void add_solid(std::vector<Sphere>& spheres, vec3 low, glm::ivec3 count, float step) {
  for (int z = 0; z < count.z; z++)
    for (int y = 0; y < count.y; y++)
      for (int x = 0; x < count.x; x++)
        spheres.push_back({low + step * vec3(x, y, z), 1.8f * step});
}

bool is_hit(const Sphere& sphere, vec3 from, vec3 to) {
  const vec3 along = to - from;
  const float t =
      glm::clamp(glm::dot(sphere.place - from, along) / glm::dot(along, along), 0.0f, 1.0f);
  return glm::length(from + t * along - sphere.place) < sphere.radius;
}

std::vector<Sphere> two_blocks() {
  std::vector<Sphere> spheres;
  add_solid(spheres, {-1.5f, -1.5f, 0}, {24, 24, 10}, 0.125f);
  // Far behind, in the shadow of one cell.
  add_solid(spheres, {0.2f, 0.2f, -30}, {6, 6, 6}, 0.125f);
  return spheres;
}

}  // namespace

TEST(ParticleTree, splits_off_free_space_first) {
  std::vector<Sphere> spheres;
  add_solid(spheres, {0, 0, 0}, {4, 4, 4}, 0.25f);
  add_solid(spheres, {9, 0, 0}, {4, 4, 4}, 0.25f);
  const ParticleTree tree(spheres, {.depth = 6, .lines = 200});
  // The gap along x is met when the middle is tried, so it is the root's split already.
  const ParticleNode& root = tree.nodes()[0];
  ASSERT_NE(root.child, 0u);
  const ParticleNode& lower = tree.nodes()[root.child];
  EXPECT_EQ(lower.count, 64u);
  EXPECT_GE(lower.box.high.x, 0.75f + 0.4499f);
  EXPECT_LE(lower.box.high.x, 9 - 0.4499f);
  uint32_t leaves = 0;
  for (const ParticleNode& node : tree.nodes()) {
    EXPECT_LE(node.opacity, node.most_opacity);
    if (node.child == 0) leaves += node.count;
  }
  EXPECT_EQ(leaves, spheres.size());
}

TEST(ParticleTree, culls_what_is_behind_and_no_more) {
  const std::vector<Sphere> spheres = two_blocks();
  const ParticleTree tree(spheres, {.depth = 9, .lines = 300});
  const vec3 eye(0.1f, 0.2f, 6);
  const std::vector<ParticleState> states = tree.cull(dvec3(eye), 1);
  size_t culled = 0, seen = 0, mixed = 0;
  Rng rng(3);
  for (size_t i = 0; i < tree.nodes().size(); i++) {
    const ParticleNode& node = tree.nodes()[i];
    if (node.child != 0) {
      // A node is visible, or occluded, as a whole only if both of its children are.
      if (tree.nodes()[node.child].count == 0 || tree.nodes()[node.child + 1].count == 0) continue;
      const bool same = states[node.child] == states[node.child + 1];
      if (same) {
        EXPECT_EQ(states[i], states[node.child]);
      } else {
        mixed++;
      }
      continue;
    }
    EXPECT_NE(states[i], ParticleState::partial);
    if (states[i] != ParticleState::occluded) continue;
    for (uint32_t k = node.first; k < node.first + node.count; k++) {
      culled++;
      const Sphere& sphere = spheres[tree.order()[k]];
      for (int sample = 0; sample < 4; sample++) {
        const vec3 to_eye = glm::normalize(eye - sphere.place);
        vec3 out(rng.uniform() - 0.5f, rng.uniform() - 0.5f, rng.uniform() - 0.5f);
        out = glm::normalize(out);
        if (glm::dot(out, to_eye) < 0) out = -out;
        const vec3 place = sphere.place + 1.001f * sphere.radius * out;
        bool is_hidden = false;
        for (const Sphere& other : spheres) is_hidden = is_hidden || is_hit(other, eye, place);
        seen += !is_hidden;
      }
    }
  }
  EXPECT_GE(culled, 216u);
  EXPECT_EQ(seen, 0u);
  EXPECT_GT(mixed, 0u);
  // At a lower threshold more is culled.
  size_t more = 0;
  const std::vector<ParticleState> bolder = tree.cull(dvec3(eye), 0.9f);
  for (size_t i = 0; i < tree.nodes().size(); i++) {
    const bool is_culled = bolder[i] == ParticleState::occluded;
    if (tree.nodes()[i].child == 0 && is_culled) more += tree.nodes()[i].count;
  }
  EXPECT_GE(more, culled);
}

}  // namespace wellspring::test
