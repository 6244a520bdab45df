// SPDX-License-Identifier: Apache-2.0
// Says how far a figure's file lets its joints turn (HAnimJoint llimit, ulimit, limitOrientation
// and stiffness, ISO/IEC 19774-1). The standard gives three angles and no order of them; here they
// bound the rotation vector (axis times angle) of the joint's turn away from the rest pose, about
// the axes of its limit frame, so that q and -q are the same and small turns about two axes do not
// disturb each other.
#pragma once
#include "avatar/figure/character.h"

namespace wellspring::avatar {

// Returns whether the file's limits say anything: exporters write zeros where they know none.
bool has_limits(const Joint& joint);

// Returns the turn with each component cut to its limits. The rest pose is always allowed; an axis
// whose limits are in the wrong order or no numbers is free. Turns within the limits come back
// unchanged.
quat limit_turn(const Joint& joint, quat turn);

// Returns how readily the joint turns when a chain of joints shares a turn: 1 without stiffness, 0
// at full.
float readiness(const Joint& joint);

}  // namespace wellspring::avatar
