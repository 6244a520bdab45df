// SPDX-License-Identifier: Apache-2.0
#include "cache_display.h"

#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/clock.h"
#include "base/parallel.h"
#include "base/rng.h"
#include "cache/cache.h"
#include "world/world.h"

namespace wellspring::test {
namespace {

constexpr std::array<const char*, 6> stage_names{"move", "project",  "attend",
                                                 "plan", "remember", "reconstruct"};
using Stages = std::array<double, stage_names.size()>;

// A hall with four columns: enough surfaces and edges to be like a museum, answered in nanoseconds.
Sample answer(const Request& request) {
  const vec3 low{-6, 0, -9}, high{6, 4, 9};
  vec3 o = request.ray.origin, d = request.ray.direction;
  Sample sample;
  float nearest = 1e30f;
  for (int axis = 0; axis < 3; axis++) {
    if (d[axis] == 0) continue;
    float t = ((d[axis] > 0 ? high[axis] : low[axis]) - o[axis]) / d[axis];
    if (t >= nearest) continue;
    nearest = t;
    sample.normal = vec3(0);
    sample.normal[axis] = d[axis] > 0 ? -1.0f : 1.0f;
    sample.object = uint32_t(1 + axis * 2 + (d[axis] > 0));
  }
  for (uint32_t k = 0; k < 4; k++) {
    vec2 center(k & 1 ? 2.5f : -2.5f, k & 2 ? 3.0f : -3.0f), to = vec2(o.x, o.z) - center,
                                                             flat(d.x, d.z);
    float a = dot(flat, flat), b = dot(to, flat), c = dot(to, to) - 0.16f, disc = b * b - a * c;
    float t = disc > 0 && a > 0 ? (-b - std::sqrt(disc)) / a : -1.0f;
    if (t <= 0 || t >= nearest) continue;
    nearest = t;
    vec2 n = (to + flat * t) / 0.4f;
    sample.normal = vec3(n.x, 0, n.y);
    sample.object = 10 + k;
  }
  Rng rng(request.seed);
  sample.position = o + d * nearest;
  sample.distance = nearest;
  sample.flags = sample_hit;
  vec3 p = sample.position * 4.0f;
  float pattern =
      (int(std::floor(p.x)) + int(std::floor(p.y)) + int(std::floor(p.z))) & 1 ? 0.7f : 0.3f;
  sample.albedo = vec3(pattern, pattern * 0.9f, pattern * 0.7f);
  sample.smooth = vec3(-std::log(1 - 0.999f * rng.uniform()));
  if (rng.uniform() < 0.25f) sample.rest = vec3(0.1f * rng.uniform());
  return sample;
}

View stroll(int frame, int width, int height) {
  float s = float(frame) / 30, yaw = 0.2f * std::sin(s * 0.7f);
  View view;
  view.position = vec3(0.5f * std::sin(s * 0.3f), 1.65f, 7 - 1.4f * std::fmod(s, 8.0f));
  view.forward = vec3(-std::sin(yaw), 0, -std::cos(yaw));
  view.right = vec3(std::cos(yaw), 0, -std::sin(yaw));
  view.width = width;
  view.height = height;
  return view;
}

struct Stroll {
  Scene scene;
  World world{scene};
  RenderCache cache;
  std::vector<Request> requests;
  std::vector<Sample> samples;
  Frame frame;
  int tick = 0;
  double (*now)() = seconds_now;

