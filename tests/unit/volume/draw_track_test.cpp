// SPDX-License-Identifier: Apache-2.0
// Rays that are stopped by chance show, on average, what rays show that march.
#include "volume/draw/track.h"

#include <gtest/gtest.h>

#include <cmath>

#include "unit/volume/draw_made.h"

namespace wellspring::test {
namespace {

const VolumeLight askew_light{
    .to_lamp = normalize(vec3(1, 2, 3)), .lamp = vec3(0.9f), .around = vec3(0.3f)};

// A ball with waves in it, 40 mm wide.
ShownVolume wavy_ball() {
  return make_shown_volume(made_volume({52, 48, 50}, [](glm::vec3 p) {
    return ball_of(p, 20) * (1 + 0.3f * std::sin(0.7f * p.x) * std::cos(0.5f * p.y));
  }));
}
const Preset mist{
    "mist",
    VolumeMode::density,
    {{0.1, vec3(1), 0.0}, {0.7, vec3(0.2f, 0.9f, 0.4f), 0.02}, {1.3, vec3(1, 0.5f, 0.2f), 0.1}}};

// Counts what rays of one kind met.
struct TrackedMean {
  glm::dvec3 color{0};
  double clear = 0, distance = 0, stopped = 0;
  int64_t reads = 0;
};
TrackedMean track_often(const Tracker& tracker, const VolumeRay& ray, int count,
                        uint64_t seed = 1) {
  TrackedMean mean;
  for (int i = 0; i < count; i++) {
    Rng random(mix64(seed) + uint64_t(i));
    const TrackedRay found = tracker.track(ray, random);
    mean.reads += found.reads;
    if (!found.is_stopped()) continue;
    mean.color += glm::dvec3(found.color), mean.distance += double(found.distance), mean.stopped++;
  }
  mean.distance /= mean.stopped, mean.color /= count, mean.clear = 1 - mean.stopped / count;
  return mean;
}

// Rays along -Z, apart from each other.
VolumeRays beside_each_other(float apart) {
  VolumeRays rays;
  rays.direction = all_lanes(normalize(vec3(0.1f, -0.05f, -1)));
  for (int k = 0; k < lane_count; k++)
    rays.origin.set(k, vec3(apart * float(k) - 0.038f, 0.012f, 0.2f));
  rays.far = all_lanes(10);
  return rays;
}
VolumeRay ray_of(const VolumeRays& rays, int k) {
  return {rays.origin.at(k), rays.direction.at(k), rays.near[k], rays.far[k]};
}

// Marches with places in a step spread evenly.
TrackedMean march_often(const ShownVolume& volume, const DrawnPreset& preset,
                        const VolumeRays& rays, int k, float step, int level = 0) {
  TrackedMean mean;
  constexpr int count = 16;
  for (int i = 0; i < count; i++) {
    const MarchedLight found =
        march(volume, preset, rays,
              {.level = level, .step = step, .jitter = all_lanes((float(i) + 0.5f) / count)});
    mean.color += glm::dvec3(found.color.at(k)) / double(count);
    mean.clear += double(found.clear[k]) / count, mean.distance += double(found.depth[k]) / count;
  }
  return mean;
}

TEST(VolumeTrack, MatterIsAsBrightAsByMarching) {
  const ShownVolume volume = wavy_ball();
  const DrawnPreset preset(volume, mist, askew_light);
  const VolumeRays rays = beside_each_other(0.0057f);
  for (int level : {0, 1}) {
    TrackSettings settings;
    settings.level = level;
    const Tracker tracker(volume, preset, settings);
    TrackedMean tracked, marched;
    for (int k = 0; k < lane_count; k++) {
      const TrackedMean a = track_often(tracker, ray_of(rays, k), 30000, uint64_t(k)),
                        b = march_often(volume, preset, rays, k, 0.05f, level);
      tracked.color += a.color, marched.color += b.color;
      // Three standard errors, and what marching leaves away behind nearly opaque matter.
      EXPECT_NEAR(a.clear, b.clear, 3 * std::sqrt(0.25 / 30000) + 0.004) << k;
    }
    EXPECT_GT(marched.color.x, 0.5) << "the rays meet something";
    for (int c = 0; c < 3; c++) EXPECT_NEAR(tracked.color[c] / marched.color[c], 1, 0.01) << c;
  }
}

TEST(VolumeTrack, ASurfaceIsWhereMarchingFindsIt) {
  const ShownVolume volume = wavy_ball();
  const DrawnPreset preset(
      volume, {"skin", VolumeMode::surface, {{0.5, vec3(0.9f, 0.6f, 0.3f), 1}, {1.2, vec3(1), 1}}},
      askew_light);
  const VolumeRays rays = beside_each_other(0.0057f);
  const Tracker tracker(volume, preset, {});
  TrackedMean tracked, marched;
  for (int k = 1; k < lane_count - 1; k++) {
    const TrackedMean a = track_often(tracker, ray_of(rays, k), 200),
                      b = march_often(volume, preset, rays, k, 0.1f);
    ASSERT_EQ(a.clear, 0) << k;
    EXPECT_NEAR(a.distance, b.distance, 0.05 * millimetre) << k;
    tracked.color += a.color, marched.color += b.color;
  }
  for (int c = 0; c < 3; c++) EXPECT_NEAR(tracked.color[c] / marched.color[c], 1, 0.01) << c;
}

TEST(VolumeTrack, TheLargestValueIsMetByItsOpacity) {
  const ShownVolume volume = wavy_ball();
  const DrawnPreset preset(
      volume,
      {"most", VolumeMode::maximum, {{0.25, vec3(0), 0.0}, {1.4, vec3(1, 0.8f, 0.6f), 0.9}}},
      askew_light);
  const VolumeRays rays = beside_each_other(0.0057f);
  const Tracker tracker(volume, preset, {});
  TrackedMean tracked, marched;
  for (int k = 0; k < lane_count; k++) {
    const TrackedMean a = track_often(tracker, ray_of(rays, k), 10000, uint64_t(k)),
                      b = march_often(volume, preset, rays, k, 0.7f);
    tracked.color += a.color, marched.color += b.color;
    EXPECT_NEAR(a.clear, b.clear, 0.02) << k;
    Rng random(3);
    EXPECT_FALSE(tracker.track_shadow(ray_of(rays, k), random).is_stopped());
  }
  for (int c = 0; c < 3; c++) EXPECT_NEAR(tracked.color[c] / marched.color[c], 1, 0.01) << c;
}

// Shares of rays that a slab of 40 mm lets through, by its density.
TEST(VolumeTrack, LightFadesExponentiallyOnTheWayThrough) {
  const ShownVolume volume =
      make_shown_volume(made_volume({40, 40, 40}, [](glm::vec3) { return 1.0f; }));
  constexpr int count = 100000;
  const VolumeCut cut{{0, 0, -1}, 0};  // keeps what lies behind the middle
  for (double thickness : {0.05, 0.7, 3.0}) {
    const DrawnPreset preset(volume,
                             {"even", VolumeMode::density, {{0.0, vec3(1), thickness / 40}}}, {});
    auto passes = [&](const VolumeRay& ray, std::span<const VolumeCut> cuts) {
      TrackSettings settings;
      settings.cuts = cuts;
      const Tracker tracker(volume, preset, settings);
      int passed = 0;
      for (int i = 0; i < count; i++) {
        Rng random(uint64_t(i) + 77);
        passed += !tracker.track_shadow(ray, random).is_stopped();
      }
      return double(passed) / count;
    };
    auto expect = [&](double share, double of_thickness, const char* what) {
      const double expected = std::exp(-thickness * of_thickness);
      EXPECT_NEAR(share, expected, 3 * std::sqrt(expected * (1 - expected) / count)) << what;
    };
    const VolumeRay across{vec3(0.0012f, 0, 1), vec3(0, 0, -1)};
    expect(passes(across, {}), 1, "across");
    expect(passes(across, {&cut, 1}), 0.5, "cut");
    expect(passes({vec3(0.0012f, 0, 0), vec3(0, 0, -1)}, {}), 0.5, "from inside");
    expect(passes({vec3(0.0012f, 0, 1), vec3(0, 0, -1), 0, 1}, {}), 0.5, "to a place inside");
    expect(passes({vec3(0, -1, 1), normalize(vec3(0, 1, -1))}, {}), std::sqrt(2.0), "askew");
    expect(passes({vec3(0, 0.0201f, 1), vec3(0, 0, -1)}, {}), 0, "beside it");
  }
}

TEST(VolumeTrack, ACutShowsTheInsideWhereItIs) {
  const ShownVolume volume =
      make_shown_volume(made_volume({40, 40, 40}, [](glm::vec3 p) { return ball_of(p, 15); }));
  const DrawnPreset preset(volume, {"ball", VolumeMode::surface, {{0.5, vec3(1), 1}}}, askew_light);
  const VolumeCut cut{{0, 0, -1}, 0.002f};  // keeps what lies 2 mm behind the middle
  TrackSettings settings;
  settings.cuts = {&cut, 1};
  const TrackedMean found = track_often(Tracker(volume, preset, settings), {vec3(0, 0, 1)}, 100);
  EXPECT_EQ(found.clear, 0);
  EXPECT_NEAR(found.distance, 1.002, 1e-5);
}

TEST(VolumeTrack, WhatIsEmptyIsNotRead) {
  const ShownVolume volume =
      make_shown_volume(made_volume({64, 64, 64}, [](glm::vec3 p) { return ball_of(p, 6); }));
  auto reads = [&](const Preset& preset, vec3 from) {
    const DrawnPreset drawn(volume, preset, {});
    return track_often(Tracker(volume, drawn, {}), {from}, 100).reads;
  };
  const Preset nothing{"nothing", VolumeMode::density, {{0.0, vec3(1), 0.0}}},
      ball{"ball", VolumeMode::density, {{0.2, vec3(1), 0.0}, {1.0, vec3(1), 1.0}}};
  EXPECT_EQ(reads(nothing, {0, 0, 1}), 0);
  EXPECT_EQ(reads(ball, {0.02f, 0.02f, 1}), 0) << "a ray beside the ball";
  EXPECT_GT(reads(ball, {0, 0, 1}), 0);
}

TEST(VolumeTrack, TheSameNumbersMeetTheSamePlace) {
  const ShownVolume volume = wavy_ball();
  const DrawnPreset preset(volume, mist, askew_light);
  const Tracker tracker(volume, preset, {});
  for (int i = 0; i < 100; i++) {
    Rng one{uint64_t(i)}, two{uint64_t(i)}, shadow{uint64_t(i)};
    const VolumeRay ray{vec3(0.001f, 0.002f, 1)};
    const TrackedRay a = tracker.track(ray, one), b = tracker.track(ray, two);
    EXPECT_EQ(a.distance, b.distance);
    EXPECT_EQ(a.color, b.color);
    EXPECT_EQ(a.distance, tracker.track_shadow(ray, shadow).distance);
  }
}

TEST(VolumeTrack, HardRaysAndVolumesAreSafe) {
  const float infinite = INFINITY;
  for (glm::ivec3 size : {glm::ivec3(1), glm::ivec3(1, 1, 4000), glm::ivec3(3, 1, 2)}) {
    const ShownVolume volume = make_shown_volume(made_volume(size, [&](glm::vec3 p) {
      return p.z > 0 ? infinite : p.z < -1 ? std::nanf("") : 1e30f;
    }));
    for (const Preset& preset : find_presets(volume)) {
      const DrawnPreset drawn(volume, preset, {});
      const Tracker tracker(volume, drawn, {});
      for (const VolumeRay& ray :
           {VolumeRay{vec3(0, 0, 5)}, VolumeRay{vec3(0, 0, 5), vec3(std::nanf(""))},
            VolumeRay{vec3(std::nanf("")), vec3(0, 1, 0)}, VolumeRay{vec3(0, 0, 5), vec3(0, 1, 0)},
            VolumeRay{vec3(0), vec3(0, 0, -1), 1, 0}, VolumeRay{vec3(1e17f), vec3(1, 0, 0)}}) {
        Rng random(1);
        const TrackedRay found = tracker.track(ray, random);
        EXPECT_TRUE(is_finite(found.color)) << preset.name;
        EXPECT_GE(found.distance, 0);
      }
    }
  }
}

TEST(TransferTable, TheLargestDensityOfARangeIsThatOfOneCode) {
  const ShownVolume volume = wavy_ball();
  const TransferTable table({"jagged",
                             VolumeMode::density,
                             {{0.0, vec3(1), 0.3},
                              {0.2, vec3(1), 0.0},
                              {0.5, vec3(1), 0.7},
                              {0.5, vec3(1), 0.1},
                              {0.9, vec3(1), 0.4}}},
                            volume);
  Rng random(5);
  for (int i = 0; i < 300; i++) {
    const uint32_t a = random.next() & 0xffff, b = random.next() & 0xffff,
                   wide = i % 3 == 0   ? a
                          : i % 3 == 1 ? std::min(a + 20, 65535u)
                                       : b;
    const CodeRange range{uint16_t(std::min(a, wide)), uint16_t(std::max(a, wide))};
    float largest = 0;
    for (uint32_t code = range.least; code <= range.most; code++)
      largest = std::max(largest, table.density_of(float(code)));
    EXPECT_GE(table.largest_density(range), largest);
    // Codes next to the range may count, but none farther.
    const CodeRange wider{uint16_t(std::max(range.least - 16, 0)),
                          uint16_t(std::min(range.most + 16, 65535))};
    for (uint32_t code = wider.least; code <= wider.most; code++)
      largest = std::max(largest, table.density_of(float(code)));
    EXPECT_LE(table.largest_density(range), largest);
  }
  EXPECT_EQ(table.largest_density({}), 0) << "an empty range";
}

}  // namespace
}  // namespace wellspring::test
