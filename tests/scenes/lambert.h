// SPDX-License-Identifier: Apache-2.0
// Irradiance by formula: from polygons (Lambert 1760; Baum, Rushmeier and Winget 1989, section 3),
// from convex bodies, and between parallel plates (Howell's catalogue of configuration factors,
// C-11).
#pragma once
#include <cmath>
#include <vector>

#include "world/scene.h"

namespace wellspring::scenes {

// Returns the part of a polygon above the plane through the origin with normal n (Sutherland and
// Hodgman).
inline std::vector<dvec3> above_horizon(const std::vector<dvec3>& polygon, dvec3 n) {
  std::vector<dvec3> result;
  for (size_t i = 0; i < polygon.size(); i++) {
    dvec3 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    double ha = dot(a, n), hb = dot(b, n);
    if (ha >= 0) result.push_back(a);
    if ((ha > 0 && hb < 0) || (ha < 0 && hb > 0)) result.push_back(a + (b - a) * (ha / (ha - hb)));
  }
  return result;
}

// Irradiance at p on a surface facing n from a polygon of radiance 1 on both sides.
inline double polygon_irradiance(dvec3 p, dvec3 n, std::vector<dvec3> polygon) {
  for (dvec3& corner : polygon) corner -= p;
  polygon = above_horizon(polygon, n);
  double sum = 0;
  for (size_t i = 0; i < polygon.size(); i++) {
    dvec3 a = normalize(polygon[i]), b = normalize(polygon[(i + 1) % polygon.size()]);
    dvec3 edge = cross(a, b);
    double sine = length(edge);
    if (sine > 1e-15) sum += std::atan2(sine, dot(a, b)) * dot(edge / sine, n);
  }
  return std::abs(sum) / 2;
}

// Returns the irradiance from a convex body of radiance 1: the sum over the triangles that face p,
// exact for the body as it is tessellated.
inline double convex_irradiance(dvec3 p, dvec3 n, const Mesh& mesh, const mat4& to_world) {
  double sum = 0;
  for (const uvec3& t : mesh.triangles) {
    dvec3 corner[3];
    for (int i = 0; i < 3; i++) corner[i] = dvec3(vec3(to_world * vec4(mesh.positions[t[i]], 1)));
    if (dot(cross(corner[1] - corner[0], corner[2] - corner[0]), p - corner[0]) > 0)
      sum += polygon_irradiance(p, n, {corner[0], corner[1], corner[2]});
  }
  return sum;
}

// Share of what leaves one of two equal, opposed rectangles (sides x and y times their distance)
// that reaches the other.
inline double opposed_plates_factor(double x, double y) {
  double x1 = 1 + x * x, y1 = 1 + y * y;
  return 2 / (double(pi) * x * y) *
         (0.5 * std::log(x1 * y1 / (x1 + y * y)) +
          x * std::sqrt(y1) * std::atan(x / std::sqrt(y1)) +
          y * std::sqrt(x1) * std::atan(y / std::sqrt(x1)) - x * std::atan(x) - y * std::atan(y));
}

// Reflectance of a smooth boundary between indices 1 and n for unpolarised light (Born and Wolf,
// section 1.5.2).
inline double fresnel(double cosine, double n) {
  double beyond = std::sqrt(1 - (1 - cosine * cosine) / (n * n));
  double p = (n * cosine - beyond) / (n * cosine + beyond);
  double s = (cosine - n * beyond) / (cosine + n * beyond);
  return 0.5 * (p * p + s * s);
}

}  // namespace wellspring::scenes
