// SPDX-License-Identifier: Apache-2.0
#include "light/dynamic/settled_bounce.h"

#include <algorithm>

#include "base/memory.h"
#include "base/parallel.h"

namespace wellspring::light {
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
  // Of many passes, noise of each is seen less than what takes light from all of them alike.
  settings.shadow_rays = 2, settings.probe_rays = 0, settings.smooth_visibility = 0;
  settings.bound = 0.25f;
  return settings;
}

constexpr RawVector<float> LightPlanes::*planes[] = {&LightPlanes::red, &LightPlanes::green,
                                                     &LightPlanes::blue};

void mix_planes(const LightPlanes& from, float share, LightPlanes& into) {
  for (auto plane : planes) {
    const RawVector<float>& a = from.*plane;
    RawVector<float>& to = into.*plane;
    parallel_ranges(int(to.size()), 16384, [&](int begin, int end) {
      for (size_t i = size_t(begin); i < size_t(end); i++) to[i] += (a[i] - to[i]) * share;
    });
  }
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
  begin_bounce(world, lights, settled.lights, surfaces, used, seed, bounce);
  add_bounce(world, lights, surfaces, used, seed, bounce, light);
  LightPlanes& mean = settled.mean;
  if (pass == 0) {
    mean = std::move(light);
    return;
  }
  const float share = 1 / float(first_weight + std::min(pass, most_passes));
  mix_planes(light, share, mean);
}

void add_settled(const SettledBounce& settled, LightPlanes& light) {
  if (settled.lights.empty()) return;
  for (auto plane : planes) {
    const RawVector<float>& from = settled.mean.*plane;
    RawVector<float>& to = light.*plane;
    parallel_ranges(int(to.size()), 16384, [&](int begin, int end) {
      for (size_t i = size_t(begin); i < size_t(end); i++) to[i] += from[i];
    });
  }
}

}  // namespace wellspring::light
