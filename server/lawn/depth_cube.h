// SPDX-License-Identifier: Apache-2.0
// A depth cube map of a mesh: six pictures of it, from the faces of the cube around it (Orthmann,
// Rezk-Salama, Kolb, section 5.2; Kolb, Latta, Rezk-Salama, "Hardware-based Simulation and
// Collision Detection for Large Particle Systems", 2004). With d_i(v) the distance from v down to
// the surface that face i sees in v's column (equations 1 and 2), below 0 behind it:
//   v is inside if all six d_i are below 0; d(v) is then the largest of them,
//   else the smallest of those above 0 (equation 3).
// The text has it the other way round, "if the six do not yield a value less than zero", which
// contradicts both equations.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"

namespace wellspring::lawn {

class DepthCube {
 public:
  // Draws the mesh; corners of triangles that are no places, or not finite, make them be left out.
  // `side`: pixels of a picture's side, 1 to 1024. A figure that moves gets a new one each tick.
  DepthCube(std::span<const vec3> places, std::span<const uvec3> triangles, int side = 64);

  // Holds d(v), infinity if no face sees anything there, and how to get out from inside: the unit
  // normal of the surface which lies nearest along an axis, and that axis.
  struct Depth {
    float distance = 0;
    vec3 normal{0, 1, 0}, axis{0, 1, 0};
  };
  Depth at(vec3 v) const;
  // Describe the box around the mesh: its middle, and half of its sides.
  vec3 middle() const { return middle_; }
  vec3 half_size() const { return half_size_; }

 private:
  struct Texel {
    float height;  // from the middle to the surface, along the face's outward axis
    vec3 normal;
  };
  void draw(const std::array<vec3, 3>& corner);

  int side_;
  vec3 middle_{0}, half_size_{0};
  float half_ = 0;                          // half the cube's side, metres; 0: there is nothing
  std::array<std::vector<Texel>, 6> face_;  // +x, -x, +y, -y, +z, -z
};

}  // namespace wellspring::lawn
