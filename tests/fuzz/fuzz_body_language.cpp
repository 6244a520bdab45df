// SPDX-License-Identifier: Apache-2.0
// Files of gestures and expressions in place of the built-in ones.
#include "avatar/body/gesture.h"
#include "avatar/face/expression.h"
#include "fuzz/fuzz.h"

namespace wellspring::fuzz {

void fuzz_body_language(Bytes bytes) {
  const std::string text = text_of(bytes);
  load([&] {
    for (const GestureClip& clip : read_gestures(text, "fuzz").clips)
      for (float t : {0.0f, 0.5f * clip.seconds, clip.seconds}) eval_gesture(clip, t);
  });
  load([&] {
    for (const Rotator& rotator : read_expressions(text, "fuzz").rotators)
      eval_rotator(rotator, 0.5f);
  });
}

}  // namespace wellspring::fuzz
