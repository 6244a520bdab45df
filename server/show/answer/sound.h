// SPDX-License-Identifier: Apache-2.0
// The storyteller's voice on its way to the visitors. It speaks one language at a time, since one
// mouth is seen by all: that of whoever asked for the story, else the kiosk's, else the first
// listener's; subtitles stay everybody's own. Sound is sent in short pieces a little ahead of its
// time, so that a stop is heard at once and a visitor who comes later hears the rest. Nothing is
// made for those who do not listen. A visitor on a tour hears its narrator instead, and nobody else
// does.
#pragma once
#include <functional>
#include <future>
#include <memory>
#include <string>
#include <vector>

#include "avatar/speech/speaker.h"
#include "show/exhibit/exhibit.h"
#include "show/storyteller/voice.h"

namespace wellspring {

struct Show;

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
  uint32_t number = 0;    // of the utterance; grows with every one, and after every pause
  bool going = false;     // it is being heard now
  uint32_t cuts = 0;      // Voice::cuts when it began
  std::shared_ptr<const Speech> speech;
  uint64_t zero_us = 0;   // when its first sample sounds
  SpeechRequest asked;    // for which `answer` is
  std::shared_future<SpeechAnswer> answer;
  std::string last_error;
};

inline constexpr double sound_piece = 0.25;  // seconds of one packet
inline constexpr double sound_ahead = 1.2;   // seconds sent before they are due

// Who says what to one visitor alone: the narrator of a tour.
struct Narration {
  Voice voice;
  Sounding sounding;
};

// What the storytellers and the narrator of tours may say, greetings first: stories that anybody
// may tell and tours in the voice of the first. The rest is made when it is asked for.
std::vector<SpeechRequest> lines_of(const Exhibit& exhibit);

// The language the storyteller speaks now.
std::string spoken_language(const Show& show);

// advance_voice with the speech of the show, and what follows from it.
VoiceEvents advance_speech(Show& show, float dt);
struct Visitor;
VoiceEvents advance_narration(Show& show, Visitor& visitor, float dt);

// Sends what is due to every visitor who listens, and stops what has been stopped. After orders and
// advance_speech, once a tick.
void send_sounds(Show& show);

}  // namespace wellspring
