// SPDX-License-Identifier: Apache-2.0
// The lamps of a running exhibit as values: how they are wanted, and how the world is lit
// (show/state/lamps.h).
#pragma once
#include <vector>

#include "light/known/lamps.h"

namespace wellspring {

// What became of the light between the lamps as they were and as the world is.
struct LightStep {
  std::vector<char> before;
  LightChange change;
};

struct Switches {
  std::vector<char> wanted, lit;  // of each lamp: as it was asked for, as the world is
  double lit_at = -1e9;           // show time
  Lights all;                     // made while all were on; empty where there are none
  // To `lit`, while visitors have yet to follow: of each state that any cache knew, one for all.
  std::vector<LightStep> steps;
};

}  // namespace wellspring
