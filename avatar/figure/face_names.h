// SPDX-License-Identifier: Apache-2.0
// Makes the face's controls under the names that Rig looks for, from the names that a figure's
// author gave them: VRM presets, ARKit's 52 blend shapes, Oculus visemes, VRoid.
#pragma once
#include <string_view>

#include "avatar/figure/character.h"

namespace wellspring::avatar {

// Adds displacers ("blink_l", "smile_r", "viseme_aa", ...) that the figure lacks and that can be
// made from those it has: renamed, summed, or cut to one side or one region of the face. Displacers
// that the figure has under our names stay as they are.
void complete_face(Character& character);
std::string_view face_shapes_json();  // avatar/library/face_shapes.json

}  // namespace wellspring::avatar
