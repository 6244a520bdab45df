// SPDX-License-Identifier: Apache-2.0
// Reads and writes subtitles as WebVTT (W3C Candidate Recommendation, 2019): written from speech,
// read from others' files for a recording.
#pragma once
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace wellspring::avatar {

struct SubtitleCue {
  double begin = 0, end = 0;  // seconds
  std::string text;           // UTF-8; lines divided by \n; no markup
  std::string speaker;        // name in <v Name>
  int line{0};                // line of its text, in the file it was read from
};

struct Subtitles {
  std::vector<SubtitleCue> cues;                   // in order of their beginning
  std::vector<std::pair<int, std::string>> notes;  // line, and what was left out there
};

// Writes times as hh:mm:ss.mmm; markup characters are escaped.
std::string write_subtitles(const std::vector<SubtitleCue>& cues);

// Reads subtitles. Words of the header (X-TIMESTAMP-MAP, ...), cue settings, NOTE, STYLE and REGION
// blocks and tags inside cues are passed over; a block without times is no cue, and noted. Throws
// LoadError{file, "line n", what}: no WEBVTT at the beginning, not UTF-8, times that are none, a
// cue that ends before it begins, more than 100,000 cues.
Subtitles load_subtitles(std::string_view text, const std::string& file);

}  // namespace wellspring::avatar
