// SPDX-License-Identifier: Apache-2.0
#include "volume/reconstruct/normal_grid.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace wellspring::volume {

uint32_t pack_normal(glm::dvec3 direction) {
  // Squares of floats neither overflow nor vanish in double.
  const double length = glm::length(direction);
  if (!(length > 0)) return 0;
  auto part = [&](double along) {
    return uint32_t(int(std::lrint(along / length / double(normal_step)))) & 1023u;
  };
  return part(direction.x) | part(direction.y) << 10 | part(direction.z) << 20;
}

NormalGrid make_normals(const Grid& grid) {
  NormalGrid normals{grid.size, std::vector<uint32_t>(grid.values.size())};
  const size_t row = size_t(grid.size.x), slice = row * size_t(grid.size.y);
  parallel_each(grid.size.z, [&](int z) {
    for (int y = 0; y < grid.size.y; y++)
      for (int x = 0; x < grid.size.x; x++) {
        const size_t index = grid.index(x, y, z);
        // Returns how fast values fall along an axis of which this is sample `at`.
        auto fall = [&](int at, int size, size_t stride) {
          const int before = at > 0, after = at + 1 < size;
          if (before + after == 0) return 0.0;
          return (double(grid.values[index - size_t(before) * stride]) -
                  double(grid.values[index + size_t(after) * stride])) /
                 (before + after);
        };
        normals.words[index] = pack_normal(
            {fall(x, grid.size.x, 1), fall(y, grid.size.y, row), fall(z, grid.size.z, slice)});
      }
  });
  return normals;
}

}  // namespace wellspring::volume
