// SPDX-License-Identifier: Apache-2.0
#include "volume/compare/surface_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <unordered_map>

#include "base/rng.h"

namespace wellspring::volume {

namespace {

// Cones stay open at least this much, or their rays would run along the surface.
constexpr float widest_search_angle = 80 * pi / 180;
constexpr int most_cuts_of_an_edge = 1024;

double angle_between(dvec3 a, dvec3 b) {  // unit vectors
  return std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0));
}

struct Facet {
  dvec3 corner[3];
  dvec3 normal{0};  // unit
  double area = 0;  // 0: it has none
};

Facet facet_of(const SurfaceMesh& mesh, size_t triangle) {
  Facet facet;
  const uvec3 corners = mesh.triangles[triangle];
  for (int i = 0; i < 3; i++) facet.corner[i] = mesh.positions[corners[i]];
  const dvec3 across =
      glm::cross(facet.corner[1] - facet.corner[0], facet.corner[2] - facet.corner[0]);
  const double length = glm::length(across);
  if (!std::isfinite(length) || !(length > 0)) return facet;
  facet.normal = across / length;
  facet.area = length / 2;
  return facet;
}

double longest_edge(const Facet& facet) {
  double longest = 0;
  for (int i = 0; i < 3; i++)
    longest = std::max(longest, glm::distance(facet.corner[i], facet.corner[(i + 1) % 3]));
  return longest;
}

float search_angle_of(const SurfaceMesh& mesh, size_t triangle, const Facet& facet) {
  double widest = 0;
  for (int i = 0; i < 3; i++) {
    const dvec3 normal(mesh.normals[mesh.triangles[triangle][i]]);
    if (glm::dot(normal, normal) > 0)
      widest = std::max(widest, angle_between(facet.normal, normal));
  }
  // Normals are floats: in planar parts the angle is 0 but for their rounding.
  return widest < 1e-3 ? 0 : std::min(float(widest), widest_search_angle);
}

struct PlaceHash {
  size_t operator()(const dvec3& place) const {
    uint64_t words[3], sum = 0;
    std::memcpy(words, &place, sizeof words);
    for (uint64_t word : words) sum = mix64(sum ^ word);
    return size_t(sum);
  }
};

void join_vertices(SurfaceMesh& mesh) {
  std::unordered_map<dvec3, uint32_t, PlaceHash> known;
  known.reserve(mesh.positions.size());
  std::vector<uint32_t> renamed(mesh.positions.size());
  std::vector<dvec3> kept;
  for (size_t i = 0; i < mesh.positions.size(); i++) {
    const dvec3 place = mesh.positions[i] + 0.0;  // -0 becomes 0
    const auto [found, is_new] = known.try_emplace(place, uint32_t(kept.size()));
    renamed[i] = is_new ? uint32_t(kept.size()) : found->second;
    if (is_new) kept.push_back(place);
  }
  for (uvec3& triangle : mesh.triangles)
    for (int i = 0; i < 3; i++) triangle[i] = renamed[triangle[i]];
  mesh.positions = std::move(kept);
}

}  // namespace

void weld(SurfaceMesh& mesh) {
  for (const uvec3& triangle : mesh.triangles)
    if (std::max({triangle.x, triangle.y, triangle.z}) >= mesh.positions.size())
      throw std::invalid_argument("a triangle names a vertex that is not there");
  join_vertices(mesh);
  std::vector<dvec3> sums(mesh.positions.size(), dvec3(0));
  for (size_t i = 0; i < mesh.triangles.size(); i++) {
    const Facet facet = facet_of(mesh, i);
    if (facet.area == 0) continue;
    for (int k = 0; k < 3; k++) {
      const dvec3 from = facet.corner[k];
      const double angle = angle_between(glm::normalize(facet.corner[(k + 1) % 3] - from),
                                         glm::normalize(facet.corner[(k + 2) % 3] - from));
      if (std::isfinite(angle)) sums[mesh.triangles[i][k]] += facet.normal * angle;
    }
  }
  mesh.normals.assign(mesh.positions.size(), vec3(0));
  for (size_t i = 0; i < sums.size(); i++)
    if (const double length = glm::length(sums[i]); length > 1e-12)
      mesh.normals[i] = vec3(sums[i] / length);
}

SurfaceMesh moved(const SurfaceMesh& mesh, const dmat4& move) {
  SurfaceMesh result = mesh;
  for (dvec3& position : result.positions) position = dvec3(move * glm::dvec4(position, 1));
  for (vec3& normal : result.normals) normal = vec3(glm::dmat3(move) * dvec3(normal));
  return result;
}

std::vector<SurfacePoint> triangle_points(const SurfaceMesh& mesh, double spacing, size_t most) {
  auto cuts = [&](const Facet& facet) {
    const double wanted = std::ceil(longest_edge(facet) / spacing);
    return wanted > 1 ? int(std::min(wanted, double(most_cuts_of_an_edge))) : 1;
  };
  // More space is left until the points are few enough, or are one for each triangle.
  for (int round = 0; round < 64; round++) {
    double count = 0;
    bool can_be_fewer = false;
    for (size_t i = 0; i < mesh.triangles.size(); i++) {
      const Facet facet = facet_of(mesh, i);
      if (facet.area == 0) continue;
      const int along = cuts(facet);
      count += double(along) * along;
      can_be_fewer |= along > 1;
    }
    if (count <= double(most) || !can_be_fewer) break;
    spacing *= std::max(1.05, std::sqrt(count / double(most)));
  }
  std::vector<SurfacePoint> points;
  for (size_t i = 0; i < mesh.triangles.size(); i++) {
    const Facet facet = facet_of(mesh, i);
    if (facet.area == 0) continue;
    const int along = cuts(facet);
    SurfacePoint point;
    point.normal = vec3(facet.normal);
    point.search_angle = search_angle_of(mesh, i, facet);
    point.area = facet.area / (double(along) * along);
    const dvec3 right = (facet.corner[1] - facet.corner[0]) / double(along);
    const dvec3 up = (facet.corner[2] - facet.corner[0]) / double(along);
    for (int y = 0; y < along; y++)
      for (int x = 0; x < along - y; x++) {
        point.position = facet.corner[0] + right * (x + 1 / 3.0) + up * (y + 1 / 3.0);
        points.push_back(point);
        if (x + y + 1 >= along) continue;
        point.position = facet.corner[0] + right * (x + 2 / 3.0) + up * (y + 2 / 3.0);
        points.push_back(point);
      }
  }
  return points;
}

std::vector<SurfacePoint> vertex_points(const SurfaceMesh& mesh) {
  std::vector<SurfacePoint> points(mesh.positions.size());
  for (size_t i = 0; i < points.size(); i++) points[i] = {mesh.positions[i], mesh.normals[i], 0, 0};
  for (size_t i = 0; i < mesh.triangles.size(); i++) {
    const Facet facet = facet_of(mesh, i);
    if (facet.area == 0) continue;
    const float angle = search_angle_of(mesh, i, facet);
    for (int k = 0; k < 3; k++) {
      float& widest = points[mesh.triangles[i][k]].search_angle;
      widest = std::max(widest, angle);
    }
  }
  return points;
}

size_t flat_triangles(const SurfaceMesh& mesh) {
  size_t count = 0;
  for (size_t i = 0; i < mesh.triangles.size(); i++) count += facet_of(mesh, i).area == 0;
  return count;
}

}  // namespace wellspring::volume
