// SPDX-License-Identifier: Apache-2.0
// Rays meet the volumes that stand in a world, and are stopped by them.
#include <gtest/gtest.h>

#include <cmath>

#include "base/rng.h"
#include "scenes/scenes.h"
#include "unit/volume/draw_made.h"
#include "world/world.h"
#include "world/world_packet.h"

namespace wellspring::test {
namespace {

using namespace scenes;

std::shared_ptr<const ShownVolume> shared(Volume volume) {
  return std::make_shared<const ShownVolume>(make_shown_volume(std::move(volume)));
}
std::shared_ptr<const DrawnPreset> drawn(const PlacedVolume& placed, const Preset& preset) {
  return std::make_shared<const DrawnPreset>(*placed.volume, preset, VolumeLight());
}
Preset even(double thickness, vec3 color = vec3(1)) {
  return {"even", VolumeMode::density, {{0.0, color, thickness / 40}}};
}

// A cube of 40 mm, a metre wide in the scene, through which exp(-thickness) of the light comes.
PlacedVolume cube(double thickness, vec3 position = vec3(0), vec3 color = vec3(1)) {
  PlacedVolume placed;
  placed.volume = shared(made_volume({40, 40, 40}, [](glm::vec3) { return 1.0f; }));
  placed.position = position, placed.scale = 25;
  placed.look.preset = drawn(placed, even(thickness, color));
  return placed;
}

// Rays upwards through the cube's middle, each a little beside the others, to 10 m.
Ray ray_up(int i, Rng& random) {
  return {.origin = {0.8f * random.uniform() - 0.4f, -5, 0.8f * random.uniform() - 0.4f},
          .direction = {0, i % 2 ? 10.0f : 1.0f, 0},
          .t_max = i % 2 ? 1.0f : 10.0f};
}

struct Share {
  double passed = 0, count = 0;
  void expect(double expected, const char* what) const {
    EXPECT_NEAR(passed / count, expected, 3 * std::sqrt(expected * (1 - expected) / count) + 1e-9)
        << what;
  }
};
Share share_of(const World& world, int count = 40000) {
  Share share;
  Rng random(9);
  for (int i = 0; i < count; i++, share.count++) share.passed += !world.occluded(ray_up(i, random));
  return share;
}

TEST(WorldVolumes, AVolumeShadesByWhatItLetsThrough) {
  Scene scene = empty_scene();
  World world(scene);
  EXPECT_EQ(share_of(world).passed, 40000);
  world.place_volumes({cube(0.8)});
  share_of(world).expect(std::exp(-0.8), "one");
  world.place_volumes({cube(0.8), cube(0.5, {0, 0.3f, 0})});
  share_of(world).expect(std::exp(-1.3), "two that overlap");
  VolumeLook mixed = world.volumes()[0].look;
  mixed.over = drawn(world.volumes()[0], even(2)), mixed.share = 0.25f;
  world.show_volume(0, mixed);
  share_of(world).expect((0.75 * std::exp(-0.8) + 0.25 * std::exp(-2.0)) * std::exp(-0.5), "mixed");
  mixed.cuts = {{{0, 1, 0}, 0}};
  world.show_volume(0, mixed);
  share_of(world).expect((0.75 * std::exp(-0.4) + 0.25 * std::exp(-1.0)) * std::exp(-0.5), "cut");
  world.show_volume(0, {});
  share_of(world).expect(std::exp(-0.5), "one that shows nothing");
  world.show_volume(1, {});
  EXPECT_EQ(share_of(world).passed, 40000);
}

TEST(WorldVolumes, TheLargestValueOfARayCastsNoShadow) {
  Scene scene = empty_scene();
  World world(scene);
  world.place_volumes({cube(1)});
  VolumeLook look;
  look.preset = drawn(world.volumes()[0], {"most", VolumeMode::maximum, {{0.0, vec3(0.5f), 1.0}}});
  world.show_volume(0, look);
  EXPECT_EQ(share_of(world).passed, 40000);
  Rng random(2);
  for (int i = 0; i < 100; i++) {
    const Ray ray = ray_up(i, random);
    EXPECT_TRUE(world.meet_volume(ray, ray.t_max, true));
    EXPECT_FALSE(world.meet_volume(ray, ray.t_max, false));
  }
}

TEST(WorldVolumes, AllQuestionsAgreeAboutARay) {
  Scene scene = empty_scene();
  const Material pane = glass(1.5f, 0, 0);
  add_quad(scene, pane, {-1, -2, 1}, {2, 0, 0}, {0, 0, -2}, "pane");
  World with_pane(scene);
  Scene nothing = empty_scene();
  World open(nothing);
  open.place_volumes({cube(0.8), cube(0.5, {0, 0.3f, 0})});
  with_pane.place_volumes({cube(0.8), cube(0.5, {0, 0.3f, 0})});
  Rng random(4);
  int blocked_rays = 0;
  for (int round = 0; round < 500; round++) {
    RayPacket packet{};
    Ray rays[RayPacket::lanes];
    for (int i = 0; i < RayPacket::lanes; i++) {
      rays[i] = ray_up(i, random);
      set_ray(rays[i], i, packet);
    }
    const uint32_t active = round % 2 ? 0xffffu : random.next() & 0xffff,
                   blocked = open.occluded_packet(packet, active);
    EXPECT_EQ(open.occluded_each(packet, active), blocked);
    EXPECT_EQ(blocked & ~active, 0u);
    for (int i = 0; i < RayPacket::lanes; i++) {
      if (!(active >> i & 1)) continue;
      const bool alone = open.occluded(rays[i]);
      EXPECT_EQ(alone, (blocked >> i & 1) != 0);
      EXPECT_EQ(alone, open.meet_volume(rays[i], rays[i].t_max, false).has_value());
      PanesPassed panes;
      EXPECT_EQ(alone, with_pane.occluded(rays[i], panes));
      EXPECT_FALSE(panes.more);
      blocked_rays += alone;
    }
  }
  EXPECT_GT(blocked_rays, 1000);
}

// The mean over rays of one way, a hair apart, is the light that marches along it.
void expect_marched(const World& world, const Ray& along, float apart, const char* what) {
  const PlacedVolume& placed = world.volumes()[0];
  const ToVolume to_volume(placed);
  VolumeRays rays;
  rays.origin = all_lanes(to_volume.place(along.origin));
  rays.direction = all_lanes(to_volume.way(along.direction));
  rays.far = all_lanes(100);
  const MarchedLight marched =
      march(*placed.volume, *placed.look.preset, rays, {.step = 0.05f, .cuts = placed.look.cuts});
  constexpr int count = 150000;
  glm::dvec3 color(0);
  int stopped = 0;
  Rng random(6);
  for (int i = 0; i < count; i++) {
    Ray ray = along;
    ray.origin += apart * (random.uniform() - 0.5f) * vec3(1, 1, 0);
    ray.direction.x += 1e-5f * (random.uniform() - 0.5f);
    ray.direction.y += 1e-5f * (random.uniform() - 0.5f);
    const std::optional<VolumeHit> met =
        world.meet_volume(ray, std::numeric_limits<float>::infinity(), true);
    if (!met) continue;
    stopped++;
    color += glm::dvec3(met->color) / double(count);
    EXPECT_EQ(met->object, placed.object);
  }
  EXPECT_NEAR(1 - double(stopped) / count, double(marched.clear[0]), 0.01) << what;
  for (int c = 0; c < 3; c++)
    EXPECT_NEAR(color[c] / double(marched.color.at(0)[c]), 1, 0.01) << what << c;
}

TEST(WorldVolumes, AVolumeIsSeenTurnedAndScaledAndFarAway) {
  Scene scene = empty_scene();
  World world(scene);
  PlacedVolume placed;
  placed.volume = shared(made_volume({52, 48, 44}, [](glm::vec3 p) {
    return ball_of(p - glm::vec3(3, 2, -4), 16) * (1 + 0.2f * p.x / 16);
  }));
  placed.look.preset =
      drawn(placed,
            {"mist", VolumeMode::density, {{0.1, vec3(1), 0.0}, {1.2, vec3(1, 0.5f, 0.2f), 0.09}}});
  placed.object = 7;
  const vec3 way = normalize(vec3(0.02f, -0.03f, -1));
  world.place_volumes({placed});
  const Ray near{.origin = vec3(-0.003f, 0.002f, 0.004f) - 0.5f * way, .direction = way};
  expect_marched(world, near, 1e-5f, "as it is");
  placed.scale = 120, placed.yaw = 2, placed.look.turn = -0.7f;
  placed.position = vec3(1e5f, -2e5f, 1e5f);
  placed.look.cuts = {{normalize(vec3(1, 0.2f, 0)), -0.004f}};
  world.place_volumes({placed});
  const Ray far{.origin = placed.position + vec3(0.5f, 0.25f, 6), .direction = way};
  expect_marched(world, far, 0.03f, "far away");
}

TEST(WorldVolumes, TheNearerOfTwoIsMet) {
  Scene scene = empty_scene();
  World world(scene);
  PlacedVolume low = cube(50, {0, -1, 0}), high = cube(50, {0, 1, 0});
  low.object = 1, high.object = 2;
  for (const bool turned : {false, true}) {
    world.place_volumes(turned ? std::vector{high, low} : std::vector{low, high});
    const Ray up{.origin = {0.1f, -5, 0.1f}, .direction = {0, 1, 0}},
        down{.origin = {0.1f, 5, 0.1f}, .direction = {0, -1, 0}};
    EXPECT_EQ(world.meet_volume(up, 20, true).value().object, 1u);
    EXPECT_EQ(world.meet_volume(down, 20, true).value().object, 2u);
    EXPECT_NEAR(world.meet_volume(up, 20, true).value().t, 3.6f, 0.11f);
    EXPECT_FALSE(world.meet_volume(up, 3.49f, true));
  }
}

}  // namespace
}  // namespace wellspring::test
