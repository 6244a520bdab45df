// SPDX-License-Identifier: Apache-2.0
#include "light/virtual/discontinuity_buffer.h"

#include <gtest/gtest.h>

#include "base/rng.h"

using namespace wellspring;

using namespace wellspring::test;

namespace {

void filter_smooth(const View& view, const DiscontinuitySettings& settings,
                   std::span<Sample> samples, std::vector<uint8_t>* edges = nullptr) {
  filter_windows(view, std::span(&settings, 1), samples, edges);
}

constexpr int width = 24, height = 18;

View flat_view() {
  View view;
  view.width = width;
  view.height = height;
  view.tan_half_fov = 0.5f;
  return view;
}

// Returns the view's samples of the plane `distance` before it, tilted so that its depth varies a
// lot.
std::vector<Sample> see_plane(vec3 normal, float distance = 2) {
  std::vector<Sample> samples;
  View view = flat_view();
  normal = normalize(normal);
  for (int y = 0; y < height; y++)
    for (int x = 0; x < width; x++) {
      Ray ray = view_ray(view, float(x) + 0.5f, float(y) + 0.5f);
      Sample s;
      s.flags = sample_hit;
      s.distance = dot(vec3(0, 0, -distance), normal) / dot(ray.direction, normal);
      s.position = ray.direction * s.distance;
      s.normal = normal;
      s.object = 1;
      s.albedo = vec3(0.5f);
      samples.push_back(s);
    }
  return samples;
}

size_t pixel_at(int x, int y) { return size_t(y * width + x); }

void fill_random(std::vector<Sample>& samples, uint64_t seed) {
  Rng rng(seed);
  for (Sample& s : samples) s.smooth = {rng.uniform(), 2 * rng.uniform(), rng.uniform()};
}

dvec3 sum_of(const std::vector<Sample>& samples) {
  dvec3 sum(0);
  for (const Sample& s : samples) sum += dvec3(s.smooth);
  return sum;
}

void expect_same_sum(const std::vector<Sample>& a, const std::vector<Sample>& b) {
  dvec3 x = sum_of(a), y = sum_of(b);
  for (int i = 0; i < 3; i++) EXPECT_NEAR(x[i], y[i], 1e-6 * x[i]);
}

// Two halves of a picture that must not mix: each is constant before and after.
void expect_apart(std::vector<Sample> samples, const char* what) {
  for (int y = 0; y < height; y++)
    for (int x = 0; x < width; x++)
      samples[pixel_at(x, y)].smooth = vec3(x < width / 2 ? 1.0f : 5.0f);
  for (int n : {3, 5}) {
    std::vector<Sample> filtered = samples;
    filter_smooth(flat_view(), {n, n}, filtered);
    for (int y = 0; y < height; y++)
      for (int x = 0; x < width; x++)
        ASSERT_NEAR(filtered[pixel_at(x, y)].smooth.x, x < width / 2 ? 1 : 5, 1e-5)
            << what << " at " << x << "," << y;
  }
}

}  // namespace

// One value per set, as interleaving leaves them: the pattern vanishes wherever the window is
// whole.
TEST(Discontinuity, PatternOfSetsVanishesOnAPlane) {
  for (int n : {3, 5}) {
    std::vector<Sample> samples = see_plane({0, 1, 0.3f});
    float mean = float(n * n - 1) / 2;
    for (int y = 0; y < height; y++)
      for (int x = 0; x < width; x++)
        samples[pixel_at(x, y)].smooth = vec3(float(y % n * n + x % n));
    filter_smooth(flat_view(), {n, n}, samples);
    for (int y = 2 * n; y < height - 2 * n; y++)
      for (int x = 2 * n; x < width - 2 * n; x++)
        ASSERT_NEAR(samples[pixel_at(x, y)].smooth.x, mean, 1e-4) << n << ": " << x << "," << y;
  }
}

TEST(Discontinuity, NoLightIsWonOrLost) {
  for (vec3 normal : {vec3(0, 0, 1), vec3(0, 1, 0.2f)}) {
    std::vector<Sample> samples = see_plane(normal);
    fill_random(samples, 7);
    Rng rng(9);
    for (Sample& s : samples) s.object = 1 + (rng.next() & 1);  // ragged neighbourhoods
    for (int n : {3, 5, 7}) {
      std::vector<Sample> filtered = samples;
      filter_smooth(flat_view(), {n, n}, filtered);
      expect_same_sum(samples, filtered);
    }
  }
}

// After the window of sets, one that looks three pixels far makes a pattern three times as wide
// vanish.
TEST(Discontinuity, WiderWindowTakesAWiderPattern) {
  std::vector<Sample> samples = see_plane({0, 1, 0.3f});
  for (int y = 0; y < height; y++)
    for (int x = 0; x < width; x++) samples[pixel_at(x, y)].smooth = vec3(float(y % 9 * 9 + x % 9));
  const dvec3 before = sum_of(samples);
  filter_smooth(flat_view(), {3, 3}, samples);
  filter_smooth(flat_view(), {3, 3, 3}, samples);
  EXPECT_NEAR(sum_of(samples).x, before.x, 1e-6 * before.x);
  EXPECT_NEAR(samples[pixel_at(12, 9)].smooth.x, 40, 1e-3);  // both windows are whole around it
}

