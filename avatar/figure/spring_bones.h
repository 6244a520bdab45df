// SPDX-License-Identifier: Apache-2.0
// Hair, cloth and what else hangs on a figure and swings when it moves: the spring bones of VRM
// (VRMC_springBone-1.0), whose rule moves a bone's end once every sixtieth of a second by
// its inertia less drag, by its stiffness and by gravity. Here each bone is the damped oscillator
// that this rule means, in closed form: about the way where stiffness and gravity together want it,
// so that any time step is stable and a bone left alone swings alike at any tick rate.
//   theta'' = -(60 F / L) theta - c theta',  F = |stiffness * way + gravity|,  c = -60 log(1 -
//   drag)
#pragma once
#include <vector>

#include "avatar/figure/pose.h"

namespace wellspring::avatar {

// One a bone of Character::springs: where its end is, and how fast the bone turns.
struct SpringBoneState {
  vec3 end{0}, turning{0};  // metres and radians a second, in the frame of its `center`
};

struct SpringBonesState {
  std::vector<SpringBoneState> bones;  // empty: they begin hanging at rest
  struct Frame {
    vec3 center{0};
    quat rotation{1, 0, 0, 0};
    bool changed = false;
  };
  std::vector<Frame> frames;  // working memory: each joint as posed
};

// Turns the joints of character.springs in `pose`, which has the rest of the figure as it is after
// `dt` seconds. Once a tick; a figure without springs costs nothing. Never fails: what is not
// finite hangs as modelled.
void tick_spring_bones(SpringBonesState& state, const Character& character, float dt, Pose& pose);

}  // namespace wellspring::avatar
