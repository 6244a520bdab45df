// SPDX-License-Identifier: Apache-2.0
#include "light/technique.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/parallel.h"
#include "base/rng.h"
#include "light/technique_list.h"

namespace wellspring {
namespace {

constexpr Technique list[] = {
    {"path", "unbiased path tracing: all light, the reference", trace_path},
    {"direct", "emission, direct light and chains of perfect mirrors and glass", trace_direct},
    {"gather",
     "path to the first rough surface beyond the eye's, kept light from there: quick, a little "
     "biased",
     trace_gather, prepare_gather},
};

bool is_light(vec3 c) { return is_finite(c) && c.x >= 0 && c.y >= 0 && c.z >= 0; }

}  // namespace

std::span<const Technique> techniques() { return list; }

const Technique* find_technique(std::string_view name) {
  for (const Technique& technique : list)
    if (name == technique.name) return &technique;
  return nullptr;
}

Sample finish_sample(const Lights& lights, const TransportSettings& settings, Sample sample) {
  if (!is_light(sample.albedo) || !is_light(sample.smooth) || !is_light(sample.rest) ||
      !is_light(sample.radiance())) {
    lights.bad_samples->fetch_add(1, std::memory_order_relaxed);
    sample.albedo = sample.smooth = sample.rest = vec3(0);
  }
  if (settings.clamp > 0) {
    float largest = max_component(sample.radiance());
    if (largest > settings.clamp) {
      sample.smooth *= settings.clamp / largest;
      sample.rest *= settings.clamp / largest;
    }
  }
  return sample;
}

void trace(const Technique& technique, const World& world, const Lights& lights,
           const TransportSettings& settings, std::span<const Request> requests,
           std::span<Sample> samples) {
  if (requests.size() != samples.size()) throw std::invalid_argument("trace: one sample a request");
  parallel_ranges(int(requests.size()), 64, [&](int begin, int end) {
    for (int i = begin; i < end; i++)
      samples[size_t(i)] = technique.trace(world, lights, settings, requests[size_t(i)]);
  });
}

Request pixel_request(const View& view, uint64_t seed, int x, int y, int index) {
  Request request;
  request.pixel = uint32_t(y) * uint32_t(view.width) + uint32_t(x);
  request.seed = sample_seed(seed, uint32_t(x), uint32_t(y), uint32_t(index));
  Rng jitter(mix64(request.seed ^ 0x6a09e667f3bcc909ull));  // a stream apart from the sample's own
  float u = jitter.uniform(), v = jitter.uniform();
  request.ray = view_ray(view, float(x) + u, float(y) + v);
  return request;
}

Frame render_still(const Technique& technique, const World& world, const Lights& lights,
                   const View& view, const StillSettings& settings) {
  if (view.width < 1 || view.height < 1 || settings.spp < 1)
    throw std::invalid_argument("render_still: a picture has pixels, and pixels have samples");
  Frame frame;
  frame.width = view.width;
  frame.height = view.height;
  size_t pixels = size_t(view.width) * size_t(view.height);
  frame.color.resize(pixels);
  frame.depth.resize(pixels);
  frame.object.resize(pixels);
  constexpr int tile = 16;
  int across = (view.width + tile - 1) / tile, down = (view.height + tile - 1) / tile;
  parallel_for(across * down, [&](int t) {
    int left = t % across * tile, top = t / across * tile;
    for (int y = top; y < std::min(top + tile, view.height); y++)
      for (int x = left; x < std::min(left + tile, view.width); x++) {
        size_t pixel = size_t(y) * size_t(view.width) + size_t(x);
        dvec3 sum(0);
        for (int i = 0; i < settings.spp; i++) {
          Request request = pixel_request(view, settings.seed, x, y, i);
          Sample sample = technique.trace(world, lights, settings.transport, request);
          sum += dvec3(sample.radiance());
          if (i > 0) continue;
          bool hit = sample.flags & sample_hit;
          frame.object[pixel] = hit ? sample.object : 0;
          frame.depth[pixel] = hit ? sample.distance * dot(request.ray.direction, view.forward)
                                   : std::numeric_limits<float>::infinity();
        }
        frame.color[pixel] = vec3(sum / double(settings.spp));
      }
  });
  return frame;
}

}  // namespace wellspring
