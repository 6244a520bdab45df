// SPDX-License-Identifier: Apache-2.0
// Nodes of points that a test writes down.
#pragma once
#include <vector>

#include "scan/tree/node_points.h"

namespace wellspring::test {

// A node whose points lie on a grid in the plane y = 0 of a cube around the origin, `across` a
// side, grey, and face up, or have no normal.
struct MadeNode {
  std::vector<uint16_t> x, y, z, normal;
  std::vector<uint32_t> color;
  scan::NodePoints points;

  MadeNode(float size, int across, bool has_normals = true) {
    constexpr uint16_t up = 127 << 8, none = 0x8080;  // octahedral (0, 1)
    for (int row = 0; row < across; row++)
      for (int column = 0; column < across; column++) {
        x.push_back(uint16_t((column * 2 + 1) * 65535 / (2 * across)));
        z.push_back(uint16_t((row * 2 + 1) * 65535 / (2 * across)));
        y.push_back(32767);
        color.push_back(0xff808080u);
        normal.push_back(has_normals ? up : none);
      }
    points.corner = dvec3(-0.5 * double(size));
    points.size = size;
    points.spacing = size / float(across);
    points.count = uint32_t(across * across);
    for (auto* column : {&x, &y, &z, &normal}) column->resize(column->size() + 8);
    color.resize(color.size() + 8);
    points.x = x.data(), points.y = y.data(), points.z = z.data();
    points.color = color.data(), points.normal = normal.data();
  }
  MadeNode(const MadeNode&) = delete;
  MadeNode& operator=(const MadeNode&) = delete;
};

}  // namespace wellspring::test
