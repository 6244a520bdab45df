// SPDX-License-Identifier: Apache-2.0
// X3D geometry nodes as triangles: polygons cut, normals made, corners that agree in everything
// welded.
#pragma once
#include <optional>

#include "avatar/load/x3d_node.h"

namespace wellspring {

struct X3dMesh {
  std::vector<vec3> points;        // the Coordinate's points, or the primitive's
  int coordinate = -1;             // node that holds them; -1: a primitive
  std::vector<uint32_t> point_of;  // one a vertex: into points
  std::vector<vec3> normals;       // one a vertex, unit length
  std::vector<vec2> uv;            // one a vertex or empty; (0,0) bottom left as X3D has it
  std::vector<uvec3> triangles;    // into the vertices
  bool solid = true;               // seen from the front only
  std::optional<vec3> color;       // mean of the Color node, as written
};

// Triangles of a geometry node; no triangles where the type is none that has a surface or is
// unsupported (a warning names it). Faces with indices out of range are left out with a warning.
X3dMesh make_x3d_mesh(X3dFile& file, int geometry);

// The mesh of Box, Sphere, Cylinder or Cone.
X3dMesh make_x3d_primitive(const X3dFile& file, const X3dNode& node);

}  // namespace wellspring
