// SPDX-License-Identifier: Apache-2.0
// Joints that turn as other joints do: twist bones of forearms and thighs, sleeves that aim at an
// elbow, second arms (VRMC_node_constraint-1.0: roll, aim, rotation). The format speaks of nodes
// with axes of their own; a figure's joints have theirs along humanoid space, so what lies between
// the two is kept in each constraint.
#pragma once
#include "avatar/figure/rig.h"

namespace wellspring::avatar {

// The turn that a constraint asks of its joint, relative to the joint's parent; the identity where
// it says nothing: an aim without a direction, a source that is not finite.
quat eval_constraint(const Character& character, const JointConstraint& constraint,
                     const Pose& pose);

// Turns the joints of character.constraints in their order. Once a tick, after everything else that
// turns joints but spring bones. A figure without constraints costs nothing. Never fails.
void follow_constraints(const Character& character, Pose& pose);

// Puts constraints into an order in which each finds what it depends on done, and takes those out
// that wait for one another in a circle, or for themselves, and those that wait for such. What is
// taken out is returned, in the order it was in.
std::vector<JointConstraint> sort_constraints(const std::vector<Joint>& joints,
                                              std::vector<JointConstraint>& constraints);

}  // namespace wellspring::avatar
