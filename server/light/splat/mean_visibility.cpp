// SPDX-License-Identifier: Apache-2.0
#include "light/splat/mean_visibility.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "light/splat/shadow_packet.h"
#include "light/splat/splat_lights.h"

namespace wellspring::light {
namespace {

// Of light `i`; 1 where no probe would have any.
vec3 find_share(const Transport& transport, std::span<const LitProbe> probes,
                std::span<const ShadowOrigin> origins, int rays, const VirtualLights& lights,
                size_t i, std::vector<float>& effect) {
  float sum = 0;
  for (size_t k = 0; k < probes.size(); k++)
    sum += effect[k] = luminance(
        bounded_light(eval_virtual_light(lights, i, probes[k].position, probes[k].normal)));
  if (!(sum > 0) || !std::isfinite(sum)) return vec3(1);
  // Evenly spaced numbers along the running sum, of each light others.
  constexpr double golden = 0.6180339887498949;
  double next = std::fmod(double(i) * golden, 1.0), passed = 0;
  const double step = double(sum) / rays;
  vec3 share(0);
  ShadowPacket packet(transport);
  auto arrive = [&](uint32_t, vec3 tint) { share += tint; };
  for (size_t k = 0; k < probes.size(); k++)
    for (passed += double(effect[k]) / step; next < passed; next++) {
      packet.add(origins[k], lights.target[i], uint32_t(k));
      if (packet.full()) packet.cast(arrive);
    }
  packet.cast(arrive);
  return share / float(rays);
}

void move_light(VirtualLights& lights, size_t from, size_t to, vec3 share) {
  for (RawVector<float>* column :
       {&lights.x, &lights.y, &lights.z, &lights.nx, &lights.ny, &lights.nz, &lights.red,
        &lights.green, &lights.blue, &lights.radius2})
    (*column)[to] = (*column)[from];
  lights.target[to] = lights.target[from];
  lights.red[to] *= share.x, lights.green[to] *= share.y, lights.blue[to] *= share.z;
}

}  // namespace

void dim_hidden_lights(const Transport& transport, std::span<const LitProbe> probes, int rays,
                       VirtualLights& lights) {
  if (probes.empty() || rays < 1) return;
  std::vector<ShadowOrigin> origins;
  const bool apart = transport.world.any_apart();
  for (const LitProbe& probe : probes)
    origins.push_back(shadow_origin(probe.position, probe.normal, probe.depth, apart));
  std::vector<vec3> shares(static_cast<size_t>(lights.count));
  parallel_ranges(lights.count, 16, [&](int begin, int end) {
    std::vector<float> effect(probes.size());
    for (int i = begin; i < end; i++)
      shares[size_t(i)] = find_share(transport, probes, origins, rays, lights, size_t(i), effect);
  });
  int kept = 0;
  for (int i = 0; i < lights.count; i++)
    if (max_component(shares[size_t(i)]) > 0)
      move_light(lights, size_t(i), size_t(kept++), shares[size_t(i)]);
  lights.count = kept;
  fill_up(lights);
}

}  // namespace wellspring::light
