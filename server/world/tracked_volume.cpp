// SPDX-License-Identifier: Apache-2.0
#include "world/tracked_volume.h"

#include <utility>

#include "world/one_ray.h"
#include "world/world.h"

namespace wellspring::world {
namespace {

constexpr uint32_t no_mesh = 0xffffffffu;  // in place of an instance, in hashes of rays

// Leads a ray into a volume's frame and calls follow() for it, with the look that chance chooses of
// a mixture. `unit` becomes the ray's t for a metre of the volume.
template <class Follow>
auto track_one(const TrackedVolume& volume, const Ray& ray, float t_end, float& unit,
               const Follow& follow) {
  const float length = glm::length(ray.direction);
  if (!(length > 0)) return decltype(follow(volume.tracker, {}, std::declval<Rng&>())){};
  unit = volume.to_volume.scale / length;
  const VolumeRay inside{volume.to_volume.place(ray.origin),
                         volume.to_volume.way(ray.direction / length), ray.t_min / unit,
                         t_end / unit};
  Rng random(hash_ray(ray, no_mesh, volume.number));
  const bool over = volume.over && random.uniform() < volume.share;
  return follow(over ? *volume.over : volume.tracker, inside, random);
}

}  // namespace

std::vector<TrackedVolume> track_volumes(std::span<const PlacedVolume> volumes) {
  std::vector<TrackedVolume> tracked;
  for (size_t i = 0; i < volumes.size(); i++) {
    const PlacedVolume& placed = volumes[i];
    const VolumeLook& look = placed.look;
    if (!placed.volume || !look.preset) continue;
    TrackSettings settings;
    // Light asks for no bricks of what is larger than memory.
    settings.level = placed.shown().whole_level;
    settings.cuts = look.cuts;
    TrackedVolume one{bounds_of(placed), ToVolume(placed),
                      Tracker(placed.shown(), *look.preset, settings)};
    if (look.over && look.share > 0) one.over.emplace(placed.shown(), *look.over, settings);
    if (one.tracker.is_empty() && (!one.over || one.over->is_empty())) continue;
    one.share = look.share, one.object = placed.object, one.number = uint32_t(i);
    tracked.push_back(std::move(one));
  }
  return tracked;
}

std::optional<VolumeHit> meet(std::span<const TrackedVolume> volumes, const Ray& ray, float t_end,
                              bool maxima) {
  std::optional<VolumeHit> nearest;
  for (const TrackedVolume& volume : volumes) {
    if (!meets(volume.box, ray, t_end)) continue;
    float unit = 1;
    const TrackedRay found = track_one(
        volume, ray, t_end, unit,
        [&](const Tracker& tracker, const VolumeRay& inside, Rng& random) {
          return maxima || tracker.mode() != VolumeMode::maximum ? tracker.track(inside, random)
                                                                 : TrackedRay();
        });
    if (!found.is_stopped()) continue;
    t_end = found.distance * unit;
    nearest = VolumeHit{t_end, found.color, volume.object};
  }
  return nearest;
}

vec3 glow(std::span<const TrackedVolume> volumes, const Ray& ray, float t_end) {
  vec3 sum(0);
  float unit = 1;
  for (const TrackedVolume& volume : volumes)
    if (meets(volume.box, ray, t_end))
      sum += track_one(volume, ray, t_end, unit,
                       [](const Tracker& tracker, const VolumeRay& inside, Rng& random) {
                         return tracker.glow(inside, random);
                       });
  return sum;
}

bool shades(std::span<const TrackedVolume> volumes, const Ray& ray) {
  float unit = 1;
  for (const TrackedVolume& volume : volumes)
    if (meets(volume.box, ray, ray.t_max) &&
        track_one(volume, ray, ray.t_max, unit,
                  [](const Tracker& tracker, const VolumeRay& inside, Rng& random) {
                    return tracker.track_shadow(inside, random);
                  })
            .is_stopped())
      return true;
  return false;
}

}  // namespace wellspring::world
