// SPDX-License-Identifier: Apache-2.0
// How a lawn answers to those who walk in it (Orthmann, Rezk-Salama, Kolb, section 5): tiles that
// something touches are simulated; their blades are pushed aside, springs keep their shape, and
// they rise again. Tiles that nothing has touched for a while cost neither time nor memory.
//
// The paper lets a blade recover by v <- (1 - t^3) w + t^3 v each frame, t falling from 1 to 0,
// from which it follows that blades are up sooner the more frames there are, and that their length
// changes. Here v stays as the last touch left it, and the shape is a function of the time since:
// the blade lies still for `lie`, then goes to the wind's place w by the same formula, once, over
// `rise`; its segments have their own length from `settle` on.
#pragma once
#include <cstdint>
#include <limits>
#include <vector>

#include "lawn/collider.h"
#include "lawn/lawn.h"
#include "lawn/shape.h"
#include "lawn/wind.h"

namespace wellspring::lawn {

struct ResponseSettings {
  float lie = 2.5f, rise = 3;  // seconds; a trail is seen that long
  float settle = 0.15f;        // seconds until a blade that was stretched has its length
  float stiffness = 0.8f;      // share of a spring's stretch that an iteration takes away, 0 to 1
};

enum class TileState : uint8_t { idle, colliding, recovering };

// Holds the blades of a tile after touches: the refined mesh of section 5.2, which standing blades
// do not need.
struct BentTile {
  double since = 0;            // the time from which `touched` counts
  double last_touch = 0;       // the newest of its blades'
  std::vector<float> touched;  // seconds; a blade that stands has -infinity
  std::vector<float> joint;    // [joint - 1][x, y, z][blade], as the last touch left them
  vec3 low{0}, high{0};        // around all places of bent blades
};

// Changes with time; belongs to one lawn. `bent` is empty for tiles without bent blades.
struct LawnState {
  ResponseSettings settings;
  double time = 0;
  std::vector<TileState> state;  // a tile each
  std::vector<BentTile> bent;
  std::vector<int> active;  // tiles that are not idle, in rising order
};
LawnState make_lawn_state(const Lawn& lawn, const ResponseSettings& settings = {});

// Goes to `time`, in seconds, at which `walkers` are in the lawn. For all numbers of threads, and
// whatever the rate of ticks, the state is the same but for where walkers were in between.
// Afterwards no joint but roots is inside a walker. Time that goes back makes all blades rise.
void step_lawn(LawnState& state, const Lawn& lawn, const Wind& wind, const Walkers& walkers,
               double time);

// Returns the shapes of eight blades of a tile at the state's time: the wind's, but for blades that
// have been touched. `first`: the lawn's, a multiple of eight.
BladeShapes eval_shapes(const Lawn& lawn, const LawnState& state, const WindNow& wind, int tile,
                        int first);

// Relaxes the structural springs between neighbouring joints of the strips of `lanes`, and shear
// springs over two segments, which a narrow strip has along instead of across: a force
// f = k (|l| - l0) l / |l| moves both ends by half of it, and all of it one end if the other is the
// root (equations 6 and 7, without the step of time, which would tie stiffness to the rate of
// ticks). Rest lengths are those of `rest`. Shear springs are a quarter as stiff.
void relax_springs(BladeShapes& shapes, const BladeShapes& rest, const LaneMask& lanes,
                   float stiffness);

}  // namespace wellspring::lawn
