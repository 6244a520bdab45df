// SPDX-License-Identifier: Apache-2.0
// Subtitles as WebVTT (W3C Candidate Recommendation, 2019): written from what is spoken, read from
// what others made for a recording.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace wellspring {

struct SubtitleCue {
  double begin = 0, end = 0;  // seconds
  std::string text;           // UTF-8; lines divided by \n; no markup
  std::string speaker;        // of <v Name>
};

// Times as hh:mm:ss.mmm; markup characters are escaped.
std::string write_subtitles(const std::vector<SubtitleCue>& cues);

// Cues in order of their beginning. Cue settings, NOTE, STYLE and REGION blocks and tags inside
// cues are passed over. Throws LoadError{file, "line n", what}: no WEBVTT at the beginning, not
// UTF-8, a cue without times, one that ends before it begins, more than 100,000 cues.
std::vector<SubtitleCue> load_subtitles(std::string_view text, const std::string& file);

}  // namespace wellspring
