// SPDX-License-Identifier: Apache-2.0
#include "base/parallel.h"
#include "volume/compare/registration.h"

namespace wellspring::volume {

namespace {

// Calls each(place in index) where the density crosses the split within a slice or towards the
// next.
template <class Each>
void each_crossing(const DensityField& field, int z, const Each& each) {
  const Grid& grid = field.grid;
  const float split = float(field.split);
  for (int y = 0; y < grid.size.y; y++)
    for (int x = 0; x < grid.size.x; x++) {
      const float here = grid.at(x, y, z);
      auto look = [&](int axis, float there) {
        if ((here < split) == (there < split)) return;
        dvec3 place(x, y, z);
        place[axis] += double(split - here) / double(there - here);
        each(place);
      };
      if (x + 1 < grid.size.x) look(0, grid.at(x + 1, y, z));
      if (y + 1 < grid.size.y) look(1, grid.at(x, y + 1, z));
      if (z + 1 < grid.size.z) look(2, grid.at(x, y, z + 1));
    }
}

}  // namespace

std::vector<dvec3> boundary_points(const DensityField& field, size_t most) {
  const int slices = field.grid.size.z;
  std::vector<size_t> before(size_t(slices) + 1, 0);
  parallel_each(slices, [&](int z) {
    size_t count = 0;
    each_crossing(field, z, [&](dvec3) { count++; });
    before[size_t(z) + 1] = count;
  });
  for (size_t z = 0; z < size_t(slices); z++) before[z + 1] += before[z];
  const size_t every = most > 0 ? before.back() / most + 1 : 1;
  std::vector<dvec3> points((before.back() + every - 1) / every);
  parallel_each(slices, [&](int z) {
    size_t at = before[size_t(z)];
    each_crossing(field, z, [&](dvec3 place) {
      if (at % every == 0) points[at / every] = dvec3(field.to_metres * glm::dvec4(place, 1));
      at++;
    });
  });
  return points;
}

}  // namespace wellspring::volume
