// SPDX-License-Identifier: Apache-2.0
// Sources and settings of an octree of points, and what its maker tells.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "scan/points.h"

namespace wellspring::scan {

// A file that is opened when its turn comes, so that there may be thousands. `open` is called on
// any thread, and throws LoadError. Its name, length and time of change tell whether an import that
// was broken off had the same one.
struct TreeSource {
  std::string file;
  std::function<std::unique_ptr<PointSource>()> open;
};

enum class UpAxis : uint8_t { x, y, z };
// Returns the axis of that name; z for any other.
inline UpAxis up_axis_of(std::string_view name) {
  return name == "x" ? UpAxis::x : name == "y" ? UpAxis::y : UpAxis::z;
}

struct TreeSettings {
  double unit = 0;        // metres of the sources' unit; 0: as each source says
  UpAxis up = UpAxis::z;  // becomes +Y: y is kept, z lies down to (x, z, -y), x to (z, x, y)
  double turn = 0;        // radians around +Y after that, counterclockwise seen from above
  // Bytes of large arrays, at least 48 MiB; what sources themselves need is not counted.
  uint64_t memory = uint64_t(1) << 30;
  uint32_t leaf_points = 100000;    // a leaf has no more, unless they lie in one place
  uint32_t chunk_points = 1000000;  // are indexed at once by a core; fewer if memory asks for it
};

// Tells which share of all work is done and what goes on. Called on any thread, one at a time. May
// throw: then the import ends, and may be resumed.
using TreeProgress = std::function<void(double share, const char* stage)>;

struct TreeReport {
  uint64_t points = 0;   // in the tree
  uint64_t dropped = 0;  // not finite, or farther than 10^8 m from the frame's origin
  uint64_t nodes = 0, bytes = 0;
  uint64_t most_held = 0;            // bytes of large arrays at once
  std::vector<std::string> notices;  // sentences
};

}  // namespace wellspring::scan
