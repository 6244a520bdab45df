// SPDX-License-Identifier: Apache-2.0
// Points: how they are packed, projected, culled, aged, moved and replaced.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "base/rng.h"
#include "cache/packing.h"
#include "cache/project.h"
#include "cache/remember.h"
#include "picture/cells/surface_image.h"
#include "unit/cache/room.h"

namespace wellspring::test {
namespace {

struct Stage {
  PointCache points;
  PointImage image;
  Scratch scratch;
  View view = look_at(vec3(0), vec3(0, 0, -1), 60, 64, 48);
  Stage(int capacity = 1024) {
    resize_points(points, capacity);
    resize_image(image, view.width, view.height);
  }
  // A point that faces the viewer.
  void put(uint32_t i, vec3 p, uint32_t object = 1, bool infinite = false) {
    points.x[i] = p.x, points.y[i] = p.y, points.z[i] = p.z;
    points.normal[i] = points.color[i].normal = pack_normal(infinite ? -p : view.position - p);
    points.flags[i] = uint8_t(point_used | (infinite ? point_infinite : 0));
    points.age[i] = 0;
    points.count[i] = 1;
    points.color[i].object = object;
  }
  void project() { project_points(points, view, false, scratch, image); }
  uint32_t at(int x, int y) const { return image.point[size_t(y * image.width + x)]; }
  int shown() const {
    int count = 0;
    for (uint32_t p : image.point) count += p != no_point;
    return count;
  }
};

Sample sample_at(vec3 p, vec3 n, uint32_t object, vec3 smooth = vec3(1)) {
  return Sample{.position = p,
                .normal = n,
                .distance = length(p),
                .object = object,
                .albedo = vec3(0.5f),
                .smooth = smooth,
                .flags = sample_hit};
}

TEST(Packing, ColoursKeepTheirValue) {
  Rng rng(1);
  for (int i = 0; i < 2000; i++) {
    vec3 c = vec3(rng.uniform(), rng.uniform(), rng.uniform()) * std::exp2(rng.uniform() * 20 - 8);
    vec3 back = unpack_rgb9e5(pack_rgb9e5(c));
    EXPECT_LE(max_component(abs(back - c)), max_component(c) / 500 + 1e-6f);
    vec3 a(rng.uniform(), rng.uniform(), rng.uniform());
    EXPECT_LE(max_component(abs(unpack_albedo(pack_albedo(a)) - a)), 0.0012f);
    float s = std::exp2(rng.uniform() * 14 - 10);
    EXPECT_NEAR(unpack_deviation(pack_deviation(s)) / s, 1, 0.04);
    EXPECT_NEAR(unpack_half(pack_half(s)) / s, 1, 0.001);
  }
  EXPECT_EQ(unpack_deviation(pack_deviation(0)), 0);
}

TEST(Packing, StochasticRoundingIsUnbiased) {
  vec3 value(1.0f, 0.3337f, 0.0071f), sum(0);
  Rng rng(2);
  for (int i = 0; i < 40000; i++) sum += unpack_rgb9e5(pack_rgb9e5(value, rng.next()));
  // One step is 1/256 here, its mean over 40000 within 4 standard errors of 1/256/2/200.
  EXPECT_LE(max_component(abs(sum / 40000.0f - value)), 4e-5f + 1e-5f);
}

TEST(Packing, NonsenseBecomesBlack) {
  float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  EXPECT_EQ(unpack_rgb9e5(pack_rgb9e5(vec3(nan, -1, 0))), vec3(0));
  EXPECT_TRUE(is_finite(unpack_rgb9e5(pack_rgb9e5(vec3(inf, 1, 1)))));
  EXPECT_EQ(unpack_albedo(pack_albedo(vec3(nan))), vec3(0));
  for (vec3 n : {vec3(nan), vec3(0), vec3(inf, 0, 0)})
    EXPECT_NEAR(length(unpack_normal(pack_normal(n))), 1, 1e-3);
}

TEST(Packing, NormalsWithinADegree) {
  Rng rng(3);
  for (int i = 0; i < 5000; i++) {
    float z = rng.uniform() * 2 - 1, phi = rng.uniform() * 2 * pi, r = std::sqrt(1 - z * z);
    vec3 n(r * std::cos(phi), r * std::sin(phi), z);
    EXPECT_GT(dot(unpack_normal(pack_normal(n)), n), std::cos(1.1f * pi / 180));
  }
}

TEST(Project, EveryPointFallsWhereTheViewSays) {
  struct Case {
    float fov;
    vec2 middle;  // in half heights of the picture
  };
  for (auto [fov, middle] : {Case{5, {0, 0}}, Case{60, {0, 0}}, Case{150, {0, 0}},
                             Case{60, {0.7f, -0.4f}}, Case{60, {-1.5f, 1}}}) {
    Stage stage(4096);
    vec3 eye(1e4f, -20, 300);
    stage.view = look_at(eye, eye + vec3(0.3f, -0.2f, -1), fov, 100, 70);
    stage.view.middle = middle * stage.view.tan_half_fov;
    resize_image(stage.image, 100, 70);
    Rng rng(7);
    for (uint32_t i = 0; i < 4096; i++) {
      vec3 p = eye + (vec3(rng.uniform(), rng.uniform(), rng.uniform()) - 0.5f) * 40.0f;
      stage.put(i, fov > 10 ? p : eye + (p - eye) * vec3(0.1f, 0.1f, 1));
    }
    stage.project();
    // The nearest point of every pixel by brute force.
    std::vector<float> nearest(7000, 1e30f);
    int compared = 0;
    for (uint32_t i = 0; i < 4096; i++) {
      Projected at =
          project_point(stage.view, vec3(stage.points.x[i], stage.points.y[i], stage.points.z[i]));
      if (at.depth <= 1e-3f || !(at.x >= 0 && at.y >= 0 && at.x < 100 && at.y < 70)) continue;
      float& d = nearest[size_t(int(at.y) * 100 + int(at.x))];
      d = std::min(d, at.depth);
    }
    for (size_t i = 0; i < nearest.size(); i++) {
      if (nearest[i] > 1e29f) continue;
      uint32_t p = stage.image.point[i];
      compared++;
      if (p == no_point) continue;  // rounded into the next pixel; counted below
      EXPECT_NEAR(stage.image.depth[i], nearest[i], nearest[i] * 2e-3f + 2e-3f)
          << "pixel " << i << " fov " << fov;
      Projected at =
          project_point(stage.view, vec3(stage.points.x[p], stage.points.y[p], stage.points.z[p]));
      EXPECT_NEAR(at.x, float(i % 100) + 0.5f, 0.51f);
      EXPECT_NEAR(at.y, float(i / 100) + 0.5f, 0.51f);
    }
    EXPECT_GT(compared, fov < 10 ? 3 : middle == vec2(0) ? 200 : 150);
    EXPECT_NEAR(stage.shown(), compared, std::max(2, compared / 100));
  }
}

// Eyes at any place before one window see a point that lies in the window at one pixel of it, and
// points behind it where the lines of sight cross the window.
TEST(Project, PointsOfTheWindowStayWhileTheEyeMoves) {
  Rng rng(5);
  const float half_height = 0.5f;  // the window's, 1 m before the eye at rest
  for (int i = 0; i < 50; i++) {
    Stage stage;
    const vec3 eye(rng.uniform() - 0.5f, 0.6f * rng.uniform() - 0.3f, rng.uniform() - 0.5f);
    const vec3 in_window(0.1f, -0.2f, -1), behind(0.4f, 0.3f, -3);
    stage.view.position = eye;
    stage.view.tan_half_fov = half_height / (1 + eye.z);
    stage.view.middle = -vec2(eye) / (1 + eye.z);
    stage.put(0, in_window), stage.put(1, behind);
    stage.project();
    const vec3 seen = eye + (behind - eye) * ((1 + eye.z) / (3 + eye.z));
    auto shows = [&](vec3 place, uint32_t point) {  // rounding may carry it to a neighbour
      const float x = 32 + 24 * place.x / half_height, y = 24 - 24 * place.y / half_height;
      if (!(x > 1 && y > 1 && x < 63 && y < 47)) return true;
      for (float dx : {-1e-3f, 1e-3f})
        for (float dy : {-1e-3f, 1e-3f})
          if (stage.at(int(x + dx), int(y + dy)) == point) return true;
      return false;
    };
    EXPECT_TRUE(shows(in_window, 0)) << i;
    EXPECT_TRUE(shows(seen, 1)) << i;
    PixelRays rays(stage.view);
    const Projected at = project_point(stage.view, behind);
    EXPECT_NEAR(rays.x(at.x), dot(behind - eye, stage.view.right) / at.depth, 1e-5f);
    EXPECT_NEAR(rays.y(at.y), dot(behind - eye, stage.view.up) / at.depth, 1e-5f);
  }
}

TEST(Project, HardPlacesFallNowhere) {
  Stage stage;
  float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  vec3 bad[] = {vec3(0, 0, 1),      vec3(0, 0, 0),    vec3(1, 1, 0),    vec3(nan, 0, -1),
                vec3(0, 0, nan),    vec3(inf, 0, -1), vec3(0, 0, -inf), vec3(0, 0, -1e-7f),
                vec3(1e30f, 0, -1), vec3(5, 0, -1),   vec3(0, -5, -1)};
  for (uint32_t i = 0; i < std::size(bad); i++) stage.put(i, bad[i]);
  stage.project();
  EXPECT_EQ(stage.shown(), 0);
  stage.put(0, vec3(0, 0, -3));
  stage.project();
  EXPECT_EQ(stage.at(32, 24), 0u);
  EXPECT_TRUE(stage.points.flags[0] & point_visible);
}

TEST(Project, NearestWinsAndBackFacesAndEvictedAreSkipped) {
  Stage stage;
  stage.put(5, vec3(0, 0, -4));
  stage.put(6, vec3(0, 0, -2));
  stage.put(7, vec3(0, 0, -3));
  stage.put(900, vec3(0, 0, -1), 1, true);  // background behind everything
  stage.project();
  EXPECT_EQ(stage.at(32, 24), 6u);
  EXPECT_FALSE(stage.points.flags[5] & point_visible);
  stage.points.normal[6] = pack_normal(vec3(0, 0, -1));
  stage.project();
  EXPECT_EQ(stage.at(32, 24), 7u);
  stage.points.age[7] = evicted_age;
  stage.project();
  EXPECT_EQ(stage.at(32, 24), 5u);
  stage.points.flags[5] = 0;
  stage.project();
  EXPECT_EQ(stage.at(32, 24), 900u);
  EXPECT_NEAR(stage.image.depth[size_t(24 * 64 + 32)] / infinite_depth, 1, 1e-5);
}

TEST(Project, InfinitePointsIgnoreWhereTheViewerStands) {
  Stage stage;
  stage.put(0, vec3(0, 0, -1), 0, true);
  stage.view = look_at(vec3(500, 3, -9), vec3(500, 3, -10), 60, 64, 48);
  stage.project();
  EXPECT_EQ(stage.at(32, 24), 0u);
}

// A wall at depth 2 with gaps, another at depth 4 behind; every second gap shows the wall behind.
TEST(DepthCull, RemovesWhatShowsThroughAndKeepsSilhouettes) {
  Stage stage(8192);
  uint32_t next = 0;
  auto put_pixel = [&](int x, int y, float depth) {
    vec3 d = view_ray(stage.view, float(x) + 0.5f, float(y) + 0.5f).direction;
    stage.put(next++, d * (depth / -d.z));
  };
  for (int y = 0; y < 48; y++)
    for (int x = 0; x < 64; x++) {
      bool left = x < 32, gap = x % 5 == 2 && y % 5 == 2;
      put_pixel(x, y, left && !gap ? 2.0f : 4.0f);
    }
  stage.project();
  ASSERT_EQ(stage.shown(), 64 * 48);
  depth_cull(stage.points, 0.1f, stage.image);
  for (int y = 3; y < 45; y++)
    for (int x = 3; x < 61; x++) {
      bool gap = x < 32 && x % 5 == 2 && y % 5 == 2;
      EXPECT_EQ(stage.at(x, y) == no_point, gap) << x << " " << y;
    }
  // Verified by this very view: kept.
  for (auto& f : stage.points.flags) f |= point_verified;
  project_points(stage.points, stage.view, true, stage.scratch, stage.image);
  depth_cull(stage.points, 0.1f, stage.image);
  EXPECT_EQ(stage.shown(), 64 * 48);
}

TEST(DepthCull, LeavesASlantedFloorAlone) {
  Stage stage(8192);
  stage.view = look_at(vec3(0, 1.6f, 0), vec3(0, 1.6f, -1), 60, 64, 48);
  uint32_t next = 0;
  for (int y = 26; y < 48; y++)
    for (int x = 0; x < 64; x++) {
      vec3 d = view_ray(stage.view, float(x) + 0.5f, float(y) + 0.5f).direction;
      stage.put(next, stage.view.position + d * (-1.6f / d.y));
      stage.points.normal[next++] = pack_normal(vec3(0, 1, 0));
    }
  stage.project();
  int before = stage.shown();
  depth_cull(stage.points, 0.1f, stage.image);
  EXPECT_GE(stage.shown(), before * 99 / 100);  // but for single points at the horizon
}

TEST(Ageing, FollowsTheRateOfNewPoints) {
  PointCache points;
  resize_points(points, 8000);
  for (uint32_t i = 0; i < 8000; i++)
    points.flags[i] = point_used | point_visible, points.age[i] = 0;
  points.flags[1] = point_used;
  points.flags[2] = point_used | point_visible | point_specular;
  for (int i = 0; i < 40; i++) age_points(points, 200);  // a fortieth of the cache a frame
  EXPECT_NEAR(points.age[0], 128, 2);
  EXPECT_EQ(points.age[1], evicted_age);
  EXPECT_EQ(points.age[2], 254);
  for (int i = 0; i < 1000; i++) age_points(points, 200);
  EXPECT_EQ(points.age[0], 254);  // seen points are never evicted
  age_points(points, std::numeric_limits<float>::quiet_NaN());
  EXPECT_EQ(points.age[0], 254);
}

TEST(Remember, ResampledPointsImproveInPlaceAndNewOnesReplaceTheOldest) {
  Stage stage(64);
  vec3 p(0, 0, -3);
  for (uint32_t i = 0; i < 64; i++) stage.put(i, vec3(0, 0, 5)), stage.points.age[i] = 10;
  stage.put(20, p, 3);
  stage.points.color[20].albedo = pack_albedo(vec3(0.5f));
  stage.points.color[20].smooth = pack_rgb9e5(vec3(1));
  stage.points.age[5] = 200;  // the oldest of the first group
  stage.project();
  std::vector<Request> requests(2);
  requests[0].pixel = 24 * 64 + 32, requests[0].resample = 20;
  requests[1].pixel = 7;
  vec3 side = view_ray(stage.view, 7.5f, 0.5f).direction * 4.0f;
  std::vector<Sample> samples{sample_at(p, vec3(0, 0, 1), 3, vec3(3)),
                              sample_at(side, vec3(0, 0, 1), 4)};
  std::vector<uint32_t> targets;
  Remembered r =
      remember_samples(stage.points, stage.view, requests, samples, {}, stage.image, targets);
  EXPECT_EQ(r.merged, 1);
  EXPECT_EQ(r.added, 1);
  EXPECT_EQ(targets[0], 20u);
  EXPECT_EQ(targets[1], 5u);
  EXPECT_EQ(stage.points.count[20], 2);
  EXPECT_NEAR(unpack_rgb9e5(stage.points.color[20].smooth).x, 2, 0.02);
  EXPECT_EQ(stage.at(7, 0), 5u);
  EXPECT_EQ(stage.points.color[5].object, 4u);
  EXPECT_EQ(stage.points.next_group, 1u);
}

TEST(Remember, OverwrittenPointsVanishFromTheirPixel) {
  Stage stage(8);
  for (uint32_t i = 0; i < 8; i++) {
    vec3 d = view_ray(stage.view, float(10 + i) + 0.5f, 20.5f).direction;
    stage.put(i, d * 2.0f);
    stage.points.age[i] = uint8_t(100 + i);
  }
  stage.project();
  ASSERT_EQ(stage.at(17, 20), 7u);
  std::vector<Request> requests(1);
  requests[0].pixel = 5;
  std::vector<uint32_t> targets;
  std::vector<Sample> samples{
      sample_at(view_ray(stage.view, 5.5f, 0.5f).direction, vec3(0, 0, 1), 2)};
  remember_samples(stage.points, stage.view, requests, samples, {}, stage.image, targets);
  EXPECT_EQ(targets[0], 7u);
  EXPECT_EQ(stage.at(17, 20), no_point);
  EXPECT_EQ(stage.at(5, 0), 7u);
}

TEST(Remember, RejectsWhatIsNotFiniteAndWhatDoesNotFit) {
  Stage stage(64);
  float nan = std::numeric_limits<float>::quiet_NaN();
  std::vector<Request> requests(4);
  requests[2].pixel = 1u << 30;
  requests[3].resample = 1u << 30;
  std::vector<Sample> samples(4, sample_at(vec3(0, 0, -1), vec3(0, 0, 1), 1));
  samples[0].position.y = nan;
  samples[1].rest = vec3(std::numeric_limits<float>::infinity());
  std::vector<uint32_t> targets;
  Remembered r =
      remember_samples(stage.points, stage.view, requests, samples, {}, stage.image, targets);
  EXPECT_EQ(r.rejected, 3);
  EXPECT_EQ(r.kept, 1);
}

// A point in the middle of the view that is asked again and again.
struct AskedAgain {
  static constexpr uint32_t point = 20;
  Stage stage{64};
  std::vector<Request> requests{1};
  std::vector<Sample> samples{sample_at(vec3(0, 0, -3), vec3(0, 0, 1), 3, vec3(0))};
  std::vector<uint32_t> targets;
  AskedAgain() {
    stage.put(point, vec3(0, 0, -3), 3);
    stage.project();
    requests[0].pixel = 24 * 64 + 32, requests[0].resample = point;
  }
  Remembered remember() {
    return remember_samples(stage.points, stage.view, requests, samples, {}, stage.image, targets);
  }
};

TEST(Remember, AQuietPointThatChangesMarksItsNeighbourhood) {
  AskedAgain asked;
  auto& [stage, requests, samples, targets] = asked;
  samples[0].rest = vec3(1);
  auto changed = [&] { return asked.remember().changed; };
  stage.points.color[20].rest = pack_rgb9e5(vec3(1));
  for (int i = 0; i < 4; i++) EXPECT_EQ(changed(), 0);
  samples[0].rest = vec3(0.2f);
  EXPECT_EQ(changed(), 1);
  EXPECT_EQ(stage.points.count[20], 1);
  EXPECT_NEAR(unpack_rgb9e5(stage.points.color[20].rest).x, 0.2, 0.01);
  ASSERT_EQ(stage.image.change_samples.size(), 5u);
  for (size_t i = 0; i < 4; i++) EXPECT_NEAR(stage.image.change_samples[i].change, 0, 0.01) << i;
  EXPECT_EQ(stage.image.change_samples[4].point, 20u);
  EXPECT_NEAR(stage.image.change_samples[4].change, -0.8f / (5.2f / 6),
              0.01);  // over the mean of all six
  EXPECT_EQ(stage.image.change_samples[4].noise, 0);
  // A noisy point proves nothing.
  Rng rng(4);
  int cries = 0;
  for (int i = 0; i < 300; i++) {
    samples[0].rest = vec3(-std::log(1 - rng.uniform() * 0.999f));
    requests[0].seed = uint64_t(i);
    cries += changed();
  }
  EXPECT_LE(cries, 1);
}

// A rare bright sample among quiet ones is noise and counts for one; only when it comes again the
// light has changed.
TEST(Remember, OneSurpriseIsAveragedTwoBeginAnew) {
  AskedAgain asked;
  auto& [stage, requests, samples, targets] = asked;
  auto answer = [&](float light) {
    samples[0].rest = vec3(light);
    requests[0].seed++;
    asked.remember();
    return unpack_rgb9e5(stage.points.color[20].rest).x;
  };
  stage.points.color[20].rest = pack_rgb9e5(vec3(1));
  for (int i = 0; i < 20; i++) answer(i % 2 ? 0.95f : 1.05f);
  EXPECT_NEAR(answer(8), 1 + 7.0f / 22, 0.05);
  EXPECT_EQ(stage.points.count[20], 22);
  EXPECT_NEAR(answer(1), 1 + 7.0f / 23, 0.05);  // as before: forgotten
  answer(8);
  EXPECT_EQ(stage.points.count[20], 24);
  EXPECT_NEAR(answer(8), 8, 0.05);
  EXPECT_EQ(stage.points.count[20], 1);
}

// Change samples of smooth light, of which one sample in eight brings nearly all: they say nothing
// on average while the light stays, have the noise of the light, and show the change when it
// changes.
TEST(Remember, WitnessesOfNoisyLightAreFair) {
  constexpr int samples_each = 12, visits = 4000;
  Rng rng(21);
  auto tell = [&](float later) {
    double sum = 0, square = 0, noise = 0;
    int count = 0;
    for (int k = 0; k < visits; k++) {
      AskedAgain asked;
      auto& [stage, requests, samples, targets] = asked;
      PointColor& color = stage.points.color[AskedAgain::point];
      color.albedo = pack_albedo(samples[0].albedo);
      for (int i = 0; i <= samples_each; i++) {
        float light = rng.uniform() < 0.125f ? 7.3f : 0.1f;
        if (i == samples_each) light *= later;
        samples[0].smooth = vec3(light);
        requests[0].seed = uint64_t(k) << 32 | uint64_t(i);
        if (i == 0) color.smooth = pack_rgb9e5(samples[0].smooth);
        else asked.remember();
      }
      ChangeSample last = stage.image.change_samples.back();
      sum += double(last.change), square += double(last.change * last.change);
      noise += double(last.noise * last.noise);
      count++;
    }
    return std::array<double, 3>{sum / count, square / count, noise / count};
  };
  auto [mean, square, noise] = tell(1);
  EXPECT_LT(std::abs(mean), 4 * std::sqrt(square / visits));  // four standard errors
  EXPECT_GT(noise, 0.4 * square);
  EXPECT_LT(noise, 2.5 * square);
  EXPECT_LT(tell(0.25f)[0], -0.4);
}

// A point's doubts and noise stay out of the number of samples that it is worth.
TEST(ReadPoints, TellsSamplesWhateverElseIsKept) {
  Stage stage(64);
  stage.put(20, vec3(0, 0, -3), 3);
  stage.points.count[20] = 5, stage.points.color[20].doubts = 0xfa,
  stage.points.color[20].noise = 77;
  stage.project();
  SurfaceRows rows;
  rows.start(stage.view.width, 8);
  read_points(stage.points, stage.image, 24, rows);
  EXPECT_EQ(rows.row(plane_more, 24)[32] >> 16, 77u << 8 | 5u);
}

TEST(Packing, DeviationsOverTheirMeanKeepTheirValue) {
  EXPECT_EQ(unpack_relative(pack_relative(0)), 0);
  EXPECT_EQ(unpack_relative(pack_relative(NAN)), 0);
  EXPECT_LE(pack_relative(INFINITY), 63);
  Rng rng(3);
  for (float s = 0.04f; s < 30; s *= 1.3f) {
    EXPECT_NEAR(unpack_relative(pack_relative(s)), s, 0.07f * s);
    double sum = 0;
    for (int i = 0; i < 4000; i++)
      sum += std::log(unpack_relative(pack_relative(s, uint32_t(rng.uniform() * 65536))));
    EXPECT_NEAR(sum / 4000, std::log(s), 0.01) << s;
  }
}

}  // namespace
}  // namespace wellspring::test
