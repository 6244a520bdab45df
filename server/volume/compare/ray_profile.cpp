// SPDX-License-Identifier: Apache-2.0
#include "volume/compare/ray_profile.h"

#include <algorithm>

#include "volume/compare/ray_lanes.h"

namespace wellspring::volume {

RayProfile ray_profile(const DensityField& field, const SurfacePoint& point,
                       const Deviation& deviation, const ConeSettings& settings) {
  RayProfile profile;
  const double step = field.voxel / steps_per_voxel;
  const vec3 ray = deviation.found ? deviation.ray : point.normal;
  LineBatch line;
  line.middle = all_lanes(vec3(field.to_index * glm::dvec4(point.position, 1)));
  line.step = all_lanes(vec3(glm::dmat3(field.to_index) * dvec3(ray) * step));
  const int steps = int(std::clamp(settings.reach, 1.0, longest_reach - 1) * steps_per_voxel);
  const std::vector<float> slopes = line_slopes(field, line, steps);
  for (int i = -steps; i <= steps; i++) {
    profile.places.push_back(i * step);
    profile.slopes.push_back(double(slopes[size_t(i + steps)]) / step);
  }
  profile.threshold = slope_threshold(field, settings);
  profile.found = deviation.found;
  profile.distance = deviation.distance;
  profile.boundary = -profile.distance;
  return profile;
}

}  // namespace wellspring::volume
