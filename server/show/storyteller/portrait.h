// SPDX-License-Identifier: Apache-2.0
// A figure in a photographer's portrait scene, to look at: soft area lights, a floor that curves up
// into the background.
#pragma once
#include "avatar/figure/character.h"
#include "avatar/figure/pose.h"
#include "frame/frame.h"
#include "show/storyteller/held_prop.h"

namespace wellspring::show {

struct PortraitShot {
  int width = 720, height = 1080, spp = 64;
  bool close = false;  // head and shoulders instead of the whole figure
  float turn =
      0;  // camera's way round the figure, radians; 0: before its face, positive: to its left
  // What it holds, in humanoid space, of an exhibit's props; null: nothing.
  const Exhibit* exhibit = nullptr;
  HeldProp held;
};

// All cores; seconds. Pictures of the figure that cannot be read are named in `warnings`.
Frame render_portrait(const Character& character, const Pose& pose, const PortraitShot& shot,
                      std::vector<std::string>& warnings);

}  // namespace wellspring::show
