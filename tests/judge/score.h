// SPDX-License-Identifier: Apache-2.0
// Measures how well gestures are recognised and spotted (Elmezain et al. 2009, section 4, equations
// 15 and 16).
#pragma once
#include <span>

#include "kiosk/gesture/spot.h"
#include "kiosk/gesture/writer.h"

namespace wellspring::test {

struct SpotCounts {
  int tests = 0, inserted = 0, deleted = 0, substituted = 0, correct = 0;
  SpotCounts& operator+=(const SpotCounts& other);
};

// Return correct / tests, and correct / (tests + inserted); 0 without tests.
double recognition_ratio(int correct, int tests);
double reliability(const SpotCounts& counts);

// Compares spotted gestures with true ones. A spotted gesture belongs to the true one with which it
// shares most time, at least a third of the shorter one; each true one takes one. With the same
// label it is correct, with another substituted. True ones without any are deleted, spotted ones
// without any are inserted.
SpotCounts count_spotted(std::span<const TrueGesture> truth,
                         std::span<const SpottedGesture> spotted);

}  // namespace wellspring::test
