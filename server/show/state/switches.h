// SPDX-License-Identifier: Apache-2.0
// The lamps of a running exhibit and its hour of the day as values: how they are wanted, and how
// the world is lit (show/state/lamps.h).
#pragma once
#include <map>
#include <optional>
#include <vector>

#include "light/known/lamps.h"
#include "light/known/skin_light.h"

namespace wellspring::show {

// What became of the light between two states of the lamps.
struct LightStep {
  LampLevels before, after;
  LightChange change;
};

// What is known of the light in one state of the lamps.
struct KnownLight {
  Lights lights;
  SkinLight skin;
};

struct Switches {
  std::vector<char> wanted;  // of each of the exhibit's lamps: the house's, for who has not
                             // switched it for themselves
  LampLevels lit;            // as the world is
  Lights all;                // made while all were full; empty where there are none
  std::shared_ptr<const LampCells> cells;  // of all lamps' light; null: nobody keeps any
  // Of the other states in which somebody sees the world, while the world is in `lit`.
  std::map<LampLevels, KnownLight> others;
  // While visitors have yet to follow: of each pair of states, one for all.
  std::vector<LightStep> steps;
};

// A visitor's own.
struct VisitorLamps {
  std::vector<char>
      own;  // of each of the exhibit's lamps: whether it is the visitor's own wish, not the house's
  std::vector<char> wish;      // of those
  std::optional<double> hour;  // of the day, the visitor's own wish; nothing: the exhibit's
  // As the visitor's pictures are to show them.
  LampLevels lit;  // empty: none yet
  std::optional<double> lit_hour;
  double lit_at = -1e9;  // show time of the last change of that
};

}  // namespace wellspring::show
