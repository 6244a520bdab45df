// SPDX-License-Identifier: Apache-2.0
// Shows a motion of one skeleton on the joints of another. It carries over how each limb lies in
// space: rest poses may differ (arms spread or hanging, legs apart), so may proportions and the
// number of vertebrae. A Retarget is made once for a motion and a figure, and applied every tick
// without state.
#pragma once
#include "avatar/figure/motion.h"
#include "avatar/figure/rig.h"

namespace wellspring::avatar {

struct Retarget {
  struct Link {
    int from = -1, to = -1;  // joints of the motion; the figure's takes the turn `share` of the way
    float share = 0;
    quat align{1, 0, 0, 0};  // turn from the figure's rest pose to the motion's, humanoid space
    bool moves = false;      // the motion moves this joint
  };
  std::vector<Link> links;          // one a joint of the figure
  std::vector<int> displacers;      // one a displacer of the motion; -1: the figure lacks it
  int root = -1, motion_root = -1;  // humanoid_root in the figure and in the motion
  float scale = 1;                  // height of the figure's hips over the motion's
  bool same = false;                // both have one skeleton: every number is taken as it is
  bool fits = false;                // anything moves at all
};

Retarget make_retarget(const Motion& motion, const Character& character);

// Blends the motion at `time` over the pose: 0 leaves it as it is, 1 replaces what the motion
// moves.
void apply_motion(const Motion& motion, const Retarget& retarget, const Character& character,
                  double time, bool loop, float weight, Pose& pose);

}  // namespace wellspring::avatar
