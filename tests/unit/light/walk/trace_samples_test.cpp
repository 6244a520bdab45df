// SPDX-License-Identifier: Apache-2.0
// Samples traced side by side: each the same as alone, bit for bit, and the same light as by the
// way that knows all materials.
#include <gtest/gtest.h>

#include <cstring>

#include "light/random/sampler.h"
#include "light/technique/technique.h"
#include "light/walk/walk.h"
#include "scenes/scenes.h"
#include "unit/light/statistics.h"
#include "world/surface.h"

namespace wellspring::test {
namespace {

using namespace scenes;

struct Lighting {
  const char* name;
  bool emitter = false, sky = false, pane = false;
  std::vector<PunctualLight> lamps = {};
};

std::vector<Lighting> lightings() {
  PunctualLight point, spot, sun;
  point.position = {0.05f, 0.5f, -0.2f};
  point.intensity = {0.3f, 0.25f, 0.2f};
  point.range = 1;
  spot = point;
  spot.type = PunctualType::spot;
  spot.range = std::numeric_limits<float>::infinity();
  spot.direction = normalize(vec3(-0.2f, -1, 0.1f));
  spot.inner_cone = 0.3f, spot.outer_cone = 0.9f;
  sun.type = PunctualType::directional;
  sun.direction = normalize(vec3(0.3f, -0.6f, -1));
  sun.intensity = vec3(2);
  std::vector<Lighting> all(8);
  all[0] = {.name = "point", .lamps = {point}};
  all[1] = {.name = "spot", .lamps = {spot}};
  all[2] = {.name = "sun", .lamps = {sun}};
  all[3] = {.name = "point behind a pane", .pane = true, .lamps = {point}};
  all[4] = {.name = "three lamps", .lamps = {point, spot, sun}};
  all[5] = {.name = "emitter", .emitter = true};
  all[6] = {.name = "emitter and point", .emitter = true, .lamps = {point}};
  all[7] = {.name = "point and sky", .sky = true, .lamps = {point}};
  return all;
}

// The Cornell box with balls: smooth normals, textured, glossy, glass.
Scene make_room(const Lighting& lighting) {
  Scene scene = make_cornell_box();
  for (Material& m : scene.materials)
    if (m.emission != vec3(0) && !lighting.emitter) m = diffuse(vec3(0.5f));
  Image image{.width = 2, .height = 2};
  for (int i = 0; i < 16; i++) image.texels8.push_back(uint8_t(40 + 13 * i));
  scene.images = {image};
  scene.textures.resize(1);
  scene.textures[0].image = 0;
  Material painted = diffuse(vec3(0.9f));
  painted.base_color_texture.texture = 0;
  add_sphere(scene, painted, 0.08f, "painted", at({-0.15f, 0.08f, -0.1f}), 16);
  add_sphere(scene, plastic({0.3f, 0.5f, 0.7f}, 0.3f), 0.06f, "glossy", at({0.09f, 0.23f, -0.17f}));
  add_sphere(scene, glass(1.5f, 0, 1), 0.05f, "glass", at({0.15f, 0.06f, -0.02f}));
  if (lighting.pane)
    add_quad(scene, glass(1.5f, 0, 0), {-0.2f, 0.4f, -0.4f}, {0, 0, 0.4f}, {0.4f, 0, 0}, "pane");
  if (lighting.sky) scene.environment.radiance = {0.4f, 0.5f, 0.7f};
  scene.lights = lighting.lamps;
  return scene;
}

struct Room {
  Scene scene;
  World world;
  Lights lights;
  std::vector<Request> requests;
  explicit Room(const Lighting& lighting)
      : scene(make_room(lighting)), world(scene, {moving_ball()}), lights(make_lights(world)) {
    View view = cornell_view(scene, 48, 40);
    for (int i = 0; i < 2 * 48 * 40; i++)
      requests.push_back(pixel_request(view, 3, i / 2 % 48, i / 96, i % 2));
  }
  Mesh moving_ball() {
    Mesh ball = sphere_mesh(1, 0.07f, 16);
    for (vec3& p : ball.positions) p += vec3(0, 0.42f, -0.3f);
    return ball;
  }
};

TEST(TraceSamples, EachIsTheSameAloneAndAmongOthers) {
  for (const Lighting& lighting : lightings()) {
    Room room(lighting);
    for (const char* name : {"path", "direct", "gather"}) {
      const Technique& technique = *find_technique(name);
      if (technique.prepare) {
        if (lighting.lamps.size() != 1 || !lighting.emitter) continue;  // once is enough
        vec3 place(0, 0.27f, -0.1f);
        technique.prepare(room.world, std::span(&place, 1), room.lights);
      }
      std::vector<Sample> samples(room.requests.size());
      trace(technique, room.world, room.lights, {}, room.requests, samples);
      for (size_t i = 0; i < samples.size(); i += 3) {
        Sample alone = technique.trace(room.world, room.lights, {}, room.requests[i]);
        ASSERT_EQ(alone.albedo, samples[i].albedo) << lighting.name << ", " << name;
        ASSERT_EQ(alone.smooth, samples[i].smooth) << lighting.name << ", " << name;
        ASSERT_EQ(alone.rest, samples[i].rest) << lighting.name << ", " << name;
        ASSERT_EQ(alone.position, samples[i].position);
        ASSERT_EQ(alone.normal, samples[i].normal);
        ASSERT_EQ(alone.triangle, samples[i].triangle);
        ASSERT_EQ(alone.flags, samples[i].flags);
      }
    }
    EXPECT_EQ(room.lights.bad_samples->load(), 0u);
  }
}

// Rays that begin or end elsewhere than at the eye and at infinity see what they meet in between.
TEST(TraceSamples, RaysHaveTheirOwnBeginningsAndEnds) {
  Room room(lightings()[0]);
  for (size_t i = 0; i < room.requests.size(); i++) {
    Ray& ray = room.requests[i].ray;
    if (i % 3 == 1) ray.t_min = 1;
    if (i % 3 == 2) ray.t_max = 1;
  }
  const Technique& path = *find_technique("path");
  std::vector<Sample> samples(room.requests.size());
  trace(path, room.world, room.lights, {}, room.requests, samples);
  int behind = 0, before = 0, beyond = 0;
  for (size_t i = 0; i < samples.size(); i++) {
    Hit hit = room.world.intersect(room.requests[i].ray);
    ASSERT_EQ(bool(samples[i].flags & sample_hit), hit.valid());
    behind += hit.valid() && i % 3 == 1, before += hit.valid() && i % 3 == 2;
    beyond += !hit.valid() && i % 3 == 2;
    if (!hit.valid() || (samples[i].flags & sample_specular)) continue;
    ASSERT_EQ(samples[i].instance, hit.instance);
    ASSERT_EQ(samples[i].triangle, hit.triangle);
    ASSERT_EQ(samples[i].distance, hit.t);
  }
  EXPECT_GT(behind, 100);
  EXPECT_GT(before, 100);
  EXPECT_GT(beyond, 100);
}

// The same numbers lead the same ways, so that but for rounding each sample is the same; few take
// another turn because of it, and those must not favour brighter or darker ways.
TEST(TraceSamples, LanesSayWhatTheLongWaySays) {
  for (const Lighting& lighting : lightings()) {
    Room room(lighting);
    for (int scatterings : {1, 1 << 30}) {
      WalkRules rules{.scatterings = scatterings};
      Transport transport{room.world, *room.lights.tables};
      ASSERT_TRUE(transport.tables.any_lambertian);
      std::vector<Sample> samples(room.requests.size());
      trace_samples(transport, rules, room.requests, samples);
      size_t strays = 0;
      Mean off;
      for (size_t i = 0; i < samples.size(); i++) {
        Sample one = trace_sample(transport, rules, room.requests[i]);
        ASSERT_EQ(one.triangle, samples[i].triangle) << lighting.name;
        ASSERT_EQ(one.flags, samples[i].flags) << lighting.name;
        ASSERT_LE(length(one.albedo - samples[i].albedo), 1e-5f) << lighting.name;
        vec3 a = one.radiance(), b = samples[i].radiance();
        float difference = length(a - b);
        off.add(double(luminance(b) - luminance(a)));
        strays += !(difference <= 1e-3f * length(a) + 1e-5f);
        if (difference <= 1e-3f * length(a) + 1e-5f) {
          EXPECT_LE(length(one.smooth - samples[i].smooth), 1e-3f * length(one.smooth) + 1e-5f);
        }
      }
      EXPECT_LE(strays, samples.size() / 50) << lighting.name;
      EXPECT_LE(std::abs(off.mean()), significance_z * off.error() + 1e-6) << lighting.name;
    }
  }
}

TEST(TraceSamples, DepthsAreCountedTheSame) {
  Room room(lightings()[6]);
  Transport transport{room.world, *room.lights.tables};
  for (int depth : {0, 1, 2, 3}) {
    WalkRules rules{.max_depth = depth};
    std::vector<Sample> samples(room.requests.size());
    trace_samples(transport, rules, room.requests, samples);
    Mean off;
    for (size_t i = 0; i < samples.size(); i++) {
      Sample one = trace_sample(transport, rules, room.requests[i]);
      ASSERT_EQ(one.flags, samples[i].flags);
      off.add(double(luminance(samples[i].radiance()) - luminance(one.radiance())));
    }
    EXPECT_LE(std::abs(off.mean()), significance_z * off.error() + 1e-6) << depth;
  }
}

TEST(SamplerLanes, DrawTheSamplersNumbers) {
  Rng rng(4);
  for (int round = 0; round < 500; round++) {
    SamplerLanes lanes;
    LaneBits dimension{};
    Sampler one[lane_count] = {Sampler(0), Sampler(0), Sampler(0), Sampler(0),
                               Sampler(0), Sampler(0), Sampler(0), Sampler(0)};
    for (int i = 0; i < lane_count; i++) {
      one[i] = Sampler(uint64_t(rng.next()) << 32 | rng.next(), rng.next() >> (round % 32));
      lanes.set(i, one[i]);
      dimension[i] = rng.next() >> (round % 29);
    }
    Lanes x, y, single = lanes.number(dimension);
    lanes.pair(dimension, x, y);
    for (int i = 0; i < lane_count; i++) {
      Sampler pair = lanes.at(i);
      one[i].seek(dimension[i]);
      pair.seek(dimension[i]);
      ASSERT_EQ(one[i].next(), single[i]);
      ASSERT_EQ(pair.next2(), vec2(x[i], y[i]));
    }
  }
}

TEST(SurfaceLanes, ArePlacesAndOriginsOfTheSameSurfaces) {
  Room room(lightings()[0]);
  Rng rng(8);
  int compared = 0, bent = 0, moving = 0;
  for (int round = 0; round < 3000; round++) {
    Hit hits[lane_count];
    Ray rays[lane_count];
    Lanes3 direction, away;
    unsigned active = 0;
    for (int i = 0; i < lane_count; i++) {
      auto inside = [&] {
        float x = rng.uniform(), y = rng.uniform(), z = rng.uniform();
        return vec3(0.56f * x - 0.28f, 0.55f * y, -0.56f * z);
      };
      rays[i].origin = inside();
      rays[i].direction = normalize(inside() - rays[i].origin);
      direction.set(i, rays[i].direction);
      away.set(i, normalize(inside()));
      hits[i] = room.world.intersect(rays[i]);
      bool lambertian = hits[i].valid() && is_lambertian(room.world.material_of(hits[i].instance));
      active |= unsigned(lambertian) << i;
    }
    LambertSurfaceLanes lanes = eval_lambert_surfaces(room.world, direction, hits, active);
    Lanes3 origin = offset_origins(lanes, away);
    bent += std::popcount(lanes.bent);
    for (int i = 0; i < lane_count; i++) {
      if (!(active >> i & 1)) continue;
      LambertSurface one = eval_lambert_surface(room.world, rays[i], hits[i]);
      compared++;
      moving += room.world.is_moving(hits[i].instance);
      EXPECT_LE(length(lanes.position.at(i) - one.position), 1e-7f);
      EXPECT_EQ(lanes.geometric_normal.at(i), one.geometric_normal);
      EXPECT_LE(length(lanes.normal.at(i) - one.normal), 1e-6f);
      EXPECT_EQ(lanes.base_color.at(i), one.base_color);
      EXPECT_EQ(lanes.extent[i], one.extent);
      SurfacePlace place = lanes.place(i);
      EXPECT_LE(length(origin.at(i) - offset_origin(place, away.at(i))), 1e-7f);
    }
  }
  EXPECT_GT(compared, 10000);
  EXPECT_GT(bent, 500);
  EXPECT_GT(moving, 200);
}

TEST(Lanes, RowsBecomeColumns) {
  Lanes row[lane_count];
  for (int i = 0; i < lane_count; i++)
    for (int k = 0; k < lane_count; k++) row[i][k] = float(10 * i + k);
  transpose_lanes(row);
  for (int i = 0; i < lane_count; i++)
    for (int k = 0; k < lane_count; k++) EXPECT_EQ(row[i][k], float(10 * k + i));
}

}  // namespace
}  // namespace wellspring::test
