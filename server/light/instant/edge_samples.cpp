// SPDX-License-Identifier: Apache-2.0
#include "light/instant/edge_samples.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/parallel.h"
#include "light/instant/instant_samples.h"
#include "light/sample/finish_samples.h"
#include "light/walk/first_surface.h"
#include "light/walk/lambert_hits.h"

namespace wellspring::light {
namespace {

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
  std::span<const uint8_t> edges;
  std::span<const Sample> samples;
  float pixel_angle;
};

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

// Its light, if a neighbour shows the same surface.
bool take_light(const Refining& r, const Sample& sample, vec2 place, vec3& radiance) {
  const Sample* same = find_same(r, sample, place.x, place.y);
  if (same) radiance = sample.albedo * same->smooth + same->rest;
  return same;
}

// The ray's radiance, if it can be told from its neighbours.
bool eval_alike(const Refining& r, const Request& request, vec2 place, vec3& radiance) {
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
  sample.albedo = demodulated_reflectance(first).albedo * first.tint;
  return take_light(r, sample, place, radiance);
}

// The rays that a row's edges ask for, and where in the picture.
struct Looks {
  std::vector<Request> requests;
  std::vector<vec2> places;
  std::vector<size_t> pixels;  // in the row's list, of each
};

Looks look_at_edges(const Refining& r, int y, std::vector<Refined>& refined) {
  Looks looks;
  for (int x = 0; x < r.view.width; x++) {
    Refined pixel;
    pixel.pixel = size_t(y) * size_t(r.view.width) + size_t(x);
    if (!r.edges[pixel.pixel]) continue;
    pixel.lit = r.rays;
    uint64_t seed = mix64(r.seed + pixel.pixel);
    for (int i = 0; i < r.rays; i++) {
      Request request;
      request.pixel = uint32_t(pixel.pixel);
      request.seed = seed;
      request.index = r.index * uint32_t(r.rays) + uint32_t(i);
      Sampler jitter(mix64(seed ^ 0x6a09e667f3bcc909ull), request.index);
      vec2 place = vec2(float(x), float(y)) + jitter.next2();
      request.ray = view_ray(r.view, place.x, place.y);
      looks.requests.push_back(request);
      looks.places.push_back(place);
      looks.pixels.push_back(refined.size());
    }
    refined.push_back(pixel);
  }
  return looks;
}

void refine_row(const Refining& r, int y, std::vector<Refined>& refined) {
  Looks looks = look_at_edges(r, y, refined);
  std::vector<uint32_t> unknown;
  std::vector<Sample> samples(looks.requests.size());
  LambertHits seen = see_lambert({r.world, *r.lights.tables}, looks.requests, samples);
  vec3 radiance;
  auto answer = [&](uint32_t i, bool known) {
    if (known) refined[looks.pixels[i]].radiance += radiance;
    else unknown.push_back(i);
  };
  for (uint32_t i : seen.nothing) refined[looks.pixels[i]].radiance += samples[i].rest;
  for (const LambertHit& eye : seen.eyes)
    answer(eye.request, take_light(r, samples[eye.request], looks.places[eye.request], radiance));
  for (uint32_t i : seen.others)
    answer(i, eval_alike(r, looks.requests[i], looks.places[i], radiance));
  std::vector<Request> asked;
  for (uint32_t i : unknown) asked.push_back(looks.requests[i]);
  samples.resize(asked.size());
  trace_many_instant(r.world, r.lights, r.settings, asked, samples);
  for (size_t i = 0; i < asked.size(); i++)
    refined[looks.pixels[unknown[i]]].radiance += samples[i].radiance();
}

}  // namespace

void refine_edges(const World& world, const Lights& lights, const TransportSettings& settings,
                  const View& view, const DiscontinuitySettings& continuity, int rays,
                  uint64_t seed, uint32_t index, std::span<const uint8_t> edges,
                  std::span<Sample> samples) {
  if (rays < 1 || settings.max_depth < 1) return;
  Refining refining{world,
                    lights,
                    settings,
                    view,
                    continuity,
                    rays,
                    seed,
                    index,
                    edges,
                    samples,
                    2 * view.tan_half_fov / float(view.height)};
  std::vector<std::vector<Refined>> rows(size_t(view.height));
  parallel_each(view.height, [&](int y) { refine_row(refining, y, rows[size_t(y)]); });
  parallel_for(view.height, [&](int y) {
    for (const Refined& pixel : rows[size_t(y)]) {
      Sample& sample = samples[pixel.pixel];
      float own = 1 / float(1 + pixel.lit);
      sample.albedo *= own;
      sample.rest = own * (sample.rest + pixel.radiance);
      sample.glow *= own;
      sample = finish_sample(lights, settings, sample);
    }
  });
}

}  // namespace wellspring::light
