// SPDX-License-Identifier: Apache-2.0
// What the kiosk's reports on visitors share: who comes, and how a visit begins.
#pragma once
#include <cmath>

#include "reports.h"
#include "visitors/visitor_folder.h"

namespace wellspring::test {

inline constexpr const char* kiosk_figure_names[] = {"storyteller", "chronicler"};

// The castle's figures.
VisitorStage make_kiosk_stage(const BenchOptions& options);
// Throws std::runtime_error where WELLSPRING_WEIGHTS does not say where the networks' weights are.
VisitorWatch kiosk_watch(const BenchOptions& options, const std::string& name);

// An empty room, then for `seconds` the figure, which looks into the lens.
VisitorSequence begin_visit(int figure, float metres, VisitorLight light, double seconds);

struct VisitorMean {
  double sum = 0;
  int count = 0;
  void add(double value) { sum += value, count++; }
  double value() const { return count ? sum / count : NAN; }
};

}  // namespace wellspring::test
