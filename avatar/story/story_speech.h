// SPDX-License-Identifier: Apache-2.0
// Makes a whole story one speech: its sentences one after the other with their pauses, as a show
// plays them.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "avatar/speech/process.h"
#include "avatar/speech/speech.h"
#include "avatar/story/story_script.h"
#include "avatar/story/subtitle.h"

namespace wellspring::avatar {

// seconds between two sentences of a show: breath and lead
inline constexpr double story_breath = 0.55;

struct StorySpeech {
  Speech speech;               // speech of all sentences; its text has a line for each
  std::vector<double> begins;  // time of every sentence's first sample, s
  std::vector<SubtitleCue> cues;
};

// Speaks every line in the voice of `request`, whose text and styles are the lines'. Throws
// LoadError with the place in `file` of a line that cannot be spoken. May be cancelled
// (base/worker.h).
std::vector<std::shared_ptr<const Speech>> speak_lines(SpeechProcess& process,
                                                       const std::vector<StoryLine>& lines,
                                                       SpeechRequest request,
                                                       const std::string& file);

// Joins the lines' speeches, `spoken`, all of one rate; null ones are left out, with their time to
// read.
StorySpeech join_lines(const std::vector<StoryLine>& lines,
                       const std::vector<std::shared_ptr<const Speech>>& spoken);

// Reads story files: .txt is plain text, .vtt are subtitles, all else is markup.

// Throws LoadError naming the file if it cannot be read or is larger than most_markup_bytes, and
// what read_story, read_plain_story and read_subtitle_story throw.
StoryScript load_story(const std::string& file);

}  // namespace wellspring::avatar
