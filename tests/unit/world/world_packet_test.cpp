// SPDX-License-Identifier: Apache-2.0
// Rays side by side say what each of them says alone.
#include <gtest/gtest.h>

#include <cmath>

#include "base/rng.h"
#include "scenes/scenes.h"
#include "world/world.h"

namespace wellspring::test {
namespace {

using namespace scenes;

// Rays within the box; every 50th round one of them is not a number.
RayPacket make_rays(Rng& rng, int round, Ray (&rays)[RayPacket::lanes]) {
  RayPacket packet{};
  for (int i = 0; i < RayPacket::lanes; i++) {
    auto inside = [&] {
      return vec3(0.54f * rng.uniform() - 0.27f, 0.54f * rng.uniform(), -0.55f * rng.uniform());
    };
    rays[i].origin = inside();
    rays[i].direction = inside() - rays[i].origin;
    rays[i].t_max = round % 2 ? 1.0f : std::numeric_limits<float>::infinity();
    if (round % 50 == 0 && i == 3) rays[i].direction.x = std::nanf("");
    packet.origin_x[i] = rays[i].origin.x, packet.origin_y[i] = rays[i].origin.y;
    packet.origin_z[i] = rays[i].origin.z, packet.direction_x[i] = rays[i].direction.x;
    packet.direction_y[i] = rays[i].direction.y, packet.direction_z[i] = rays[i].direction.z;
    packet.t_max[i] = rays[i].t_max;
  }
  return packet;
}

TEST(RayPacket, AnswersAreThoseOfSingleRays) {
  Scene scene = make_cornell_box();
  Material leaf = diffuse(vec3(0.5f));
  leaf.alpha_mode = AlphaMode::blend;
  leaf.base_color.w = 0.5f;
  add_quad(scene, leaf, {-0.2f, 0.3f, -0.4f}, {0.4f, 0, 0}, {0, 0, 0.3f});
  int moving = add_material(scene, diffuse(vec3(0.5f)));
  scene.objects.push_back("ball");
  Mesh ball = sphere_mesh(moving, 0.1f, 12);
  for (vec3& p : ball.positions) p += vec3(0, 0.2f, -0.2f);
  World world(scene, {ball}, {uint32_t(scene.objects.size() - 1)});
  Rng rng(11);
  int blocked_rays = 0, clear_rays = 0, moving_hits = 0;
  for (int round = 0; round < 4000; round++) {
    Ray rays[RayPacket::lanes];
    uint32_t active = round % 3 == 0   ? rng.next() & 0xffff
                      : round % 3 == 1 ? 1u << round % 16
                                       : 0xffffu;
    RayPacket packet = make_rays(rng, round, rays);
    uint32_t blocked = world.occluded_packet(packet, active);
    EXPECT_EQ(world.occluded_each(packet, active), blocked) << round;
    Hit hits[RayPacket::lanes];
    hits[5].triangle = 77;
    uint64_t before = rays_traced();
    world.intersect_each(packet, active, hits);
    uint64_t counted = rays_traced() - before;
    for (int i = 0; i < RayPacket::lanes; i++) {
      if (!(active >> i & 1)) continue;
      Hit alone = world.intersect(rays[i]);
      ASSERT_EQ(hits[i].instance, alone.instance) << round << ", lane " << i;
      ASSERT_EQ(hits[i].triangle, alone.triangle);
      ASSERT_EQ(hits[i].t, alone.t);
      ASSERT_EQ(hits[i].barycentric, alone.barycentric);
      moving_hits += alone.valid() && world.is_moving(alone.instance);
    }
    EXPECT_EQ(rays_traced() - before, 2 * counted);
    if (!(active >> 5 & 1)) {
      EXPECT_EQ(hits[5].triangle, 77u);
    }
    for (int i = 0; i < RayPacket::lanes; i++) {
      bool expected = (active >> i & 1) && world.occluded(rays[i]);
      ASSERT_EQ(bool(blocked >> i & 1), expected) << round << ", lane " << i;
      (expected ? blocked_rays : clear_rays)++;
    }
  }
  EXPECT_GT(blocked_rays, 5000);
  EXPECT_GT(clear_rays, 5000);
  EXPECT_GT(moving_hits, 1000);
}

}  // namespace
}  // namespace wellspring::test
