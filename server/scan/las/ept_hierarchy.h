// SPDX-License-Identifier: Apache-2.0
// Reads what an EPT folder says of itself: the kinds of data, and its tree of nodes
// (Entwine Point Tile 1.0, "ept.json" and "ept-hierarchy").
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/vec.h"

namespace wellspring::scan {

enum class EptData : uint8_t { binary, zstandard, laszip };
enum class EptKind : uint8_t { signed_whole, unsigned_whole, floating };

// One number of each point. A number `n` means `n * scale + offset`.
struct EptDimension {
  std::string name;
  EptKind kind = EptKind::signed_whole;
  int size = 4;   // bytes
  size_t at = 0;  // its place in a point's bytes
  double scale = 1, offset = 0;
};

// A node of the tree: its depth, and its place among those of the depth.
using EptKey = std::array<uint32_t, 4>;
std::string ept_name(const EptKey& key);

struct EptNode {
  EptKey key;
  uint64_t points = 0;
};

inline constexpr uint64_t most_ept_node_points = uint64_t(1) << 22;

struct EptFolder {
  std::string folder;  // ends in a slash, or is empty
  std::string file;    // ept.json
  EptData data = EptData::laszip;
  uint64_t points = 0;
  dvec3 low{0}, high{0};
  bool is_bounded = false;
  std::string wkt;  // describes the space; may be empty
  std::vector<EptDimension> dimensions;
  size_t point_bytes = 0;      // in binary data
  std::vector<EptNode> nodes;  // those with points, from the root on

  const EptDimension* find(const std::string& name) const;
};

// `path` names the folder or its ept.json. Throws LoadError if something is damaged, if nodes refer
// to themselves or appear twice, or if their points are not as many as the file says.
EptFolder load_ept_folder(const std::string& path);

}  // namespace wellspring::scan
