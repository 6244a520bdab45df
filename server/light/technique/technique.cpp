// SPDX-License-Identifier: Apache-2.0
#include "light/technique/technique.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/rng.h"
#include "base/simd.h"
#include "light/kept/finish_bake.h"
#include "light/virtual/eye_light.h"
#include "light/virtual/instant_radiosity.h"
#include "light/random/sampler.h"
#include "light/sample/lamps_seen.h"
#include "light/sample/light_tables.h"
#include "light/sample/sample_light.h"
#include "light/virtual/splatter.h"
#include "light/walk/walk.h"

namespace wellspring::light {
namespace {

// Returns view_ray's directions, to a place inside each pixel.
Lanes3 view_directions(const View& view, Lanes x, Lanes y) {
  const float scale = 2 * view.tan_half_fov / float(view.height);
  const vec2 axis = axis_place(view);
  Lanes along = (x - axis.x) * scale;
  Lanes upwards = (axis.y - y) * scale;
  Lanes3 way =
      all_lanes(view.forward) + all_lanes(view.right) * along + all_lanes(view.up) * upwards;
  return way * (1 / lanes_sqrt(dot(way, way)));
}

}  // namespace

void make_pixel_requests(const View& view, uint64_t seed, std::span<const PixelSample> which,
                         std::span<Request> requests) {
  uint64_t of_pixel = 0;
  for (size_t first = 0; first < which.size(); first += lane_count) {
    const int count = int(std::min(which.size() - first, size_t(lane_count)));
    SamplerLanes jitter;
    Lanes x{}, y{};
    for (int i = 0; i < count; i++) {
      const PixelSample& asked = which[first + size_t(i)];
      Request& request = requests[first + size_t(i)];
      const PixelSample* before = first + size_t(i) > 0 ? &which[first + size_t(i) - 1] : nullptr;
      if (!before || before->x != asked.x || before->y != asked.y)
        of_pixel = sample_seed(seed, uint32_t(asked.x), uint32_t(asked.y), 0);
      request = Request();
      request.pixel = uint32_t(asked.y) * uint32_t(view.width) + uint32_t(asked.x);
      request.seed = of_pixel;
      request.index = uint32_t(asked.index);
      request.ray.origin = view.position;
      request.ray.from_eye = true;
      request.ray.spread = 2 * view.tan_half_fov / float(view.height);
      // The place comes from a sequence apart from the sample's own.
      jitter.set(i, Sampler(mix64(of_pixel ^ 0x6a09e667f3bcc909ull), request.index));
      x[i] = float(asked.x), y[i] = float(asked.y);
    }
    Lanes u, v;
    jitter.pair(LaneBits{}, u, v);
    Lanes3 way = view_directions(view, x + u, y + v);
    for (int i = 0; i < count; i++) requests[first + size_t(i)].ray.direction = way.at(i);
  }
}

namespace {

constexpr Technique list[] = {
    {"path", "unbiased path tracing: all light, the reference", trace_path, nullptr, nullptr,
     nullptr, trace_many_path, true},
    {"direct", "emission, direct light and chains of perfect mirrors and glass", trace_direct,
     nullptr, nullptr, nullptr, trace_many_direct},
    {"gather",
     "path to the first rough surface beyond the eye's, kept light from there: quick, "
     "a little biased",
     trace_gather, prepare_gather, nullptr, nullptr, trace_many_gather, true},
    {"instant_radiosity",
     "point lights along paths of light, neighbours filtered together: quick, right after many "
     "passes",
     trace_instant, nullptr, begin_instant, finish_instant, trace_many_instant},
    {"multires_splatting",
     "direct, and one bounce of diffuse light by virtual lights that are splatted coarsely where "
     "a picture is even: for light that moves",
     trace_direct, nullptr, begin_splat, finish_splat, trace_many_direct},
};

// Side in pixels of a tile that trace_many gets at once: neighbours, in the same cache.
constexpr int pass_tile = 24;
// Samples of a tile that trace_many gets at once without passes: few enough to stay in a core's
// cache.
constexpr size_t most_at_once = 256;

}  // namespace

std::span<const Technique> techniques() { return list; }

const Technique* find_technique(std::string_view name) {
  for (const Technique& technique : list)
    if (name == technique.name) return &technique;
  return nullptr;
}

void trace(const Technique& technique, const World& world, const Lights& lights,
           const TransportSettings& settings, std::span<const Request> requests,
           std::span<Sample> samples) {
  if (requests.size() != samples.size()) throw std::invalid_argument("trace: one sample a request");
  parallel_ranges(int(requests.size()), technique.begin_pass ? 512 : 64, [&](int begin, int end) {
    if (technique.trace_many)
      return technique.trace_many(world, lights, settings,
                                  requests.subspan(size_t(begin), size_t(end - begin)),
                                  samples.subspan(size_t(begin), size_t(end - begin)));
    for (int i = begin; i < end; i++)
      samples[size_t(i)] = technique.trace(world, lights, settings, requests[size_t(i)]);
  });
}

Request pixel_request(const View& view, uint64_t seed, int x, int y, int index) {
  PixelSample which{x, y, index};
  Request request;
  make_pixel_requests(view, seed, std::span(&which, 1), std::span(&request, 1));
  return request;
}

uint64_t pass_seed(uint64_t seed) { return mix64(seed ^ 0x70617373ull); }

namespace {

// Writes what a picture has of a pixel beside its colour: what its first sample hit.
void describe_pixel(const View& view, const Request& request, const Sample& sample, Frame& frame) {
  bool hit = sample.flags & sample_hit;
  frame.object[request.pixel] = hit ? sample.object : 0;
  frame.depth[request.pixel] = hit ? sample.distance * dot(request.ray.direction, view.forward)
                                   : std::numeric_limits<float>::infinity();
}

// Calls `shade(left, top, right, bottom)` for every tile, on all cores.
template <class Shade>
void for_each_tile(const View& view, int tile, const Shade& shade) {
  int across = (view.width + tile - 1) / tile, down = (view.height + tile - 1) / tile;
  parallel_each(across * down, [&](int t) {
    int left = t % across * tile, top = t / across * tile;
    shade(left, top, std::min(left + tile, view.width), std::min(top + tile, view.height));
  });
}

void trace_tile(const Technique& technique, const World& world, const Lights& lights,
                const TransportSettings& settings, std::span<const Request> requests,
                std::span<Sample> samples) {
  if (technique.trace_many) return technique.trace_many(world, lights, settings, requests, samples);
  for (size_t i = 0; i < requests.size(); i++)
    samples[i] = technique.trace(world, lights, settings, requests[i]);
}

// Renders a tile. Its samples follow each other pixel by pixel, so that a pixel's sum never leaves
// the core.
void render_tile(const Technique& technique, const World& world, const Lights& lights,
                 const View& view, const StillSettings& settings, ivec2 begin, ivec2 end,
                 Frame& frame) {
  std::vector<PixelSample> asked;
  std::vector<Request> requests;
  std::vector<Sample> samples;
  asked.reserve(most_at_once);
  dvec3 sum(0);
  auto answer = [&] {
    requests.resize(asked.size());
    samples.resize(asked.size());
    make_pixel_requests(view, settings.seed, asked, requests);
    trace_tile(technique, world, lights, settings.transport, requests, samples);
    for (size_t k = 0; k < requests.size(); k++) {
      const Request& request = requests[k];
      sum += dvec3(samples[k].radiance());
      if (request.index == 0) describe_pixel(view, request, samples[k], frame);
      if (request.index + 1 < uint32_t(settings.spp)) continue;
      frame.color[request.pixel] = vec3(sum / double(settings.spp));
      sum = dvec3(0);
    }
    asked.clear();
  };
  for (int y = begin.y; y < end.y; y++)
    for (int x = begin.x; x < end.x; x++)
      for (int i = 0; i < settings.spp; i++) {
        asked.push_back({x, y, i});
        if (asked.size() == most_at_once) answer();
      }
  answer();
}

void render_passes(const Technique& technique, const World& world, Lights lights, const View& view,
                   const StillSettings& settings, Frame& frame) {
  RawVector<dvec3> sums(frame.color.size());
  RawVector<Sample> samples(sums.size());
  for (int i = 0; i < settings.spp; i++) {
    if (technique.begin_pass)
      technique.begin_pass(world, settings.transport, view, pass_seed(settings.seed), uint32_t(i),
                           lights);
    for_each_tile(view, pass_tile, [&](int left, int top, int right, int bottom) {
      std::vector<PixelSample> which;
      for (int y = top; y < bottom; y++)
        for (int x = left; x < right; x++) which.push_back({x, y, i});
      std::vector<Request> asked(which.size());
      make_pixel_requests(view, settings.seed, which, asked);
      std::vector<Sample> answers(asked.size());
      trace_tile(technique, world, lights, settings.transport, asked, answers);
      for (size_t k = 0; k < asked.size(); k++) {
        samples[asked[k].pixel] = answers[k];
        if (i == 0) describe_pixel(view, asked[k], answers[k], frame);
      }
    });
    if (technique.finish_pass) technique.finish_pass(world, lights, view, samples);
    if (settings.progress) settings.progress(double(i + 1) / settings.spp);
    parallel_ranges(int(samples.size()), 4096, [&](int begin, int end) {
      for (size_t pixel = size_t(begin); pixel < size_t(end); pixel++) {
        dvec3 radiance(samples[pixel].radiance());
        sums[pixel] = i == 0 ? radiance : sums[pixel] + radiance;
        if (i + 1 == settings.spp) frame.color[pixel] = vec3(sums[pixel] / double(settings.spp));
      }
    });
  }
}

}  // namespace

Sample replay_sample(const Technique& technique, const World& world, Lights lights,
                     const View& view, const StillSettings& settings, int x, int y, int index) {
  if (technique.begin_pass)
    technique.begin_pass(world, settings.transport, view, pass_seed(settings.seed), uint32_t(index),
                         lights);
  return technique.trace(world, lights, settings.transport,
                         pixel_request(view, settings.seed, x, y, index));
}

Frame render_still(const Technique& technique, const World& world, const Lights& lights,
                   const View& view, const StillSettings& settings) {
  if (view.width < 1 || view.height < 1 || settings.spp < 1)
    throw std::invalid_argument("render_still: a picture has pixels, and pixels have samples");
  size_t pixels = size_t(view.width) * size_t(view.height);
  Frame frame;
  frame.width = view.width;
  frame.height = view.height;
  frame.color.resize(pixels);
  frame.depth.resize(pixels);
  frame.object.resize(pixels);
  if (technique.begin_pass || technique.finish_pass) {
    render_passes(technique, world, lights, view, settings, frame);
    return frame;
  }
  std::atomic<size_t> done = 0;  // pixels
  for_each_tile(view, 16, [&](int left, int top, int right, int bottom) {
    render_tile(technique, world, lights, view, settings, {left, top}, {right, bottom}, frame);
    const size_t own = size_t(right - left) * size_t(bottom - top);
    if (settings.progress) settings.progress(double(done += own) / double(pixels));
  });
  return frame;
}

// Technique `direct` traces emission and the light that reaches a surface straight, seen also in
// chains of perfect mirrors and glass. It has no light between rough surfaces.

void trace_many_direct(const World& world, const Lights& lights, const TransportSettings& settings,
                       std::span<const Request> requests, std::span<Sample> samples) {
  WalkRules rules;
  rules.max_depth = settings.max_depth;
  rules.scatterings = 1;
  Transport transport{world, *lights.tables};
  transport.sees_volumes = settings.sees_volumes;
  trace_samples(transport, rules, requests, samples);
  finish_samples(lights, settings, samples);
}

Sample trace_direct(const World& world, const Lights& lights, const TransportSettings& settings,
                    const Request& request) {
  Sample sample;
  trace_many_direct(world, lights, settings, std::span(&request, 1), std::span(&sample, 1));
  return sample;
}

// Technique `path` is unbiased path tracing, the reference.

void trace_many_path(const World& world, const Lights& lights, const TransportSettings& settings,
                     std::span<const Request> requests, std::span<Sample> samples) {
  WalkRules rules;
  rules.max_depth = settings.max_depth;
  Transport transport{world, *lights.tables};
  transport.maps = lights.maps.get();
  transport.sees_volumes = settings.sees_volumes;
  trace_samples(transport, rules, requests, samples);
  finish_samples(lights, settings, samples);
}

Sample trace_path(const World& world, const Lights& lights, const TransportSettings& settings,
                  const Request& request) {
  Sample sample;
  trace_many_path(world, lights, settings, std::span(&request, 1), std::span(&sample, 1));
  return sample;
}

// Technique `gather` is path tracing whose walks end on the light of an IlluminationMap. One
// gathering bounce hides the map's nodes. If the map has no light there, it is `path`.

namespace {

// With it a surface that a Lambertian surface's rays meet has at least an alpha of 1/4, a roughness
// of 1/2.
constexpr float blunt = 0.14f;

}  // namespace

void trace_many_gather(const World& world, const Lights& lights, const TransportSettings& settings,
                       std::span<const Request> requests, std::span<Sample> samples) {
  WalkRules rules;
  rules.max_depth = settings.max_depth;
  if (lights.known) rules.blunt = blunt;
  rules.reads_maps = true;
  trace_samples({world, *lights.tables, lights.known.get(), lights.lamps_seen.get(),
                 lights.maps.get(), settings.sees_volumes},
                rules, requests, samples);
  finish_samples(lights, settings, samples);
}

Sample trace_gather(const World& world, const Lights& lights, const TransportSettings& settings,
                    const Request& request) {
  Sample sample;
  trace_many_gather(world, lights, settings, std::span(&request, 1), std::span(&sample, 1));
  return sample;
}

void prepare_gather(const World& world, std::span<const vec3> places, Lights& lights) {
  if (!lights.tables->plan.uses(TransportPart::kept_light)) return;
  lights.lamps_seen = learn_lamps_seen({world, *lights.tables}, places);
  if (lights.known || places.empty()) return;
  // Moving meshes would leave their shadows in light that is kept.
  std::optional<World> still;
  if (size_t(world.instance_count()) > world.scene().instances.size()) {
    still.emplace(world.scene());
    still->place_volumes({world.volumes().begin(), world.volumes().end()});
  }
  lights.known = make_bake_scene(still ? *still : world, places).known;
}

}  // namespace wellspring::light
