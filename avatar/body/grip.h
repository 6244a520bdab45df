// SPDX-License-Identifier: Apache-2.0
// Where a closed hand holds a rod: the same frame for every figure, whatever its bones are like.
#pragma once
#include <optional>

#include "avatar/figure/pose.h"
#include "avatar/figure/rig.h"

namespace wellspring::avatar {

// From the fist's frame to humanoid space, as posed. In the fist zero is the middle of what it
// closes around, y leads out of it beside the thumb, z the way the straight hand points. Nothing
// for a figure without that hand.
std::optional<mat4> eval_grip(const Rig& rig, const Pose& pose, int side);

}  // namespace wellspring::avatar
