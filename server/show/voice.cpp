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

void hush(Voice& voice) { voice = Voice{}; }

void say(Voice& voice, LocalText text, bool override_all) {
  if (text.empty()) return;
  if (override_all) hush(voice);
  float seconds = speaking_seconds(text);
  voice.queue.push_back({std::move(text), seconds});
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

VoiceEvents advance_voice(Voice& voice, float dt) {
  VoiceEvents events;
  if (voice.queue.empty() || voice.paused) return events;
  if (!voice.started) {
    voice.started = true;
    voice.elapsed = 0;
    events.begun = &voice.queue.front();
    return events;
  }
  voice.elapsed += std::max(dt, 0.0f);
  if (voice.elapsed < voice.queue.front().seconds) return events;
  voice.queue.pop_front();
  voice.elapsed = 0;
  voice.sentence++;
  voice.started = !voice.queue.empty();
  if (voice.queue.empty()) {
    voice.story.clear();
    events.fell_silent = true;
  } else {
    events.begun = &voice.queue.front();
  }
  return events;
}

float speaking(const Voice& voice) {
  if (voice.queue.empty() || voice.paused || !voice.started) return 0;
  float left = voice.queue.front().seconds - voice.elapsed - breath;
  return std::clamp(std::min(voice.elapsed / 0.15f, left / 0.15f), 0.0f, 1.0f);
}

}  // namespace wellspring
