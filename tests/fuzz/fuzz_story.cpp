// SPDX-License-Identifier: Apache-2.0
// Stories: marked up, plain, and single lines of an exhibit.
#include "avatar/story/story_script.h"
#include "fuzz/fuzz.h"

namespace wellspring::fuzz {

void fuzz_story(Bytes bytes) {
  const std::string text = text_of(bytes);
  for (const auto& read : {read_story, read_plain_story, read_story_line})
    load([&] {
      for (const StoryLine& line : read(text, "fuzz").lines) {
        require(line.text.size() <= most_line_bytes, "lines are short");
        for (const StoryMark& mark : line.marks)
          require(mark.at <= line.text.size(), "marks stand in their line");
      }
    });
}

}  // namespace wellspring::fuzz
