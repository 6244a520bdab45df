// SPDX-License-Identifier: Apache-2.0
// Turns joints as other joints do: twist bones of forearms and thighs, sleeves that aim at an
// elbow, second arms (VRMC_node_constraint-1.0: roll, aim, rotation). The format speaks of nodes
// with axes of their own; a figure's joints have theirs along humanoid space, so each constraint
// keeps the turn between the two.
#pragma once
#include "avatar/figure/rig.h"

namespace wellspring::avatar {

// Returns the turn that a constraint asks of its joint, relative to the joint's parent; the
// identity if it says nothing: an aim without a direction, a source that is not finite.
quat eval_constraint(const Character& character, const JointConstraint& constraint,
                     const Pose& pose);

// Turns the joints of character.constraints in their order. Called once a tick, after everything
// else that turns joints but spring bones. A figure without constraints costs nothing. Never fails.
void follow_constraints(const Character& character, Pose& pose);

// Puts constraints into an order in which each comes after those it depends on, and takes out
// constraints that wait for one another in a circle, or for themselves, and those that wait for
// such. Returns the ones taken out, in the order they were in.
std::vector<JointConstraint> sort_constraints(const std::vector<Joint>& joints,
                                              std::vector<JointConstraint>& constraints);

}  // namespace wellspring::avatar
