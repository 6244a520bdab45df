// SPDX-License-Identifier: Apache-2.0
// Nodes of points and sources of points that a test writes down.
#pragma once
#include <algorithm>
#include <array>
#include <memory>
#include <vector>

#include "scan/points.h"
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

struct MadePoint {
  dvec3 place;
  std::array<uint16_t, 3> color;
};

// Gives points as a file would.
class MadeSource : public scan::PointSource {
 public:
  explicit MadeSource(std::vector<MadePoint> points) : points_(std::move(points)) {
    info_.file = "made", info_.format = "made";
    info_.points = points_.size(), info_.is_counted = true;
    info_.fields.color = true;
    info_.color_max = 255;
  }
  bool read(scan::PointBlock& block, size_t most) override {
    block.clear();
    for (; next_ < points_.size() && block.size() < most; next_++) {
      block.place.push_back(points_[next_].place);
      block.color.push_back(points_[next_].color);
    }
    return block.size() > 0;
  }

 private:
  std::vector<MadePoint> points_;
  size_t next_ = 0;
};

}  // namespace wellspring::test
