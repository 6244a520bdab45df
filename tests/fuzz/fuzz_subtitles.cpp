// SPDX-License-Identifier: Apache-2.0
// Subtitles (WebVTT).
#include "avatar/story/subtitle.h"
#include "fuzz/fuzz.h"

namespace wellspring::fuzz {

void fuzz_subtitles(Bytes bytes) {
  load([&] {
    const Subtitles subtitles = load_subtitles(text_of(bytes), "fuzz.vtt");
    load_subtitles(write_subtitles(subtitles.cues), "fuzz.vtt");
  });
}

}  // namespace wellspring::fuzz
