// SPDX-License-Identifier: Apache-2.0
#include "volume/draw/march.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "unit/volume/draw_made.h"
#include "volume/draw/along_ray.h"
#include "volume/draw/preview.h"

namespace wellspring::test {
namespace {

// Returns rays along -Z, side by side along x, `apart` metres.
VolumeRays rays_at(vec3 first, float apart = 0) {
  VolumeRays rays;
  rays.direction = all_lanes(vec3(0, 0, -1));
  for (int k = 0; k < lane_count; k++) rays.origin.set(k, first + vec3(apart * float(k), 0, 0));
  rays.far = all_lanes(10);
  return rays;
}

Preset even_preset(double density) {
  return {"even", VolumeMode::density, {{0.0, vec3(1), density}}};
}

TEST(VolumeMarch, FadeIsTheExponential) {
  for (float x = 0; x < 40; x += 0.0173f)
    EXPECT_NEAR(fade(all_lanes(x))[3] / std::exp(-x), 1, 1e-5) << x;
  EXPECT_LT(fade(all_lanes(1e30f))[0], 1e-30f);
}

TEST(VolumeMarch, LightFadesExponentiallyOnTheWayThrough) {
  const ShownVolume volume =
      make_shown_volume(made_volume({40, 40, 40}, [](glm::vec3) { return 1.0f; }));
  const DrawnPreset preset(volume, even_preset(0.01), {});
  for (int level : {0, 1}) {
    const MarchedLight found =
        march(volume, preset, rays_at({0, 0, 1}), {.level = level, .step = 0.5f});
    EXPECT_NEAR(found.clear[0], std::exp(-0.01 * 40), 0.003) << level;
    EXPECT_EQ(found.depth[0], INFINITY) << "more than half comes through";
  }
}

TEST(VolumeMarch, HalfOfTheLightIsGoneAtItsDepth) {
  const ShownVolume volume =
      make_shown_volume(made_volume({40, 40, 40}, [](glm::vec3) { return 1.0f; }));
  const DrawnPreset preset(volume, even_preset(0.1), {});
  const MarchedLight found = march(volume, preset, rays_at({0, 0, 1}), {.step = 0.25f});
  EXPECT_NEAR(found.depth[0], 1 - 0.02 + std::log(2) / 100, 0.0005);
}

TEST(VolumeMarch, StepsOfOtherLengthsShowTheSame) {
  const ShownVolume volume = make_shown_volume(made_volume(
      {48, 48, 48}, [](glm::vec3 p) { return ball_of(p, 18) * (1 + 0.3f * std::sin(p.x)); }));
  const DrawnPreset preset(
      volume, {"ball", VolumeMode::density, {{0.1, vec3(1), 0.0}, {1.0, vec3(1, 0.5f, 0.2f), 0.1}}},
      {});
  const VolumeRays rays = rays_at({-0.02f, 0.001f, 1}, 0.005f);
  const MarchedLight fine = march(volume, preset, rays, {.step = 0.1f});
  const MarchedLight usual = march(volume, preset, rays, {.step = 0.7f});
  for (int k = 0; k < lane_count; k++) {
    EXPECT_NEAR(usual.clear[k], fine.clear[k], 0.02) << k;
    EXPECT_NEAR(usual.color.y[k], fine.color.y[k], 0.02) << k;
  }
}

TEST(VolumeMarch, WhatIsEmptyCostsNothing) {
  const ShownVolume volume =
      make_shown_volume(made_volume({64, 64, 64}, [](glm::vec3 p) { return ball_of(p, 6); }));
  const Preset nothing{"nothing", VolumeMode::density, {{0.0, vec3(1), 0.0}}};
  const MarchedLight none = march(volume, DrawnPreset(volume, nothing, {}), rays_at({0, 0, 1}), {});
  EXPECT_EQ(none.steps, 0);
  EXPECT_EQ(none.clear[0], 1);
  // A ray beside the ball meets only cells in which nothing is seen.
  const Preset ball{"ball", VolumeMode::density, {{0.2, vec3(1), 0.0}, {1.0, vec3(1), 1.0}}};
  EXPECT_EQ(march(volume, DrawnPreset(volume, ball, {}), rays_at({0.02f, 0.02f, 1}), {}).steps, 0);
}

TEST(VolumeMarch, LeapsChangeNothing) {
  const ShownVolume volume = make_shown_volume(
      made_volume({50, 44, 61}, [](glm::vec3 p) { return ball_of(p - glm::vec3(6, -3, 4), 11); }));
  DrawnPreset preset(
      volume, {"ball", VolumeMode::density, {{0.2, vec3(1), 0.0}, {1.0, vec3(1), 0.08}}}, {});
  VolumeRays rays = rays_at({-0.01f, -0.002f, 0.1f}, 0.003f);
  rays.direction = all_lanes(normalize(vec3(0.1f, -0.05f, -1)));
  const MarchedLight leapt = march(volume, preset, rays, {});
  for (auto& cells : preset.seen) std::ranges::fill(cells, uint8_t(1));
  const MarchedLight all = march(volume, preset, rays, {});
  EXPECT_LT(leapt.steps, all.steps);
  for (int k = 0; k < lane_count; k++) {
    EXPECT_NEAR(leapt.clear[k], all.clear[k], 0.002) << k;
    EXPECT_NEAR(leapt.color.x[k], all.color.x[k], 0.002) << k;
  }
}

TEST(VolumeMarch, ASurfaceIsFoundWhereItsValueIs) {
  const ShownVolume volume =
      make_shown_volume(made_volume({64, 64, 64}, [](glm::vec3 p) { return ball_of(p, 20); }));
  const DrawnPreset preset(volume, {"ball", VolumeMode::surface, {{0.5, vec3(1), 1.0}}},
                           {.to_lamp = vec3(0, 0, 1), .lamp = vec3(1), .around = vec3(0)});
  const MarchedLight found = march(volume, preset, rays_at({0, 0, 1}, 0.0025f), {});
  for (int k = 0; k < lane_count; k++) {
    const double across = 2.5 * k,
                 expected = 1 - millimetre * std::sqrt(std::max(400 - across * across, 0.0));
    if (across > 19) continue;
    EXPECT_NEAR(found.depth[k], expected, 0.1 * millimetre / std::sqrt(1 - across * across / 400))
        << k;
    EXPECT_EQ(found.clear[k], 0);
  }
  EXPECT_GT(found.color.x[0], 0.85f) << "it faces the lamp";
  EXPECT_LT(found.color.x[7], found.color.x[0]);
}

TEST(VolumeMarch, TheLargestValueIsShown) {
  const ShownVolume volume = make_shown_volume(made_volume({32, 32, 32}, [](glm::vec3 p) {
    return length(p - glm::vec3(0.5f, 0.5f, -5.5f)) < 1 ? 1.0f : 0.25f;
  }));
  const DrawnPreset preset(
      volume, {"most", VolumeMode::maximum, {{0.25, vec3(0), 0.0}, {1.0, vec3(1), 1.0}}}, {});
  const MarchedLight found =
      march(volume, preset, rays_at({0.0005f, 0.0005f, 1}, 0.004f), {.step = 0.2f});
  EXPECT_GT(found.color.x[0], 0.9f);
  EXPECT_LT(found.clear[0], 0.1f);
  EXPECT_NEAR(found.depth[0], 1.0055, 0.0005);
  EXPECT_EQ(found.clear[2], 1);
}

TEST(VolumeMarch, ACutTakesHalfAway) {
  const ShownVolume volume =
      make_shown_volume(made_volume({40, 40, 40}, [](glm::vec3) { return 1.0f; }));
  const DrawnPreset preset(volume, even_preset(0.02), {});
  const VolumeCut cut{{0, 0, -1}, 0};  // keeps what lies behind the middle
  const MarchedLight found =
      march(volume, preset, rays_at({0, 0, 1}), {.step = 0.25f, .cuts = {&cut, 1}});
  EXPECT_NEAR(found.clear[0], std::exp(-0.02 * 20), 0.004);
}

TEST(VolumeMarch, MatterBehindMatterLiesInItsShadow) {
  const ShownVolume volume = make_shown_volume(made_volume({48, 48, 48}, [](glm::vec3 p) {
    return std::max(ball_of(p - glm::vec3(0, 14, 0), 8), ball_of(p - glm::vec3(0, -12, 0), 8));
  }));
  const VolumeLight light{.to_lamp = vec3(0, 1, 0), .lamp = vec3(1), .around = vec3(0)};
  const DrawnPreset preset(volume, {"balls", VolumeMode::surface, {{0.5, vec3(1), 1.0}}}, light);
  // Both are seen from above, a little to the front; the lower one lies under the upper one.
  const float upper = march(volume, preset, rays_at({0, 0.02f, 1}), {}).color.x[0];
  const float lower = march(volume, preset, rays_at({0, -0.006f, 1}), {}).color.x[0];
  EXPECT_GT(upper, 0.3f);
  EXPECT_LT(lower, 0.4f * upper);
}

TEST(VolumeMarch, ATurnedVolumeIsSeenTurned) {
  Volume upright =
      made_volume({30, 40, 50}, [](glm::vec3 p) { return ball_of(p - glm::vec3(5, 8, -6), 7); });
  Volume turned = upright;
  // Its x axis points up, y to the front, z to the left.
  const glm::dmat3 turn(glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1), glm::dvec3(1, 0, 0));
  turned.to_metres = glm::dmat4(turn) * upright.to_metres;
  const Preset ball{"ball", VolumeMode::surface, {{0.5, vec3(1), 1.0}}};
  const VolumeLight light{.to_lamp = normalize(vec3(1, 2, 3))};
  const VolumeLight turned_light{.to_lamp = vec3(turn * glm::dvec3(light.to_lamp))};
  const ShownVolume a = make_shown_volume(upright), b = make_shown_volume(turned);
  VolumeRays rays = rays_at({0.003f, 0.008f, 1}, 0.001f), other = rays;
  for (int k = 0; k < lane_count; k++) {
    other.origin.set(k, vec3(turn * glm::dvec3(rays.origin.at(k))));
    other.direction.set(k, vec3(turn * glm::dvec3(rays.direction.at(k))));
  }
  const MarchedLight one = march(a, DrawnPreset(a, ball, light), rays, {});
  const MarchedLight two = march(b, DrawnPreset(b, ball, turned_light), other, {});
  for (int k = 0; k < lane_count; k++) {
    EXPECT_NEAR(one.depth[k], two.depth[k], 1e-5) << k;
    EXPECT_NEAR(one.color.x[k], two.color.x[k], 0.02) << "the sky's directions do not turn";
  }
}

TEST(VolumeMarch, HardVolumesAreShown) {
  const float infinite = INFINITY;
  for (glm::ivec3 size : {glm::ivec3(1), glm::ivec3(1, 1, 4000), glm::ivec3(3, 1, 2)}) {
    const ShownVolume volume = make_shown_volume(made_volume(size, [&](glm::vec3 p) {
      return p.z > 0 ? infinite : p.z < -1 ? std::nanf("") : 1e30f;
    }));
    for (const Preset& preset : find_presets(volume)) {
      const MarchedLight found =
          march(volume, DrawnPreset(volume, preset, {}), rays_at({0, 0, 5}), {});
      EXPECT_TRUE(std::isfinite(found.color.x[0])) << preset.name;
      EXPECT_GE(found.clear[0], 0);
      EXPECT_LE(found.clear[0], 1);
    }
  }
}

TEST(VolumeMarch, TheEyeMayBeInside) {
  const ShownVolume volume =
      make_shown_volume(made_volume({40, 40, 40}, [](glm::vec3) { return 1.0f; }));
  const DrawnPreset preset(volume, even_preset(0.02), {});
  EXPECT_NEAR(march(volume, preset, rays_at({0, 0, 0}), {.step = 0.25f}).clear[0], std::exp(-0.4),
              0.004);
}

TEST(FindPresets, AScanOfAWrappedThingHasItsFourKinds) {
  const ShownVolume volume = make_shown_volume(made_volume({64, 64, 64}, [](glm::vec3 p) {
    const float r = length(p);
    const float noise = 20 * std::sin(40 * p.x) * std::sin(37 * p.y + 3 * p.z);
    return noise + (r > 26 ? -1000.0f : r > 12 ? -300.0f : r > 3 ? 900.0f : 3000.0f);
  }));
  const std::vector<Preset> presets = find_presets(volume);
  ASSERT_EQ(presets.size(), 5u);
  EXPECT_EQ(presets[0].name, "outside");
  EXPECT_GT(presets[0].points[0].value, -980);
  EXPECT_LT(presets[0].points[0].value, -300);
  EXPECT_EQ(presets[2].name, "bone");
  EXPECT_GT(presets[2].points[0].value, -280);
  EXPECT_LT(presets[2].points[0].value, 900);
  EXPECT_EQ(presets[3].name, "metal");
  const double metal = 0.5 * (presets[3].points[2].value + presets[3].points[3].value);
  EXPECT_GT(metal, 920);
  EXPECT_LT(metal, 3000);
}

TEST(FindPresets, AnEvenVolumeHasOneAtLeast) {
  const ShownVolume volume =
      make_shown_volume(made_volume({8, 8, 8}, [](glm::vec3) { return 7.0f; }));
  EXPECT_FALSE(find_presets(volume).empty());
}

TEST(DrawVolume, ABallIsInTheMiddleOfItsPicture) {
  const ShownVolume volume =
      make_shown_volume(made_volume({48, 48, 48}, [](glm::vec3 p) { return ball_of(p, 20); }));
  const DrawnPreset preset(volume, {"ball", VolumeMode::surface, {{0.5, vec3(1), 1.0}}},
                           preview_light());
  const VolumePicture picture = draw_volume(volume, preset, {.side = 64});
  EXPECT_EQ(picture.clear[32 * 64 + 32], 0);
  EXPECT_EQ(picture.clear[0], 1);
  vec2 middle(0);
  float sum = 0;
  for (int y = 0; y < 64; y++)
    for (int x = 0; x < 64; x++) {
      const float shown = 1 - picture.clear[size_t(64 * y + x)];
      middle += shown * vec2(float(x) + 0.5f, float(y) + 0.5f), sum += shown;
    }
  EXPECT_NEAR(middle.x / sum, 32, 0.3);
  EXPECT_NEAR(middle.y / sum, 32, 0.3);
}

// Returns a volume of linear colours, 40 mm wide: the same everywhere.
Volume made_colors(vec3 color) {
  Volume volume = made_volume({40, 40, 40}, [](glm::vec3) { return 0.0f; });
  volume.channels = 3;
  const std::shared_ptr<std::byte[]> bytes(new std::byte[volume.byte_count()]);
  for (size_t i = 0; i < volume.samples(); i++) std::memcpy(&bytes[12 * i], &color, 12);
  volume.bytes = std::shared_ptr<const std::byte>(bytes, bytes.get());
  return volume;
}

TEST(VolumeMarch, GlowAddsUpAndStopsNothing) {
  const ShownVolume volume = make_shown_volume(made_colors({0.2f, 0.4f, 0.1f}));
  const Preset light{"light", VolumeMode::glow, {{0, vec3(1), 0}, {0.4, vec3(1), 0.05}}};
  const DrawnPreset preset(volume, light, {});
  const MarchedLight found = march(volume, preset, rays_at({0, 0, 1}), {.step = 0.5f});
  EXPECT_NEAR(found.color.y[0], 40 * 0.05, 0.03);
  EXPECT_NEAR(found.color.x[0] / found.color.y[0], 0.5f, 0.01f);
  EXPECT_NEAR(found.color.z[0] / found.color.y[0], 0.25f, 0.01f);
  EXPECT_EQ(found.clear[0], 1);
  EXPECT_EQ(found.depth[0], INFINITY);
}

TEST(VolumeMarch, AVolumeOfColorsKeepsThem) {
  const ShownVolume volume = make_shown_volume(made_colors({0.8f, 0.4f, 0.2f}));
  const VolumeLight even{.to_lamp = {0, 1, 0}, .lamp = vec3(0), .around = vec3(1)};
  const DrawnPreset preset(volume, even_preset(1), even);
  for (int level : {0, 1}) {
    const MarchedLight found = march(volume, preset, rays_at({0, 0, 1}), {.level = level});
    EXPECT_NEAR(found.color.y[0] / found.color.x[0], 0.5f, 0.01f) << level;
    EXPECT_NEAR(found.color.z[0] / found.color.x[0], 0.25f, 0.01f) << level;
  }
}

TEST(VolumeMarch, ACutFaceIsLitAsTheOutsideWas) {
  const ShownVolume volume =
      make_shown_volume(made_volume({40, 40, 40}, [](glm::vec3 p) { return ball_of(p, 18); }));
  const VolumeLight light{.to_lamp = {0, 0, 1}, .lamp = vec3(1), .around = vec3(0.5f)};
  const Preset opaque{"opaque", VolumeMode::density, {{0.3, vec3(1), 0}, {0.6, vec3(1), 5}}};
  const DrawnPreset preset(volume, opaque, light);
  const VolumeCut cut{{0, 0, -1}, 0};
  const MarchedLight whole = march(volume, preset, rays_at({0, 0, 1}), {.step = 0.5f});
  const MarchedLight face =
      march(volume, preset, rays_at({0, 0, 1}), {.step = 0.5f, .cuts = std::span(&cut, 1)});
  EXPECT_NEAR(face.depth[0], 1, 0.001);
  EXPECT_GT(face.color.x[0], 0.5f * whole.color.x[0]);
}

}  // namespace
}  // namespace wellspring::test
