// SPDX-License-Identifier: Apache-2.0
#include "show/storyteller/voice.h"

#include <algorithm>

namespace wellspring::show {

namespace {
constexpr float breath = 0.35f;  // pause after a sentence, part of its time

// Characters, not bytes: continuation bytes of UTF-8 do not count.
size_t character_count(const std::string& text) {
  return size_t(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}
}  // namespace

float speaking_seconds(const LocalLine& line) {
  size_t longest = 0;
  for (const auto& [lang, one] : line) longest = std::max(longest, character_count(one.text));
  return 0.9f + 0.06f * float(longest);
}

LocalLine nth_line(const LocalScript& lines, size_t index) {
  LocalLine line;
  for (const auto& [lang, list] : lines)
    if (!list.empty()) line[lang] = list[index % list.size()];
  return line;
}

void hush(Voice& voice) {
  uint32_t cuts = voice.cuts + 1;
  voice = Voice{};
  voice.cuts = cuts;
}

void say(Voice& voice, LocalLine line, bool override_all) {
  if (line.empty()) return;
  if (override_all) hush(voice);
  Utterance utterance;
  utterance.seconds = speaking_seconds(line);
  utterance.line = std::move(line);
  voice.queue.push_back(std::move(utterance));
}

void say_all(Voice& voice, const LocalScript& script) {
  for (size_t i = 0; i < line_count(script); i++) say(voice, line_at(script, i), false);
}

void tell(Voice& voice, const StoryText& story, int from_sentence) {
  hush(voice);
  size_t first = size_t(std::max(from_sentence, 0));
  for (size_t i = first; i < line_count(story.text); i++) say(voice, line_at(story.text, i), false);
  if (voice.queue.empty()) return;
  if (!story.text.empty()) voice.held = hold_before(story.text.begin()->second, first);
  voice.story = story.id;
  voice.sentence = int(first);
}

void pause_voice(Voice& voice) { voice.paused = true; }

void resume_voice(Voice& voice) {
  if (!voice.paused) return;
  voice.paused = false;
  const Speech* speech = heard(voice);
  if (!speech || voice.elapsed <= 0) return;
  double from = double(voice.elapsed);
  for (const SpeechWord& word : speech->words)
    if (word.begin <= from && from < word.end + 0.1) from = word.begin;
  voice.silent_until = float(from);
  voice.elapsed = float(from) - speech_lead;
}

namespace {

// The front's marks in the language it is said in.
void start_front(Voice& voice, SpeechState answer) {
  Utterance& front = voice.queue.front();
  voice.started = true;
  voice.elapsed = 0;
  front.speech = std::move(answer.speech);
  auto line = front.line.find(answer.lang);
  if (line == front.line.end()) line = front.line.begin();
  front.lang = line->first;
  double words = double(front.seconds - breath);
  if (front.speech) {
    front.seconds = float(front.speech->duration) + breath;
    voice.elapsed = -speech_lead;
  }
  front.seconds += line->second.pause;
  // A narrator's pauses are his own.
  if (front.speech && front.speech->recorded) front.seconds = float(front.speech->duration);
  front.timeline = make_timeline(line->second, front.speech.get(), words);
}

void act(Voice& voice, VoiceEvents& events) {
  Utterance& front = voice.queue.front();
  for (const ActionEvent* event :
       advance_timeline(front.timeline, voice.cursor, double(voice.elapsed))) {
    hold(voice.held, *event);
    events.acts.push_back(*event);
  }
}

}  // namespace

VoiceEvents advance_voice(Voice& voice, float dt, const AskSpeech& ask) {
  VoiceEvents events;
  if (voice.queue.empty() || voice.paused) return events;
  dt = std::max(dt, 0.0f);
  if (voice.started) {
    voice.elapsed += dt;
    act(voice, events);
    if (voice.elapsed < voice.queue.front().seconds) return events;
    voice.queue.pop_front();
    voice.elapsed = voice.waited = 0;
    voice.silent_until = -1e9f;
    voice.cursor = 0;
    voice.held.point.clear();
    voice.sentence++;
    voice.started = false;
    events.ended = true;
    if (voice.queue.empty()) {
      voice.story.clear();
      voice.held = {};
      events.fell_silent = true;
      return events;
    }
    dt = 0;  // the next one has not waited yet
  }
  SpeechState answer = ask ? ask(voice.queue.front()) : SpeechState{};
  voice.waited += dt;
  if (answer.pending && voice.waited < longest_wait) return events;
  start_front(voice, std::move(answer));
  act(voice, events);
  events.begun = &voice.queue.front();
  return events;
}

const Speech* heard(const Voice& voice) {
  if (voice.queue.empty() || voice.paused || !voice.started) return nullptr;
  return voice.queue.front().speech.get();
}

VisemeWeights mouth_shape(const Voice& voice, float ahead) {
  const Speech* speech = heard(voice);
  double at = double(voice.elapsed + ahead);
  if (!speech || at < double(voice.silent_until)) at = -1e9;
  return eval_visemes(speech ? speech->visemes : VisemeTrack{}, at);
}

float speaking(const Voice& voice, float ahead) {
  if (voice.queue.empty() || voice.paused || !voice.started) return 0;
  if (heard(voice)) return 1 - mouth_shape(voice, ahead)[size_t(Viseme::sil)];
  float left = voice.queue.front().seconds - voice.elapsed - breath;
  return std::clamp(std::min(voice.elapsed / 0.15f, left / 0.15f), 0.0f, 1.0f);
}

SpeechSource make_speech_source(std::shared_ptr<Speaker> speaker) {
  SpeechSource source;
  source.speak = [speaker](const SpeechRequest& request) { return speaker->speak(request); };
  source.find = [speaker](const SpeechRequest& request) { return speaker->find(request); };
  source.prepare = [speaker](const std::vector<SpeechRequest>& lines) { speaker->prepare(lines); };
  source.counts = [speaker] { return speaker->counts(); };
  return source;
}

SpeechRequest request_of(const StoryLine& line, const std::string& lang,
                         const VoiceManner& manner) {
  SpeechRequest request;
  request.text = line.text;
  request.lang = lang;
  request.words_per_minute = manner.words_per_minute;
  request.pitch = manner.pitch;
  request.variant = manner.variant;
  request.styles = line.styles;
  return request;
}

std::vector<SpeechRequest> lines_of(const Exhibit& exhibit) {
  std::vector<SpeechRequest> lines;
  auto add = [&](const LocalScript& script, const VoiceManner& manner) {
    for (const std::string& lang : exhibit.languages)
      if (auto found = script.find(lang); found != script.end())
        for (const StoryLine& line : found->second)
          if (!line.recording) lines.push_back(request_of(line, lang, manner));
  };
  for (size_t i = 0; i < exhibit.storytellers.size(); i++) {
    const StorytellerPlace& storyteller_place = exhibit.storytellers[i];
    add(storyteller_place.greetings, storyteller_place.voice);
    for (const StoryText& story : exhibit.stories)
      if (story.storyteller_index < 0 ? i == 0 : story.storyteller_index == int(i))
        add(story.text, storyteller_place.voice);
    add(storyteller_place.farewells, storyteller_place.voice);
  }
  const VoiceManner narrator =
      exhibit.storytellers.empty() ? VoiceManner{} : exhibit.storytellers.front().voice;
  for (const TourPlan& tour : exhibit.tours)
    for (const TourStop& stop : tour.stops) {
      add(stop.way_text, narrator);
      add(stop.text, narrator);
    }
  return lines;
}

}  // namespace wellspring::show
