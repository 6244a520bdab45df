// SPDX-License-Identifier: Apache-2.0
// Costs of an imagined machine, for tests of the simulation.
#pragma once
#include "plan/costs.h"

namespace wellspring::test {

inline CostCurve constant(double value) { return CostCurve({{1e5, value}}); }

// Nothing costs anything but what a test adds.
inline Costs free_costs() {
  Costs costs;
  costs.cores = 2;
  costs.draw = costs.warp = costs.encode_keyframe = costs.encode_picture = constant(1e-6);
  costs.keyframe_bytes = costs.picture_bytes = constant(100);
  costs.visitor_memory = constant(1e6);
  costs.server_memory = 1e9;
  costs.samples = 1e12;
  return costs;
}

// About what a machine of two cores was measured to take.
inline Costs usual_costs() {
  Costs costs = free_costs();
  costs.draw = CostCurve({{57600, 0.04}, {230400, 0.07}});
  costs.warp = CostCurve({{57600, 0.0005}, {230400, 0.0015}});
  costs.encode_keyframe = CostCurve({{57600, 0.001}, {230400, 0.0026}});
  costs.encode_picture = CostCurve({{57600, 0.0003}, {230400, 0.0007}});
  costs.keyframe_bytes = CostCurve({{57600, 14e3}, {230400, 34e3}});
  costs.picture_bytes = CostCurve({{57600, 10e3}, {230400, 29e3}});
  costs.visitor_memory = CostCurve({{57600, 4e6}, {230400, 15e6}});
  costs.serial = 0.2;
  costs.tick = 3e-4, costs.tick_visitor = 5e-5;
  costs.samples = 6e4;
  costs.wide_rate = 0.8;
  return costs;
}

}  // namespace wellspring::test
