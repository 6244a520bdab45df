// SPDX-License-Identifier: Apache-2.0
// Makes volumes of solids that are known, and surfaces, for tests of comparisons. All lengths are
// in voxels of one millimetre.
#pragma once
#include <cmath>
#include <cstring>
#include <map>
#include <memory>

#include "base/parallel.h"
#include "volume/compare/surface_mesh.h"
#include "volume/volume.h"

namespace wellspring::test {

inline constexpr double solid_voxel = 0.001;  // metres

inline Volume volume_of_floats(glm::ivec3 size, const std::vector<float>& values) {
  Volume volume;
  volume.size = size, volume.kind = SampleKind::f32;
  const std::shared_ptr<std::byte[]> bytes(new std::byte[values.size() * sizeof(float)]);
  std::memcpy(bytes.get(), values.data(), values.size() * sizeof(float));
  volume.bytes = std::shared_ptr<const std::byte>(bytes, bytes.get());
  volume.to_metres = glm::scale(dmat4(1), dvec3(solid_voxel));
  return volume;
}

// Returns a solid's share of each voxel, times 1000, by its signed distance (negative inside).
template <class SignedDistance>
Volume solid_volume(glm::ivec3 size, const SignedDistance& distance) {
  Grid grid(size);
  parallel_each(size.z, [&](int z) {
    for (int y = 0; y < size.y; y++)
      for (int x = 0; x < size.x; x++)
        grid.at(x, y, z) = 1000 * std::clamp(float(0.5 - distance(dvec3(x, y, z))), 0.0f, 1.0f);
  });
  return volume_of_floats(size, grid.values);
}

// Blurs a volume of floats by a Gaussian, with its border going on.
inline Volume blurred(const Volume& volume, double sigma) {
  Grid from = to_grid(volume);
  const int reach = int(std::ceil(3.5 * sigma));
  std::vector<float> weights;
  double sum = 0;
  for (int i = -reach; i <= reach; i++) sum += std::exp(-i * i / (2 * sigma * sigma));
  for (int i = -reach; i <= reach; i++)
    weights.push_back(float(std::exp(-i * i / (2 * sigma * sigma)) / sum));
  for (int axis = 0; axis < 3; axis++) {
    Grid to(from.size);
    const ptrdiff_t step = axis == 0 ? 1 : axis == 1 ? from.size.x : from.size.x * from.size.y;
    parallel_each(from.size.z, [&](int z) {
      for (int y = 0; y < from.size.y; y++)
        for (int k = -reach; k <= reach; k++) {
          const float weight = weights[size_t(k + reach)];
          for (int x = 0; x < from.size.x; x++) {
            const int at = axis == 0 ? x : axis == 1 ? y : z;
            const int last = from.size[axis] - 1;
            const int beside = std::clamp(at + k, 0, last) - at;
            const size_t index = from.index(x, y, z);
            to.values[index] += weight * from.values[size_t(ptrdiff_t(index) + beside * step)];
          }
        }
    });
    from = std::move(to);
  }
  Volume result = volume_of_floats(from.size, from.values);
  result.to_metres = volume.to_metres;
  return result;
}

inline double box_distance(dvec3 from, dvec3 low, dvec3 high) {
  const dvec3 beyond = glm::max(low - from, from - high);
  const double outside = glm::length(glm::max(beyond, dvec3(0)));
  return outside > 0 ? outside : std::max({beyond.x, beyond.y, beyond.z});
}

// Returns a box whose faces are cut into squares, two triangles each.
inline SurfaceMesh box_mesh(dvec3 low, dvec3 high, int squares) {
  SurfaceMesh mesh;
  for (int axis = 0; axis < 3; axis++)
    for (int side = 0; side < 2; side++)
      for (int i = 0; i < squares; i++)
        for (int j = 0; j < squares; j++) {
          const uint32_t first = uint32_t(mesh.positions.size());
          for (int corner = 0; corner < 4; corner++) {
            dvec3 share(side);
            share[(axis + 1) % 3] = double(i + (corner & 1)) / squares;
            share[(axis + 2) % 3] = double(j + (corner >> 1)) / squares;
            mesh.positions.push_back((low + (high - low) * share) * solid_voxel);
          }
          const uint32_t a = first, b = first + 1, c = first + 2, d = first + 3;
          if (side) mesh.triangles.insert(mesh.triangles.end(), {{a, b, d}, {a, d, c}});
          else mesh.triangles.insert(mesh.triangles.end(), {{a, d, b}, {a, c, d}});
        }
  weld(mesh);
  return mesh;
}

// Returns a sphere, of a box whose faces are blown up.
inline SurfaceMesh sphere_mesh(dvec3 middle, double radius, int squares) {
  SurfaceMesh mesh = box_mesh(dvec3(-1), dvec3(1), squares);
  for (dvec3& position : mesh.positions)
    position = (middle + glm::normalize(position) * radius) * solid_voxel;
  weld(mesh);
  return mesh;
}

}  // namespace wellspring::test
