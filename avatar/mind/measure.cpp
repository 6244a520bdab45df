// SPDX-License-Identifier: Apache-2.0
#include "avatar/mind/measure.h"

#include <oneapi/tbb/task_arena.h>

#include <algorithm>

#include "avatar/figure/skin.h"
#include "avatar/mind/storyteller.h"
#include "base/clock.h"

namespace wellspring {
namespace {

double median(std::vector<double>& values) {
  if (values.empty()) return 0;
  auto middle = values.begin() + ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

AvatarTimes measure_avatar(const Character& character, int ticks) {
  Storyteller storyteller{&character, mat4(1)};
  StorytellerState state;
  StorytellerInput input;
  StorytellerEvents events;
  Pose pose;
  SkinScratch scratch;
  std::vector<vec3> positions, normals;
  std::vector<double> behave, skinned;
  input.dt = 1 / 30.0f;
  input.speaking = 1;
  input.guests = {{1, {0.3f, 1.6f, 1.3f}, vec3(0.3f, 0, 0), true}};
  oneapi::tbb::task_arena one_core(1);
  one_core.execute([&] {
    for (int i = 0; i < ticks + 1; i++) {
      double start = seconds_now();
      tick_storyteller(state, storyteller, input, pose, events);
      double between = seconds_now();
      skin(character, pose, mat4(1), scratch, positions, normals);
      if (i == 0) continue;  // the first call builds its tables
      behave.push_back(1000 * (between - start));
      skinned.push_back(1000 * (seconds_now() - between));
    }
  });
  return {median(behave), median(skinned)};
}

}  // namespace wellspring
