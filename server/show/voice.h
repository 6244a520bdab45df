// SPDX-License-Identifier: Apache-2.0
// What the storyteller is saying: a queue of sentences with times, shown as subtitles and moving its
// mouth. A value advanced by time.
#pragma once
#include <deque>
#include <string>

#include "show/exhibit.h"

namespace wellspring {

struct Utterance {
  LocalText text;
  float seconds = 0;
};

struct Voice {
  std::deque<Utterance> queue;  // front: being said
  float elapsed = 0;            // of the front
  bool started = false;         // the front's subtitle has been shown
  bool paused = false;
  std::string story;            // id of the story being told; "" for greetings and the like
  int sentence = 0;             // of the story
};

struct VoiceEvents {
  const Utterance* begun = nullptr;  // points into the queue; valid until the next change
  bool fell_silent = false;
};

// How long a text takes to say and read: 0.9 s and 60 ms a character of its longest language.
float speaking_seconds(const LocalText& text);
// Sentence number `index` (wrapping) of every language.
LocalText nth_line(const LocalLines& lines, size_t index);

// Replaces what is being said (override) or follows it.
void say(Voice& voice, LocalText text, bool override_all);
void tell(Voice& voice, const StoryText& story, int from_sentence = 0);
void hush(Voice& voice);
VoiceEvents advance_voice(Voice& voice, float dt);
// Mouth activity now, 0 to 1: rises and falls with the syllables' pace.
float speaking(const Voice& voice);

}  // namespace wellspring
