// SPDX-License-Identifier: Apache-2.0
// A surface that is compared with a volume, and points on it from which is measured.
#pragma once
#include <cstddef>
#include <vector>

#include "base/vec.h"

namespace wellspring::volume {

// Holds triangles, counter-clockwise seen from outside the material. Positions are in metres; those
// that are not finite, and triangles without an area, are allowed and measure nothing.
struct SurfaceMesh {
  std::vector<dvec3> positions;
  std::vector<vec3> normals;  // per vertex: unit, outwards; 0 where no triangle has an area
  std::vector<uvec3> triangles;
};

// Makes one vertex of those at the same place, so that edges of hard normals are edges, and gives
// each the normal of its triangles weighted by their angles (Thürmer and Wüthrich 1998). Throws
// std::invalid_argument if a triangle names a vertex that is not there.
void weld(SurfaceMesh& mesh);

// Returns the mesh with all positions and normals moved. `move` must be rigid.
SurfaceMesh moved(const SurfaceMesh& mesh, const dmat4& move);

// A point from which is measured. The axis of its double cone is the normal.
struct SurfacePoint {
  dvec3 position{0};       // metres
  vec3 normal{0};          // unit, outwards
  float search_angle = 0;  // radians: half the cone's opening
  double area = 0;         // square metres that the point stands for
};

// Returns points that lie evenly on the triangles: each is cut into equal ones, whose longest edge
// is at most `spacing` metres, if there are not more than `most` points; their axis is the
// triangle's normal. The search angle is the largest angle from the triangle's normal to those of
// its vertices (section 3.1). Triangles without an area have no points.
std::vector<SurfacePoint> triangle_points(const SurfaceMesh& mesh, double spacing, size_t most);

// Returns a point for each vertex, in order: the axis is the vertex's normal, the search angle is
// the largest of its triangles, the area is 0.
std::vector<SurfacePoint> vertex_points(const SurfaceMesh& mesh);

// Counts the triangles without an area, or that are not finite.
size_t flat_triangles(const SurfaceMesh& mesh);

}  // namespace wellspring::volume
