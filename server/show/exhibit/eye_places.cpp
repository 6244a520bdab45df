// SPDX-License-Identifier: Apache-2.0
#include "show/exhibit/eye_places.h"

namespace wellspring {

std::vector<vec3> eye_places(const Exhibit& exhibit) {
  std::vector<vec3> places;
  for (const ExhibitViewpoint& viewpoint : exhibit.viewpoints)
    places.push_back(vec3(viewpoint.view.position - exhibit.scene.origin));
  for (size_t i = 1, count = places.size(); i < count; i++)
    places.push_back(0.5f * (places[i - 1] + places[i]));
  return places;
}

}  // namespace wellspring
