// SPDX-License-Identifier: Apache-2.0
#include "light/technique/technique.h"

#include <atomic>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/parallel.h"
#include "base/raw_vector.h"
#include "base/rng.h"
#include "light/instant/instant_radiosity.h"
#include "light/instant/instant_samples.h"
#include "light/splat/splat_technique.h"
#include "light/technique/pixel_requests.h"
#include "light/technique/technique_list.h"

namespace wellspring::light {
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

// Pixels a side of what trace_many gets at once: neighbours, in the same cache.
constexpr int pass_tile = 24;
// Samples of a tile that it gets at once elsewhere: few enough to stay in a core's cache.
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

// What a picture says of a pixel beside its colour: what its first sample hit.
void describe_pixel(const View& view, const Request& request, const Sample& sample, Frame& frame) {
  bool hit = sample.flags & sample_hit;
  frame.object[request.pixel] = hit ? sample.object : 0;
  frame.depth[request.pixel] = hit ? sample.distance * dot(request.ray.direction, view.forward)
                                   : std::numeric_limits<float>::infinity();
}

// Calls `shade(left, top, right, bottom)` for every tile, all cores.
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

// The samples of a tile follow each other pixel by pixel, so that a pixel's sum never leaves the
// core.
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

}  // namespace wellspring::light
