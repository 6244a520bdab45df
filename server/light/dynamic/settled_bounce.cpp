// SPDX-License-Identifier: Apache-2.0
#include "light/dynamic/settled_bounce.h"

#include <algorithm>

#include "base/memory.h"
#include "base/parallel.h"

namespace wellspring {
namespace {

constexpr int settles_after = 12;  // pictures

bool shine_alike(const DynamicLight& a, const DynamicLight& b) {
  const PunctualLight &one = a.light, &two = b.light;
  return a.id == b.id && a.radius == b.radius && one.type == two.type &&
         one.position == two.position && one.direction == two.direction &&
         one.intensity == two.intensity && one.range == two.range &&
         one.inner_cone == two.inner_cone && one.outer_cone == two.outer_cone;
}

SplatSettings later_passes(SplatSettings settings) {
  settings.visibility = true;
  // Many passes have many rays; neighbours need not help them much.
  settings.shadow_rays = 2, settings.probe_rays = 0, settings.smooth_visibility = 1;
  return settings;
}

void mix_plane(const RawVector<float>& from, float share, RawVector<float>& to) {
  parallel_ranges(int(to.size()), 16384, [&](int begin, int end) {
    for (size_t i = size_t(begin); i < size_t(end); i++) to[i] += (from[i] - to[i]) * share;
  });
}

void add_plane(const RawVector<float>& from, RawVector<float>& to) {
  parallel_ranges(int(to.size()), 16384, [&](int begin, int end) {
    for (size_t i = size_t(begin); i < size_t(end); i++) to[i] += from[i];
  });
}

}  // namespace

size_t memory_bytes(const SettledBounce& settled) {
  return bytes_of(settled.last, settled.lights) + memory_bytes(settled.mean);
}

void take_settled(SettledBounce& settled, DynamicLights& from) {
  std::vector<SettledBounce::Unchanged> now;
  DynamicLights stay, others;
  for (const DynamicLight& light : from) {
    const auto before =
        std::find_if(settled.last.begin(), settled.last.end(),
                     [&](const auto& one) { return shine_alike(one.light, light); });
    const int pictures = before == settled.last.end() ? 0 : before->pictures + 1;
    now.push_back({light, pictures});
    (pictures >= settles_after ? stay : others).push_back(light);
  }
  settled.last = std::move(now);
  if (!std::equal(stay.begin(), stay.end(), settled.lights.begin(), settled.lights.end(),
                  shine_alike))
    settled.pictures = -1, settled.passes = 0;
  settled.pictures++;
  settled.lights = std::move(stay);
  from = std::move(others);
}

bool wants_pass(const SettledBounce& settled) {
  if (settled.lights.empty()) return false;
  return settled.pictures % (settled.passes < most_passes ? between_passes : between_late) == 0;
}

void add_pass(const World& world, const Lights& lights, const SurfaceBuffer& surfaces,
              const SplatSettings& settings, SettledBounce& settled, DynamicBounce& bounce) {
  const int pass = settled.passes++;
  const SplatSeed seed{1, uint32_t(pass)};
  const SplatSettings used = pass > 0 ? later_passes(settings) : settings;
  LightPlanes light;
  clear_planes(surfaces, light);
  begin_bounce(world, lights, settled.lights, used, seed, bounce);
  add_bounce(world, lights, surfaces, used, seed, bounce, light);
  LightPlanes& mean = settled.mean;
  if (pass == 0) {
    mean = std::move(light);
    return;
  }
  const float share = 1 / float(first_weight + std::min(pass, most_passes));
  mix_plane(light.red, share, mean.red), mix_plane(light.green, share, mean.green);
  mix_plane(light.blue, share, mean.blue);
}

void add_settled(const SettledBounce& settled, LightPlanes& light) {
  if (settled.lights.empty()) return;
  add_plane(settled.mean.red, light.red), add_plane(settled.mean.green, light.green);
  add_plane(settled.mean.blue, light.blue);
}

}  // namespace wellspring
