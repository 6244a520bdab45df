// SPDX-License-Identifier: Apache-2.0
// Holds what serving visitors costs on the machine that was measured: rows "load.plan.cost.*" of a
// file that `./wellspring bench --only load.plan --json FILE` wrote. They are measured with one
// visitor, mostly as processor time, so that other programs of the machine count for little.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "base/layers.h"

namespace wellspring::plan {

// A cost that depends on a picture's pixels: a straight line from one measured size to the next,
// and on beyond the first and the last; never below zero.
class CostCurve {
 public:
  CostCurve() = default;
  // Takes pairs of pixels and cost in any order, with a size once.
  explicit CostCurve(std::vector<std::pair<double, double>> points);
  double at(double pixels) const;
  bool empty() const { return points_.empty(); }

 private:
  std::vector<std::pair<double, double>> points_;
};

// All times are in seconds, those of work in core-seconds.
struct Costs {
  double cores = 0;           // the measured machine has so many
  CostCurve draw;             // drawing a keyframe
  CostCurve warp;             // warping a picture from one
  CostCurve encode_keyframe;  // making its JPEG and depth
  CostCurve encode_picture;   // encoding a finished picture
  CostCurve keyframe_bytes, picture_bytes;
  CostCurve visitor_memory;           // bytes of a visitor's pictures
  double server_memory = 0;           // bytes of a server besides
  double serial = 0;                  // share of a keyframe that one core does alone
  double tick = 0, tick_visitor = 0;  // a tick takes, and more for each visitor
  double samples = 0;                 // samples a second that one core traces
  double wide_rate = 0;               // wide views that a walker needs, a second
};

// Throws LoadError that names the file and the field if it cannot be read, is no such report, or a
// value is missing or makes no sense.
Costs load_costs(const std::string& file);
// Takes them from such a report that was read already; `file` is named by errors.
Costs read_costs(const nlohmann::json& report, const std::string& file);

}  // namespace wellspring::plan
