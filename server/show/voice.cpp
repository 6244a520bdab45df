// SPDX-License-Identifier: Apache-2.0
#include "show/voice.h"

#include <algorithm>

namespace wellspring {

namespace {
constexpr float breath = 0.35f;  // pause after a sentence, part of its time

// Characters, not bytes: continuation bytes of UTF-8 do not count.
size_t character_count(const std::string& text) {
  return size_t(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}
}  // namespace

float speaking_seconds(const LocalText& text) {
  size_t longest = 0;
  for (const auto& [lang, words] : text) longest = std::max(longest, character_count(words));
  return 0.9f + 0.06f * float(longest);
}

LocalText nth_line(const LocalLines& lines, size_t index) {
  LocalText text;
  for (const auto& [lang, list] : lines)
    if (!list.empty()) text[lang] = list[index % list.size()];
  return text;
}

void hush(Voice& voice) {
  uint32_t cuts = voice.cuts + 1;
  voice = Voice{};
  voice.cuts = cuts;
}

void say(Voice& voice, LocalText text, bool override_all) {
  if (text.empty()) return;
  if (override_all) hush(voice);
  float seconds = speaking_seconds(text);
  voice.queue.push_back({std::move(text), seconds, nullptr});
}

void tell(Voice& voice, const StoryText& story, int from_sentence) {
  hush(voice);
  size_t count = 0;
  for (const auto& [lang, list] : story.text) count = std::max(count, list.size());
  for (size_t i = size_t(std::max(from_sentence, 0)); i < count; i++) {
    LocalText line;
    for (const auto& [lang, list] : story.text)
      if (i < list.size()) line[lang] = list[i];
    say(voice, std::move(line), false);
  }
  voice.story = story.id;
  voice.sentence = from_sentence;
}

VoiceEvents advance_voice(Voice& voice, float dt, const AskSpeech& ask) {
  VoiceEvents events;
  if (voice.queue.empty() || voice.paused) return events;
  dt = std::max(dt, 0.0f);
  if (voice.started) {
    voice.elapsed += dt;
    if (voice.elapsed < voice.queue.front().seconds) return events;
    voice.queue.pop_front();
    voice.elapsed = voice.waited = 0;
    voice.sentence++;
    voice.started = false;
    events.ended = true;
    if (voice.queue.empty()) {
      voice.story.clear();
      events.fell_silent = true;
      return events;
    }
    dt = 0;  // the next one has not waited yet
  }
  Utterance& front = voice.queue.front();
  SpeechState answer = ask ? ask(front) : SpeechState{};
  voice.waited += dt;
  if (answer.pending && voice.waited < longest_wait) return events;
  voice.started = true;
  voice.elapsed = 0;
  front.speech = std::move(answer.speech);
  if (front.speech) {
    front.seconds = float(front.speech->duration) + breath;
    voice.elapsed = -speech_lead;
  }
  events.begun = &front;
  return events;
}

const Speech* heard(const Voice& voice) {
  if (voice.queue.empty() || voice.paused || !voice.started) return nullptr;
  return voice.queue.front().speech.get();
}

float speaking(const Voice& voice, float ahead) {
  if (voice.queue.empty() || voice.paused || !voice.started) return 0;
  if (const Speech* speech = heard(voice))
    return 1 - eval_visemes(speech->visemes, double(voice.elapsed + ahead))[size_t(Viseme::sil)];
  float left = voice.queue.front().seconds - voice.elapsed - breath;
  return std::clamp(std::min(voice.elapsed / 0.15f, left / 0.15f), 0.0f, 1.0f);
}

}  // namespace wellspring
