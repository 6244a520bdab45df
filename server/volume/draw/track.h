// SPDX-License-Identifier: Apache-2.0
// Follows one ray through a volume by chance, to the place where matter stops it, so that the mean
// of many rays is the light that march() adds up, without an error by steps. Collisions are drawn
// by the largest density of each cell and thinned out by what is there (Woodcock et al. 1965,
// "Techniques used in the GEM code"; by cells: Szirmay-Kalos, Toth, Magdics 2011, "Free Path
// Sampling in High Resolution Inhomogeneous Participating Media").
#pragma once
#include <limits>
#include <span>

#include "base/rng.h"
#include "volume/draw/along_ray.h"
#include "volume/draw/march.h"

namespace wellspring::volume {

// A ray in the frame of Volume::to_metres: a unit direction, and metres from which, and to which,
// it is followed.
struct VolumeRay {
  vec3 origin{0}, direction{0, 0, -1};
  float near = 0, far = std::numeric_limits<float>::infinity();
};

struct TrackSettings {
  int level = 0;      // the finest whole one, if that is coarser
  float step = 0.7f;  // samples of the level from look to look for a surface, or the maximum
  std::span<const VolumeCut> cuts;
};

struct TrackedRay {
  float distance = std::numeric_limits<float>::infinity();  // metres; infinity: nothing stopped it
  vec3 color{0};      // linear light that the matter there sends back along the ray
  int64_t reads = 0;  // places whose value was read
  bool is_stopped() const { return distance < std::numeric_limits<float>::infinity(); }
};

// Tracks rays through a drawn preset. Borrows all of it.
class Tracker {
 public:
  Tracker(const ShownVolume& volume, const DrawnPreset& preset, const TrackSettings& settings);

  // Finds where the ray is stopped: with density at a place drawn by the light that comes through;
  // at the first surface; and where the value is largest, with its opacity as the chance.
  TrackedRay track(const VolumeRay& ray, Rng& random) const;
  // Does the same without colour. No value casts a shadow as the largest of a ray.
  TrackedRay track_shadow(const VolumeRay& ray, Rng& random) const;
  // Returns the light that the matter of a glowing volume sends along the ray, from one place of
  // it: the mean of many is all of it. It stops no ray.
  vec3 glow(const VolumeRay& ray, Rng& random) const;
  VolumeMode mode() const { return preset_->table.mode(); }
  bool is_empty() const { return empty_; }  // nothing stops any ray

 private:
  class Flight;
  const ShownVolume* volume_;
  const DrawnPreset* preset_;
  TrackSettings settings_;
  ToSamples to_samples_;
  bool empty_ = false;
};

}  // namespace wellspring::volume
