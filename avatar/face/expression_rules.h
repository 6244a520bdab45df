// SPDX-License-Identifier: Apache-2.0
// Obeys the rules that a figure's author gave for whole expressions: some are all or nothing, some
// forbid that lids blink, eyes turn or lips speak while they show (VRMC_vrm-1.0, expressions.md:
// isBinary and procedural override).
#pragma once
#include "avatar/figure/rig.h"

namespace wellspring::avatar {

// Holds a pose's displacers, and the turns of its eyes, to character.expression_rules. Called once
// a tick, after everything that sets them. A figure without rules costs nothing. Weights that are
// not finite count as none.
void follow_expression_rules(const Character& character, Pose& pose);

// Sums what the pose's displacers add to each look, by character.appearance_changes; weights are
// taken as 0 to 1. Looks that nothing changes get zeros. Overwrites `changes`.
void eval_appearance_changes(const Character& character, const Pose& pose,
                             std::vector<AppearanceChange>& changes);

}  // namespace wellspring::avatar
