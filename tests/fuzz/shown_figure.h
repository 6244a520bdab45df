// SPDX-License-Identifier: Apache-2.0
// What a figure that was accepted goes through: standing there, moving as its file says, its skin.
#pragma once
#include <glm/gtc/matrix_transform.hpp>

#include "avatar/figure/figure_check.h"
#include "avatar/figure/retarget.h"
#include "avatar/figure/skin.h"
#include "avatar/mind/storyteller.h"
#include "fuzz/fuzz.h"

namespace wellspring::fuzz {

inline void show_figure(const Character& character) {
  describe_text(character);
  describe_json(character);
  const Storyteller storyteller{&character, mat4(1)};
  StorytellerState state;
  StorytellerInput input;
  StorytellerEvents events;
  Pose pose = make_rest_pose(character);
  SkinScratch scratch;
  std::vector<vec3> positions, normals;
  for (size_t i = 0; i <= std::min<size_t>(character.motions.size(), 2); i++) {
    input.dt = 0.03f, input.time = 0.03 * double(i + 1);
    tick_storyteller(state, storyteller, input, pose, events);
    if (i > 0) {
      const Motion& motion = character.motions[i - 1];
      apply_motion(motion, make_retarget(motion, character), character, 0.4 * motion.duration, true,
                   1, pose);
    }
    skin(character, pose, mat4(1), scratch, positions, normals);
  }
}

}  // namespace wellspring::fuzz