// One call for two windows, in bands with room for both, is two calls.
TEST(Discontinuity, WindowsOneAfterTheOther) {
  std::vector<Sample> apart = see_plane({0, 1, 0.3f});
  fill_random(apart, 3);
  Rng rng(4);
  for (Sample& s : apart) {
    s.object = 1 + (rng.uniform() < 0.1f);
    if (rng.uniform() < 0.05f) s.flags = 0;
    if (rng.uniform() < 0.05f) s.albedo = vec3(0);
  }
  std::vector<Sample> together = apart;
  std::vector<uint8_t> edges, edges_together;
  const DiscontinuitySettings windows[] = {{3, 3}, {3, 3, 3}, {5, 3}};
  for (const DiscontinuitySettings& window : windows)
    filter_smooth(flat_view(), window, apart, &window == windows ? &edges : nullptr);
  filter_windows(flat_view(), windows, together, &edges_together);
  EXPECT_EQ(edges, edges_together);
  for (size_t i = 0; i < apart.size(); i++) ASSERT_EQ(apart[i].smooth, together[i].smooth) << i;
}

// Eight pixels at once find the edges that is_edge finds one by one.
TEST(Discontinuity, EdgesAreWhereNeighboursDiffer) {
  std::vector<Sample> samples = see_plane({0, 1, 0.3f});
  Rng rng(11);
  for (Sample& s : samples) {
    if (rng.uniform() < 0.05f) s.object = 2;
    if (rng.uniform() < 0.05f) s.albedo = vec3(0.5f, 0.62f, 0.5f);
    if (rng.uniform() < 0.05f) s.flags = 0;
    if (rng.uniform() < 0.05f) s.normal = normalize(vec3(1, 0, 0));
  }
  const View view = flat_view();
  const DiscontinuitySettings settings;
  const float pixel = 2 * view.tan_half_fov / float(height);
  std::vector<uint8_t> edges;
  std::vector<Sample> filtered = samples;
  filter_smooth(view, settings, filtered, &edges);
  ASSERT_EQ(edges.size(), samples.size());
  int found = 0;
  for (int y = 0; y < height; y++)
    for (int x = 0; x < width; x++) {
      bool edge = false;
      for (int v = std::max(y - 1, 0); v <= std::min(y + 1, height - 1); v++)
        for (int u = std::max(x - 1, 0); u <= std::min(x + 1, width - 1); u++)
          edge |= (u != x || v != y) &&
                  is_edge(samples[pixel_at(x, y)], samples[pixel_at(u, v)], settings, pixel);
      ASSERT_EQ(edges[pixel_at(x, y)] != 0, edge) << x << "," << y;
      found += edge;
    }
  EXPECT_GT(found, 50);
  EXPECT_LT(found, width * height);
}

TEST(Discontinuity, NothingMixesAcrossEdges) {
  std::vector<Sample> objects = see_plane({0, 0, 1});
  std::vector<Sample> crease = objects, step = objects;
  std::vector<Sample> behind = see_plane({0, 0, 1}, 2.5f);
  for (int y = 0; y < height; y++)
    for (int x = width / 2; x < width; x++) {
      objects[pixel_at(x, y)].object = 2;
      crease[pixel_at(x, y)].normal = normalize(vec3(1, 0, 1));
      step[pixel_at(x, y)] = behind[pixel_at(x, y)];
    }
  expect_apart(objects, "another object");
  expect_apart(crease, "a crease");
  expect_apart(step, "a step in depth");
}

TEST(Discontinuity, TexturesAndEverythingElseStay) {
  std::vector<Sample> samples = see_plane({0, 0, 1});
  fill_random(samples, 3);
  Rng rng(4);
  for (Sample& s : samples) {
    s.albedo = vec3(0.1f + rng.uniform());
    s.rest = vec3(rng.uniform());
  }
  samples[pixel_at(5, 5)].flags = 0;         // nothing hit
  samples[pixel_at(9, 9)].albedo = vec3(0);  // a mirror: no irradiance is known there
  samples[pixel_at(9, 9)].smooth = vec3(0);
  std::vector<Sample> filtered = samples;
  filter_smooth(flat_view(), {}, filtered);
  int changed = 0;
  for (size_t i = 0; i < samples.size(); i++) {
    ASSERT_EQ(samples[i].albedo, filtered[i].albedo);
    ASSERT_EQ(samples[i].rest, filtered[i].rest);
    ASSERT_EQ(samples[i].position, filtered[i].position);
    changed += samples[i].smooth != filtered[i].smooth;
  }
  EXPECT_EQ(filtered[pixel_at(5, 5)].smooth, samples[pixel_at(5, 5)].smooth);
  EXPECT_EQ(filtered[pixel_at(9, 9)].smooth, vec3(0));
  EXPECT_GT(filtered[pixel_at(9, 10)].smooth.x, 0.1f);  // and does not darken its neighbours
  EXPECT_GT(changed, width * height / 2);
}

TEST(Discontinuity, ContinuityIsMutual) {
  std::vector<Sample> a = see_plane({0, 1, 0.3f}), b = see_plane({0.2f, 1, 0.4f}, 2.02f);
  DiscontinuitySettings settings;
  int yes = 0, no = 0;
  for (size_t i = 0; i + 1 < a.size(); i++) {
    bool there = is_continuous(a[i], b[i + 1], settings, 0.05f);
    ASSERT_EQ(there, is_continuous(b[i + 1], a[i], settings, 0.05f));
    there ? yes++ : no++;
  }
  EXPECT_GT(yes, 0);
  EXPECT_GT(no, 0);
}
