// SPDX-License-Identifier: Apache-2.0
// Clouds that tests of trees of points are made of.
#pragma once
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "base/rng.h"
#include "scan/tree/point_tree.h"
#include "scan/tree/import/write_tree.h"

namespace wellspring::test {

// Gives points that a test has made.
class MadeSource : public scan::PointSource {
 public:
  MadeSource(scan::PointBlock points, scan::ScanInfo info) : points_(std::move(points)) {
    info_ = std::move(info);
  }
  bool read(scan::PointBlock& block, size_t most) override {
    block.clear();
    const size_t end = std::min(at_ + most, points_.size());
    const auto copy = [&](const auto& from, auto& to) {
      if (!from.empty()) to.assign(from.begin() + long(at_), from.begin() + long(end));
    };
    copy(points_.place, block.place), copy(points_.color, block.color);
    copy(points_.intensity, block.intensity), copy(points_.normal, block.normal);
    copy(points_.classification, block.classification), copy(points_.station, block.station);
    at_ = end;
    return block.size() > 0;
  }

 private:
  scan::PointBlock points_;
  size_t at_ = 0;
};

inline scan::TreeSource made_source(scan::PointBlock points, scan::ScanInfo info = {},
                                    const std::string& name = "made") {
  info.file = name;
  return {name, [points = std::move(points), info] {
            return std::make_unique<MadeSource>(points, info);
          }};
}

// Returns settings that change no axis.
inline scan::TreeSettings plain_settings(uint32_t leaf_points = 500) {
  scan::TreeSettings settings;
  settings.up = scan::UpAxis::y, settings.leaf_points = leaf_points;
  return settings;
}

// Returns points at random on the faces of a box from 0 to `size`, coloured, with classes.
inline scan::PointBlock made_house(size_t count, dvec3 size, uint64_t seed = 1) {
  Rng rng(seed);
  scan::PointBlock block;
  for (size_t i = 0; i < count; i++) {
    dvec3 place(rng.uniform(), rng.uniform(), rng.uniform());
    const uint32_t face = rng.next() % 6;
    place[int(face / 2)] = face % 2;
    block.place.push_back(place * size);
    block.color.push_back({uint16_t(rng.next() % 256), uint16_t(face * 40), uint16_t(i % 256)});
    block.intensity.push_back(uint16_t(rng.next()));
    block.classification.push_back(uint8_t(face));
  }
  return block;
}

inline scan::ScanInfo house_info() {
  scan::ScanInfo info;
  info.fields = {.color = true, .intensity = true, .classification = true};
  return info;
}

inline dvec3 place_of(const scan::NodePoints& points, uint32_t i) {
  return points.corner +
         (dvec3(points.x[i], points.y[i], points.z[i]) + 0.5) * (double(points.size) / 65536);
}

// Returns the points of all leaves in or below a node.
struct FoundPoint {
  dvec3 place;
  uint32_t color;
  double step;  // its leaf's
  uint8_t classification;
};
inline std::vector<FoundPoint> leaf_points(const scan::PointTree& tree, uint32_t node = 0) {
  std::vector<FoundPoint> found;
  std::vector<uint32_t> open{node};
  while (!open.empty()) {
    const uint32_t number = open.back();
    open.pop_back();
    const scan::TreeNode& at = tree.nodes[number];
    for (uint32_t i = 0; i < at.children; i++) open.push_back(at.first_child + i);
    if (!at.is_leaf()) continue;
    const scan::NodePoints points = tree.points_of(number);
    for (uint32_t i = 0; i < points.count; i++)
      found.push_back({place_of(points, i), points.color[i], double(points.size) / 65536,
                       points.classification ? points.classification[i] : uint8_t(0)});
  }
  return found;
}

}  // namespace wellspring::test
