// SPDX-License-Identifier: Apache-2.0
// A scripted visitor who strolls up and down, and what it sees of it.
#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "wire/messages.h"

namespace wellspring::test {

// A stroll up and down: ahead, swaying, and round again every few seconds with the turn of a key
// (web/controls.js), so that walls come and go and none is walked into, where there would be
// nothing new to show between inputs. `interval`: seconds from input to input.
Input stroll(double t, uint32_t seq, double interval);

struct Stroll {
  std::vector<double> arrivals;   // pictures' arrivals, seconds from the first that counts
  std::vector<double> latencies;  // milliseconds from an input to the first picture that shows it
  std::vector<double> bytes;      // pictures' sizes
  std::vector<double> scales;     // keyframes' widths, over those that were asked for
  size_t repeated = 0;            // the same as the one before
  double walked = 0;              // seconds
  double fps() const;
  std::vector<double> gaps() const;  // milliseconds between pictures
};

struct StrollPlan {
  uint16_t port = 0;
  int width = 1280, height = 720;
  double warm_up = 2, seconds = 20;
  double phase = 0;    // seconds of the stroll that are left out, so that several differ
  double walking = 1;  // share of the time, in which they walk; else they stand
  bool local = false;  // keyframes come, of which those of a walk count
};
// Strolls through a visit of a server's; what arrives in the `seconds` after `warm_up` counts.
// `counting` is called when that begins. Throws std::runtime_error where the visit ends by itself.
Stroll stroll_through(const StrollPlan& plan, const std::function<void()>& counting = {});
// So many at once, each at a phase of their own.
std::vector<Stroll> stroll_together(const StrollPlan& plan, int visitors);

}  // namespace wellspring::test
