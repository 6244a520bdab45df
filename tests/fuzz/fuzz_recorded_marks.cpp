// SPDX-License-Identifier: Apache-2.0
// Times of a narrator's words, which people edit.
#include "avatar/story/recorded_story.h"
#include "fuzz/fuzz.h"

namespace wellspring::fuzz {

void fuzz_recorded_marks(Bytes bytes) {
  static const std::vector<StoryLine> lines =
      read_story("<story>The tower. It is old.</story>", "fuzz").lines;
  static const Sound sound{16000, std::vector<float>(32000, 0.1f)};
  load([&] {
    const Speech marked = apply_marks(text_of(bytes), "fuzz.marks.json", lines, sound);
    doubtful_places(marked, lines);
    require(divide_recording(marked, lines, 0.2).size() == lines.size(),
            "every line has its part of the sound");
  });
}

}  // namespace wellspring::fuzz
