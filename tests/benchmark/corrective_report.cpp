// SPDX-License-Identifier: Apache-2.0
// Tells what ageing and splatting remembered samples costs (corrective/): balls before a large one,
// as a formula knows them; and what they are worth (corrective_error.cpp).
#include <algorithm>
#include <cmath>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/task_arena.h>

#include "base/clock.h"
#include "base/rgb9e5.h"
#include "corrective/warp_and_splat.h"
#include "report.h"

namespace wellspring::test {
namespace {

constexpr int size = 512, balls_a_row = 6, ages = 10, levels_sampled = 3;
constexpr size_t wanted = 50'000;

// The camera at its i-th age: it goes round what it looks at, 0.3 degrees a step.
View view_at(uint32_t age) {
  float angle = 0.005f * float(age);
  View view;
  view.position = vec3(std::sin(angle), 0, std::cos(angle)) * 4.0f;
  view.forward = vec3(-std::sin(angle), 0, -std::cos(angle));
  view.right = vec3(std::cos(angle), 0, -std::sin(angle));
  view.width = view.height = size;
  return view;
}

CorrectiveSample trace(const View& view, ivec2 pixel) {
  Ray ray = view_ray(view, float(pixel.x) + 0.5f, float(pixel.y) + 0.5f);
  CorrectiveSample sample;
  float nearest = INFINITY;
  auto meet = [&](uint32_t object, vec3 center, float radius) {
    vec3 out = ray.origin - center;
    float half = dot(out, ray.direction), root = half * half - dot(out, out) + radius * radius;
    float t = root < 0 ? INFINITY : -half - std::sqrt(root);
    if (t >= nearest) return;
    nearest = t;
    sample.object = object;
    sample.position = ray.origin + ray.direction * t;
    sample.normal = (sample.position - center) / radius;
  };
  meet(1, vec3(0, 0, -60), 58);
  for (int i = 0; i < balls_a_row * balls_a_row; i++) {
    vec2 at = vec2(float(i % balls_a_row), float(i / balls_a_row)) - 0.5f * (balls_a_row - 1);
    meet(uint32_t(2 + i), vec3(0.6f * at, 0), 0.27f);
  }
  sample.words[0] = pack_rgb9e5(abs(sample.normal));
  return sample;
}

// Every tenth place of the coarser levels from each of ten views.
SampleStore make_store() {
  SampleStore store;
  std::vector<ivec2> places;
  std::vector<int> level;
  for (int l = 1; l <= levels_sampled; l++) {
    list_places(store.grid, l, {0, 0, size, size}, 0, INT64_MAX, places);
    level.resize(places.size(), l);
  }
  places.resize(std::min(places.size(), wanted));
  for (uint32_t age = 0; age < ages; age++) {
    View view = view_at(age);
    std::vector<CorrectiveSample> samples;
    for (size_t i = age; i < places.size(); i += ages) {
      samples.push_back(trace(view, places[i]));
      samples.back().level = level[i];
    }
    add_samples(store, view, age, samples);
  }
  return store;
}

// The median of `runs` in milliseconds.
template <class Prepare, class Body>
double measure(int runs, double (*now)(), const Prepare& prepare, const Body& body) {
  std::vector<double> times;
  for (int i = 0; i < runs; i++) {
    prepare();
    double start = now();
    body(i);
    times.push_back((now() - start) * 1000);
  }
  return quantile(times, 0.5);
}

void measure_with(BenchReport& report, const SampleStore& made, int cores, double (*now)(),
                  int runs) {
  SampleStore store = made;
  const int samples = store.count();
  // First nothing is dropped, then the four oldest of ten ages.
  for (uint32_t oldest_left : {0u, 4u}) {
    AgeingSettings settings;
    settings.max_age = ages - oldest_left;
    AgeingStats stats;
    double ms = measure(
        runs, now, [&] { store = made; },
        [&](int) { stats = age_samples(store, view_at(ages).position, ages, settings); });
    report.add("corrective.age.ms", ms, "ms",
               {{"cores", cores}, {"samples", samples}, {"dropped", stats.dropped}});
  }

  View view = view_at(ages);
  std::vector<uint32_t> object;
  for (int i = 0; i < size * size; i++)
    object.push_back(trace(view, ivec2(i % size, i / size)).object);
  std::vector<SampleWords> words(object.size());
  std::vector<uint8_t> level(object.size());
  SplatScratch scratch;
  SplatStats stats;
  double ms = measure(
      runs, now, [] {},
      [&](int) { stats = warp_and_splat(made, view, object, scratch, words, level); });
  report.add("corrective.splat.ms", ms, "ms",
             {{"cores", cores}, {"samples", samples}, {"pixels", stats.pixels}});
}

}  // namespace

void bench_corrective(BenchReport& report, const BenchOptions& options) {
  const SampleStore store = make_store();
  const int runs = options.quick ? 100 : 1000;
  measure_with(report, store, oneapi::tbb::this_task_arena::max_concurrency(), seconds_now, runs);
  {
    oneapi::tbb::global_control single(oneapi::tbb::global_control::max_allowed_parallelism, 1);
    measure_with(report, store, 1, thread_seconds_now, runs);
  }
  bench_corrective_error(report, options);
}

}  // namespace wellspring::test
