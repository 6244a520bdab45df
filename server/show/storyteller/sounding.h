// SPDX-License-Identifier: Apache-2.0
// The sound of a voice as values: who can speak, what of it is being heard, and what of it one
// visitor has been sent. Nothing is made for those who do not listen. What is done with them, tick
// by tick: show/answer/sound.h.
#pragma once
#include <functional>
#include <future>
#include <memory>
#include <string>
#include <vector>

#include "avatar/speech/speaker.h"
#include "show/exhibit/exhibit.h"
#include "show/storyteller/voice.h"

namespace wellspring::show {

// Who speaks: a Speaker, or a test's stand-in. Each call returns at once.
struct SpeechSource {
  std::function<std::shared_future<SpeechAnswer>(const SpeechRequest&)> speak;
  std::function<std::shared_ptr<const Speech>(const SpeechRequest&)> find;
  std::function<void(const std::vector<SpeechRequest>&)> prepare;
  std::function<Speaker::Counts()> counts;
};
SpeechSource make_speech_source(std::shared_ptr<Speaker> speaker);

// What is being heard, remembered from tick to tick.
struct Sounding {
  uint32_t number = 0;  // of the utterance; grows with every one, and after every pause
  bool going = false;   // it is being heard now
  uint32_t cuts = 0;    // Voice::cuts when it began
  std::shared_ptr<const Speech> speech;
  uint64_t zero_us = 0;  // when its first sample sounds
  SpeechRequest asked;   // for which `answer` is
  std::shared_future<SpeechAnswer> answer;
  std::string last_error;
};

// Who says what to one visitor alone: the narrator of a tour.
struct Narration {
  Voice voice;
  Sounding sounding;
};

// What one visitor hears.
struct VisitorSound {
  bool wanted = true;       // the visitor wants to hear
  uint32_t utterance = 0;   // whose sound is being sent; 0: none
  uint32_t given_up = 0;    // the utterance that was too much for its connection
  size_t samples_sent = 0;  // of the utterance
  Narration narration;      // of the tour
};

// A line as the synthesiser is asked for it.
SpeechRequest request_of(const StoryLine& line, const std::string& lang, const VoiceManner& manner);
// What the storytellers and the narrator of tours may say, greetings first: stories that anybody
// may tell and tours in the voice of the first. The rest is made when it is asked for.
std::vector<SpeechRequest> lines_of(const Exhibit& exhibit);

}  // namespace wellspring::show
