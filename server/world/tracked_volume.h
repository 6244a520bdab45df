// SPDX-License-Identifier: Apache-2.0
// Volumes of a World made ready for single rays, which meet their matter by chance.
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "volume/draw/track.h"
#include "world/placed_volume.h"

namespace wellspring::world {

struct Ray;
struct VolumeHit;

// Borrows a PlacedVolume.
struct TrackedVolume {
  Bounds box;  // scene coordinates
  ToVolume to_volume;
  Tracker tracker;
  std::optional<Tracker> over{};  // VolumeLook::over
  float share = 0;                // chance that a ray meets `over`
  uint32_t object = 0, number = 0;
};

// Returns those that show something at all. Borrows them.
std::vector<TrackedVolume> track_volumes(std::span<const PlacedVolume> volumes);

// Returns where the nearest volume stops the ray before t_end (World::meet_volume).
std::optional<VolumeHit> meet(std::span<const TrackedVolume> volumes, const Ray& ray, float t_end,
                              bool maxima);
// Returns light that glowing volumes send along the ray before t_end (World::volume_glow).
vec3 glow(std::span<const TrackedVolume> volumes, const Ray& ray, float t_end);
// Returns whether one is in the way of the ray.
bool shades(std::span<const TrackedVolume> volumes, const Ray& ray);

}  // namespace wellspring::world
