// SPDX-License-Identifier: Apache-2.0
// What the storyteller, or a tour's narrator, is saying: a queue of sentences with times, shown as
// subtitles, heard, and moving its mouth. A value advanced by time. A sentence takes as long as its
// speech; where there is none (it is not ready in time, or nobody speaks its language) as long as
// its text takes to read. The marks of its text become events at the times of their words.
#pragma once
#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <string>
#include <vector>

#include "avatar/speech/speaker.h"
#include "avatar/speech/speech.h"
#include "avatar/story/timeline.h"
#include "show/exhibit/exhibit.h"

namespace wellspring::show {

struct Utterance {
  LocalLine line;
  float seconds = 0;
  std::shared_ptr<const Speech> speech;  // set when it begins; null: subtitles only
  std::string lang;                      // whose marks count; set when it begins
  Timeline timeline;
};

struct Voice {
  std::deque<Utterance> queue;  // front: being said
  float elapsed = 0;            // time in the front; below 0: the breath before it
  float silent_until = -1e9f;   // time in the front at which its sound begins (it was paused)
  float waited = 0;             // seconds the front has waited for its speech
  bool started = false;         // the front's subtitle has been shown
  bool paused = false;
  size_t cursor = 0;      // into the front's timeline
  StoryHold held;         // emotion and gaze that the marks so far ask for
  std::string story;      // id of the story being told; "" for greetings and the like
  int sentence = 0;       // index in the story
  uint32_t cuts = 0;      // how often what was being said has been broken off
  uint64_t asked_by = 0;  // link id of the visitor who asked for it; 0: nobody
};

struct VoiceEvents {
  const Utterance* begun = nullptr;  // points into the queue; valid until the next change
  bool ended = false;                // the one before has been said to its end
  bool fell_silent = false;
  std::vector<ActionEvent> acts;  // marks whose time has come, in order
};

// The speech of a sentence that is due: there, on its way, or none.
struct SpeechState {
  std::shared_ptr<const Speech> speech;
  bool pending = false;
  std::string lang;  // language that it is, or would be, spoken in; empty: any
};
using AskSpeech = std::function<SpeechState(const Utterance&)>;

inline constexpr float longest_wait = 1.5f;  // seconds for a speech that is not ready
inline constexpr float speech_lead = 0.2f;   // silence before a speech: its sound travels ahead

// How long a text takes to say and read: 0.9 s and 60 ms a character of its longest language.
float speaking_seconds(const LocalLine& line);
// Sentence number `index` (wrapping) of every language.
LocalLine nth_line(const LocalScript& lines, size_t index);

// Replaces what is being said (override) or follows it.
void say(Voice& voice, LocalLine line, bool override_all);
// Says all sentences of a script after what is queued.
void say_all(Voice& voice, const LocalScript& script);
// From a later sentence with what the ones before it would have left: face and gaze.
void tell(Voice& voice, const StoryText& story, int from_sentence = 0);
void hush(Voice& voice);
void pause_voice(Voice& voice);
// Goes on with the word that was being said when it was paused, after speech_lead.
void resume_voice(Voice& voice);
// Without `ask` everything is told by subtitles.
VoiceEvents advance_voice(Voice& voice, float dt, const AskSpeech& ask = {});
// Returns what is being heard now, or null: between sentences, in a pause, without a speech.
const Speech* heard(const Voice& voice);
// Mouth shapes of what is heard `ahead` seconds from now; silence where there is nothing.
VisemeWeights mouth_shape(const Voice& voice, float ahead = 0);
// Mouth activity `ahead` seconds from now, 0 to 1: what is not silence of the speech, else a rise
// at the beginning of the sentence and a fall at its end.
float speaking(const Voice& voice, float ahead = 0);

// The sound of a voice is held as values: who can speak, what of it is being heard, and what of it
// one visitor has been sent. Nothing is made for those who do not listen. show/answer/sound.h uses
// them tick by tick.

// Who speaks: a Speaker, or a test's stand-in. Each call returns at once.
struct SpeechSource {
  std::function<std::shared_future<SpeechAnswer>(const SpeechRequest&)> speak;
  std::function<std::shared_ptr<const Speech>(const SpeechRequest&)> find;
  std::function<void(const std::vector<SpeechRequest>&)> prepare;
  std::function<Speaker::Counts()> counts;
};
SpeechSource make_speech_source(std::shared_ptr<Speaker> speaker);

// Holds what is being heard, remembered from tick to tick.
struct Sounding {
  uint32_t number = 0;  // number of the utterance; grows with every one, and after every pause
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

// Holds what one visitor hears.
struct VisitorSound {
  bool wanted = true;       // the visitor wants to hear
  uint32_t utterance = 0;   // whose sound is being sent; 0: none
  uint32_t given_up = 0;    // the utterance that was too much for its connection
  size_t samples_sent = 0;  // samples of the utterance
  Narration narration;      // narrator of the tour
};

// A line as the synthesiser is asked for it.
SpeechRequest request_of(const StoryLine& line, const std::string& lang, const VoiceManner& manner);
// Returns the lines that the storytellers and the narrator of tours may say, greetings first:
// stories that anybody may tell and tours in the voice of the first. All others are made when they
// are asked for.
std::vector<SpeechRequest> lines_of(const Exhibit& exhibit);

}  // namespace wellspring::show
