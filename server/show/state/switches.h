// SPDX-License-Identifier: Apache-2.0
// Holds the lamps of a running exhibit and its hour of the day as values: how they are wanted, and
// how the world is lit (show/state/lamps.h).
#pragma once
#include <map>
#include <optional>
#include <vector>

#include "light/kept/lamps.h"
#include "light/kept/skin/skin_light.h"

namespace wellspring::show {

// Holds how the light changes between two states of the lamps.
struct LightStep {
  LampLevels before, after;
  LightChange change;
};

// Holds the light in one state of the lamps, as far as it has been found.
struct KnownLight {
  Lights lights;
  SkinLight skin;
};

struct Switches {
  // the house's wish for each of the exhibit's lamps, for visitors who have not switched it for
  // themselves
  std::vector<LampSwitch> wanted;
  LampLevels lit;  // levels in the world
  Lights all;  // lights that were made while all lamps were full; empty if the exhibit has no lamps
  std::shared_ptr<const LampCells> cells;  // light of all lamps; null: none is kept
  // Light in the other states in which somebody sees the world, while the world is in `lit`.
  std::map<LampLevels, KnownLight> others;
  // Changes that visitors have yet to follow: one for each pair of states, for all visitors.
  std::vector<LightStep> steps;
};

// Holds a visitor's own wishes, and what is shown of them.
struct VisitorLamps {
  // for each of the exhibit's lamps: whether the visitor's own wish counts, not the house's
  std::vector<char> own;
  std::vector<LampSwitch> wish;  // those wishes
  std::optional<double> hour;    // hour of the day, the visitor's own wish; none: the exhibit's
  // These are the lamps and the hour that the visitor's pictures are to show.
  LampLevels lit;  // empty: none yet
  std::optional<double> lit_hour;
  double lit_at = -1e9;  // show time of their last change
};

}  // namespace wellspring::show
