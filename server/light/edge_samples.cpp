// SPDX-License-Identifier: Apache-2.0
#include "light/edge_samples.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/parallel.h"
#include "light/first_surface.h"
#include "light/split_reflectance.h"
#include "light/technique_list.h"

namespace wellspring {
namespace {

constexpr float color_step = 0.1f;  // of albedo, between pixels

// The mean over a pixel's samples, in parts as Sample has them.
struct Refined {
  size_t pixel = 0;
  int lit = 0;       // samples besides its own
  vec3 radiance{0};  // their sum
};

struct Refining {
  const World& world;
  const Lights& lights;
  const TransportSettings& settings;
  const View& view;
  const DiscontinuitySettings& continuity;
  int rays;
  uint64_t seed;
  uint32_t index;
  std::span<const Sample> samples;
  float pixel_angle;
};

bool has_edge(const Refining& r, int x, int y) {
  const Sample& center = r.samples[size_t(y) * size_t(r.view.width) + size_t(x)];
  for (int v = std::max(y - 1, 0); v <= std::min(y + 1, r.view.height - 1); v++)
    for (int u = std::max(x - 1, 0); u <= std::min(x + 1, r.view.width - 1); u++) {
      const Sample& other = r.samples[size_t(v) * size_t(r.view.width) + size_t(u)];
      if (&other != &center && is_edge(center, other, r.continuity, r.pixel_angle)) return true;
    }
  return false;
}

// The pixel nearest to (x, y) in the picture that shows the surface of `sample`.
const Sample* find_same(const Refining& r, const Sample& sample, float x, float y) {
  const Sample* best = nullptr;
  float nearest = std::numeric_limits<float>::infinity();
  int column = int(x), row = int(y);
  for (int v = std::max(row - 1, 0); v <= std::min(row + 1, r.view.height - 1); v++)
    for (int u = std::max(column - 1, 0); u <= std::min(column + 1, r.view.width - 1); u++) {
      float dx = float(u) + 0.5f - x, dy = float(v) + 0.5f - y, away = dx * dx + dy * dy;
      const Sample& other = r.samples[size_t(v) * size_t(r.view.width) + size_t(u)];
      if (away >= nearest || !(other.flags & sample_hit)) continue;
      if (!is_continuous(sample, other, r.continuity, r.pixel_angle)) continue;
      nearest = away;
      best = &other;
    }
  return best;
}

// The ray's radiance, if it can be told from its neighbours.
bool eval_alike(const Refining& r, const Request& request, float x, float y, vec3& radiance) {
  Transport transport{r.world, *r.lights.tables};
  Sampler sampler(request.seed, request.index);
  Sample sample;
  FirstSurface first =
      find_first_surface(transport, r.settings.max_depth, request, sampler, sample);
  if (!first.scatters && !first.mirrored) {
    radiance = sample.rest;
    return true;
  }
  if (!first.scatters || max_component(sample.rest) > 0) return false;
  sample.albedo = split_reflectance(first.bsdf).albedo * first.tint;
  const Sample* same = find_same(r, sample, x, y);
  if (!same) return false;
  radiance = sample.albedo * same->smooth + same->rest;
  return true;
}

void refine_row(const Refining& r, int y, std::vector<Refined>& refined) {
  std::vector<Request> asked;
  std::vector<size_t> asked_by;
  for (int x = 0; x < r.view.width; x++) {
    if (!has_edge(r, x, y)) continue;
    Refined pixel;
    pixel.pixel = size_t(y) * size_t(r.view.width) + size_t(x);
    uint64_t seed = mix64(r.seed + pixel.pixel);
    for (int i = 0; i < r.rays; i++) {
      Request request;
      request.pixel = uint32_t(pixel.pixel);
      request.seed = seed;
      request.index = r.index * uint32_t(r.rays) + uint32_t(i);
      Sampler jitter(mix64(seed ^ 0x6a09e667f3bcc909ull), request.index);
      vec2 u = jitter.next2();
      request.ray = view_ray(r.view, float(x) + u.x, float(y) + u.y);
      vec3 radiance;
      if (eval_alike(r, request, float(x) + u.x, float(y) + u.y, radiance)) {
        pixel.radiance += radiance;
      } else {
        asked.push_back(request);
        asked_by.push_back(refined.size());
      }
      pixel.lit++;
    }
    refined.push_back(pixel);
  }
  std::vector<Sample> answers(asked.size());
  trace_many_instant(r.world, r.lights, r.settings, asked, answers);
  for (size_t i = 0; i < asked.size(); i++)
    refined[asked_by[i]].radiance += answers[i].radiance();
}

}  // namespace

bool is_edge(const Sample& a, const Sample& b, const DiscontinuitySettings& settings,
             float pixel) {
  if ((a.flags & sample_hit) != (b.flags & sample_hit)) return true;
  if (!(a.flags & sample_hit)) return false;
  if (max_component(glm::abs(a.albedo - b.albedo)) > color_step) return true;
  return !is_continuous(a, b, settings, pixel);
}

void refine_edges(const World& world, const Lights& lights, const TransportSettings& settings,
                  const View& view, const DiscontinuitySettings& continuity, int rays,
                  uint64_t seed, uint32_t index, std::span<Sample> samples) {
  if (rays < 1 || settings.max_depth < 1) return;
  Refining refining{world,      lights, settings, view,    continuity,
                    rays,       seed,   index,    samples, 2 * view.tan_half_fov / float(view.height)};
  std::vector<std::vector<Refined>> rows(size_t(view.height));
  parallel_for(view.height, [&](int y) { refine_row(refining, y, rows[size_t(y)]); });
  parallel_for(view.height, [&](int y) {
    for (const Refined& pixel : rows[size_t(y)]) {
      Sample& sample = samples[pixel.pixel];
      float own = 1 / float(1 + pixel.lit);
      sample.albedo *= own;
      sample.rest = own * (sample.rest + pixel.radiance);
      sample = finish_sample(lights, settings, sample);
    }
  });
}

}  // namespace wellspring
