// SPDX-License-Identifier: Apache-2.0
// Key frames as a glTF file has them (glTF 2.0 section 3.11): STEP, LINEAR (spherical for
// rotations) and CUBICSPLINE, appendix C.
#pragma once
#include <string>
#include <vector>

#include "gltf/node.h"

namespace wellspring::gltf {

enum class Path { none, translation, rotation, scale, weights };
enum class Curve { step, linear, cubic };

// A channel with its data: `width` numbers a key, three times as many for cubic curves (in-tangent,
// value, out-tangent). Times do not decrease; all numbers are finite.
struct Track {
  Path path = Path::none;
  Curve curve = Curve::linear;
  size_t node = 0;
  size_t width = 0;
  std::vector<float> times, values;
};

struct Clip {
  std::string name;
  std::vector<Track> tracks;
};

double length_of(const Clip& clip);  // seconds until its last key
// Puts what the tracks move to where they have it then; every track has a key. Before its first
// and after its last key a track holds still. place_nodes() (gltf/pose.h) does the rest.
void move_nodes(const Clip& clip, double time, std::vector<Node>& nodes);

}  // namespace wellspring::gltf
