// SPDX-License-Identifier: Apache-2.0
// Key frames of a glTF file: STEP, LINEAR (spherical for rotations) and CUBICSPLINE, appendix C.
#pragma once
#include <string>
#include <vector>

#include "gltf/file.h"
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

// Every animation of the file with its data; checked as animate() does.
std::vector<Clip> read_clips(File& file, const std::vector<Node>& nodes);

// Checks every animation's layout and the first one's data; then, unless `time` is 0, moves `nodes`
// to where the first animation has them. Before its first and after its last key a channel holds
// still.
void animate(File& file, double time, std::vector<Node>& nodes);

}  // namespace wellspring::gltf