  Stages step(int width, int height) {
    View view = stroll(tick++, width, height);
    std::array<double, stage_names.size() + 1> at{};
    cache.resize(width, height);
    at[0] = now();
    cache.move_points(world);
    at[1] = now();
    cache.project(view);
    at[2] = now();
    cache.attend();
    at[3] = now();
    cache.plan(view, width * height / 40, uint64_t(tick), requests);
    at[4] = now();
    samples.resize(requests.size());
    parallel_ranges(int(requests.size()), 256, [&](int begin, int end) {
      for (int i = begin; i < end; i++) samples[size_t(i)] = answer(requests[size_t(i)]);
    });
    double traced = now();
    cache.remember(view, requests, samples);
    at[5] = now();
    cache.reconstruct(view, frame);
    at[6] = now();
    Stages stages;
    for (size_t i = 0; i < stages.size(); i++) stages[i] = at[i + 1] - at[i];
    stages[4] = at[5] - traced;
    return stages;
  }
};

double median(std::vector<double> values) {
  auto middle = values.begin() + ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

struct Timing {
  double total = 0;
  Stages stages{};
};
Timing measure(Stroll& stroll, int width, int height, int frames) {
  std::vector<double> totals;
  std::array<std::vector<double>, stage_names.size()> parts;
  for (int i = 0; i < frames; i++) {
    Stages stages = stroll.step(width, height);
    double total = 0;
    for (size_t k = 0; k < stages.size(); k++) {
      total += stages[k];
      parts[k].push_back(stages[k] * 1000);
    }
    totals.push_back(total * 1000);
  }
  Timing timing;
  timing.total = median(totals);
  for (size_t k = 0; k < parts.size(); k++) timing.stages[k] = median(parts[k]);
  return timing;
}

// The bare loop over as many points as the cache holds, in the order samples come in.
double measure_yardstick(int width, int height, int points, int frames) {
  std::vector<vec3> position(static_cast<size_t>(points));
  std::vector<uint32_t> color(position.size(), 0x808080), shown(size_t(width) * size_t(height));
  std::vector<float> depth(shown.size());
  View view = stroll(0, width, height);
  for (size_t i = 0; i < position.size(); i++) {
    // The requests go in sweeps over the picture, as the plan's do, each a fortieth of its pixels.
    uint64_t random = mix64(i);
    float y =
        float(i % (position.size() / 40 + 1)) / float(position.size() / 40 + 1) * float(height);
    Request request;
    request.ray = view_ray(view, float(random & 0xffff) / 65536 * float(width), y);
    position[i] = answer(request).position;
  }
  std::vector<double> times;
  for (int frame = 0; frame < frames; frame++) {
    view = stroll(frame, width, height);
    // One core's own time is taken, so that the machine's other work does not count.
    double start = thread_seconds_now();
    std::fill(depth.begin(), depth.end(), 1e30f);
    float scale = float(height) * 0.5f / view.tan_half_fov;
    for (size_t i = 0; i < position.size(); i++) {
      vec3 d = position[i] - view.position;
      float z = dot(d, view.forward), inverse = scale / z;
      float x = dot(d, view.right) * inverse + 0.5f * float(width),
            y = 0.5f * float(height) - dot(d, view.up) * inverse;
      if (!(z > 0 && x >= 0 && y >= 0 && x < float(width) && y < float(height))) continue;
      size_t pixel = size_t(y) * size_t(width) + size_t(x);
      if (z >= depth[pixel]) continue;
      depth[pixel] = z;
      shown[pixel] = color[i];
    }
    times.push_back((thread_seconds_now() - start) * 1000);
  }
  return median(times);
}

}  // namespace

std::vector<NamedValue> report_cache_display(int width, int height, bool quick) {
  int frames = quick ? 24 : 90;
  Stroll stroll;
  for (int i = 0; i < 60; i++) stroll.step(width, height);  // fills the cache
  std::vector<NamedValue> values;
  Timing all = measure(stroll, width, height, frames);
  values.push_back({"cache.display.ms", "ms", all.total});
  Timing one, weighted;
  double yardstick = 0;
  {
    oneapi::tbb::global_control single(oneapi::tbb::global_control::max_allowed_parallelism, 1);
    stroll.now = thread_seconds_now;
    one = measure(stroll, width, height, frames);
    yardstick = measure_yardstick(width, height, stroll.cache.stats().points, frames);
    // The visitor looks at the second column.
    std::vector<float> weights(14, 0.7f);
    weights[11] = RenderCache::most_weight;
    stroll.cache.set_weights(weights);
    weighted = measure(stroll, width, height, frames);
  }
  values.push_back({"cache.display.ms_one_core", "ms", one.total});
  values.push_back({"cache.display.weighted_ms_one_core", "ms", weighted.total});
  values.push_back({"cache.display.yardstick_ms_one_core", "ms", yardstick});
  values.push_back({"cache.display.yardstick_ratio", "ratio", one.total / yardstick});
  for (size_t k = 0; k < stage_names.size(); k++)
    values.push_back({"cache.display.stage_ms", "ms", one.stages[k], stage_names[k]});
  for (size_t k : {size_t(2), size_t(3)})
    values.push_back({"cache.display.weighted_stage_ms", "ms", weighted.stages[k], stage_names[k]});
  values.push_back({"cache.display.memory", "MB", double(stroll.cache.memory_bytes()) / 1e6});
  return values;
}

}  // namespace wellspring::test
