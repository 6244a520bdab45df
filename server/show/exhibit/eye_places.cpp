// SPDX-License-Identifier: Apache-2.0
#include "show/exhibit/eye_places.h"

#include <algorithm>

namespace wellspring::show {

std::vector<vec3> eye_places(const Exhibit& exhibit) {
  std::vector<vec3> places;
  for (const ExhibitViewpoint& viewpoint : exhibit.viewpoints)
    places.push_back(vec3(viewpoint.view.position - exhibit.scene.origin));
  for (size_t i = 1, count = places.size(); i < count; i++)
    places.push_back(0.5f * (places[i - 1] + places[i]));
  return places;
}

std::vector<vec3> all_eye_places(const Exhibit& exhibit) {
  constexpr int most_along = 9;
  std::vector<vec3> places = eye_places(exhibit);
  if (!exhibit.walk || !exhibit.walk->bounds) return places;
  const auto& bounds = *exhibit.walk->bounds;
  const dvec3 size = bounds.high - bounds.low;
  const double step = std::max(size.x, size.z) / most_along;
  if (!(step > 0)) return places;
  for (double x = bounds.low.x + 0.5 * step; x < bounds.high.x; x += step)
    for (double z = bounds.low.z + 0.5 * step; z < bounds.high.z; z += step)
      places.push_back(vec3(dvec3(x, bounds.low.y + double(exhibit.walk->eye_height), z) -
                            exhibit.scene.origin));
  return places;
}

}  // namespace wellspring::show
