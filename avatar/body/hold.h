// SPDX-License-Identifier: Apache-2.0
// Lets one arm hold a thing: it fetches it, holds it up and brings it back, under all gestures of
// the other arm. A clip of the gesture library says how: at the clip's `stroke` the hand takes the
// thing, at `hold` it holds it up, and as long before the clip's end as `stroke` is after its
// beginning the hand lets go of it.
#pragma once
#include <optional>
#include <string>

#include "avatar/body/gesture.h"
#include "avatar/figure/rig.h"

namespace wellspring::avatar {

// Holds what a hand is to hold.
struct HeldThing {
  int thing = -1;       // a number of the caller's; -1: nothing
  std::string gesture;  // name in the library
  int side = 1;         // 0: the left hand, 1: the right one
};

struct HoldState {
  HeldThing held;       // thing that is fetched, held or brought back
  int clip = -1;        // index in the library; -1: none
  float time = 0;       // seconds within the clip
  bool wanted = false;  // whether the last tick wanted it
};

// The thing comes and goes within so many seconds.
inline constexpr float hold_appears = 0.3f;
// Returns whether a thing can be held by that clip: there is time for it to come and to go.
bool can_hold(const GestureClip& clip);

// Advances by dt towards holding what is wanted. A thing in the hand is brought back before another
// one is fetched. A gesture that the library lacks, or that cannot hold, holds nothing.
void tick_hold(HoldState& state, const GestureLibrary& library, const HeldThing& wanted, float dt);

// Holds the arm of `state.held.side`, and how far it leaves its rest, 0..1.
struct HoldingArm {
  ArmPose arm;
  float weight = 0;
};
HoldingArm eval_hold(const HoldState& state, const GestureLibrary& library);

// Returns how much of the thing there is in the hand, 0..1.
float eval_held_share(const HoldState& state, const GestureLibrary& library);
// Returns whether the thing is held up and still wanted.
bool is_held_up(const HoldState& state, const GestureLibrary& library);

// Gives a gesture that only the busy arm would make to the other one.
void keep_to_free_arm(GestureOrder& order, const GestureLibrary& library, const HoldState& state);

// Finds where a closed hand holds a rod: the same frame for every figure, whatever its bones are
// like.

// Returns the transform from the fist's frame to humanoid space, as posed. In the fist zero is the
// middle of what it closes around, y leads out of it beside the thumb, z the way the straight hand
// points. A figure without that hand gets nothing.
std::optional<mat4> eval_grip(const Rig& rig, const Pose& pose, int side);

}  // namespace wellspring::avatar
