// SPDX-License-Identifier: Apache-2.0
#include "volume/compare/ray_profile.h"

#include <algorithm>

#include "volume/compare/ray_lanes.h"

namespace wellspring::volume {

RayProfile ray_profile(const DensityField& field, const SurfacePoint& point,
                       const Deviation& deviation, const ConeSettings& settings) {
  RayProfile profile;
  const vec3 ray = deviation.found ? deviation.ray : point.normal;
  const LineScale scale = line_scale(field, ray, settings.threshold);
  LineBatch line;
  line.middle = all_lanes(vec3(field.to_index * glm::dvec4(point.position, 1)));
  line.step = all_lanes(scale.step);
  const double reach = std::clamp(settings.reach, 1.0, longest_reach - 1) * field.voxel;
  const int steps = std::clamp(int(reach / scale.metres), 1, most_line_steps - 1);
  const std::vector<float> slopes = line_slopes(field, line, steps);
  for (int i = -steps; i <= steps; i++) {
    profile.places.push_back(i * scale.metres);
    profile.slopes.push_back(double(slopes[size_t(i + steps)]) / scale.metres);
  }
  profile.threshold = scale.threshold / scale.metres;
  profile.found = deviation.found;
  profile.distance = deviation.distance;
  profile.boundary = -profile.distance;
  return profile;
}

}  // namespace wellspring::volume
