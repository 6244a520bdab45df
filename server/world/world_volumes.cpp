// SPDX-License-Identifier: Apache-2.0
// The volumes and scans of a World.
#include <algorithm>
#include <bit>

#include "world/one_ray.h"
#include "world/world.h"
#include "world/world_impl.h"

namespace wellspring::world {

void World::place_volumes(std::vector<PlacedVolume> volumes) {
  impl_->volumes = std::move(volumes);
  impl_->tracked = track_volumes(impl_->volumes);
}

void World::show_volume(int volume, VolumeLook look) {
  impl_->volumes.at(size_t(volume)).look = std::move(look);
  impl_->tracked = track_volumes(impl_->volumes);
}

std::span<const PlacedVolume> World::volumes() const { return impl_->volumes; }

void World::place_scans(std::vector<PlacedScan> scans) { impl_->scans = std::move(scans); }

void World::show_scan(int scan, const ScanLook& look) { impl_->scans.at(size_t(scan)).look = look; }

std::span<const PlacedScan> World::scans() const { return impl_->scans; }

std::optional<VolumeHit> World::meet_volume(const Ray& ray, float t_end, bool maxima) const {
  if (impl_->tracked.empty()) return {};
  return meet(impl_->tracked, ray, t_end, maxima);
}

bool World::has_volume_on(const Ray& ray, float t_end) const {
  return std::ranges::any_of(impl_->tracked,
                             [&](const TrackedVolume& one) { return meets(one.box, ray, t_end); });
}

vec3 World::volume_glow(const Ray& ray, float t_end) const {
  return impl_->tracked.empty() ? vec3(0) : glow(impl_->tracked, ray, t_end);
}

uint32_t World::Impl::shaded_lanes(const RayPacket& rays, uint32_t active) const {
  Query query;
  query.packet = &rays;
  uint32_t blocked = 0;
  for (uint32_t bits = active; bits; bits &= bits - 1) {
    const int i = std::countr_zero(bits);
    blocked |= uint32_t(shades(tracked, query.ray(unsigned(i)))) << i;
  }
  return blocked;
}

}  // namespace wellspring::world
