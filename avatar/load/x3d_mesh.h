// SPDX-License-Identifier: Apache-2.0
// Turns X3D geometry nodes into triangles: polygons are cut, normals made, and corners welded that
// agree in everything.
#pragma once
#include "avatar/load/x3d_node.h"

namespace wellspring::avatar {

struct X3dMesh {
  std::vector<vec3> points;        // the Coordinate's points, or the primitive's
  int coordinate = -1;             // node that holds the points; -1: a primitive
  std::vector<uint32_t> point_of;  // index into points, one a vertex
  std::vector<vec3> normals;       // one a vertex, unit length
  std::vector<vec2> uv;            // one a vertex or empty; (0,0) bottom left as X3D has it
  std::vector<uvec3> triangles;    // indices of vertices
  bool solid = true;               // seen from the front only
  std::vector<vec4> colors;        // one a vertex or empty, as written; alpha last
};

// Makes triangles of a geometry node; none if its type has no surface or is unsupported (x3d_node.h
// counts those). Faces with indices out of range are left out with a warning, and colours if they
// are too few.
X3dMesh make_x3d_mesh(X3dFile& file, int geometry);

// Makes the mesh of Box, Sphere, Cylinder or Cone.
X3dMesh make_x3d_primitive(const X3dFile& file, const X3dNode& node);

}  // namespace wellspring::avatar
