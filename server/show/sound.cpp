// SPDX-License-Identifier: Apache-2.0
#include "show/sound.h"

#include <algorithm>
#include <cmath>

#include "base/log.h"
#include "show/news.h"
#include "show/show.h"
#include "wire/sound_packet.h"

namespace wellspring {

SpeechSource make_speech_source(std::shared_ptr<Speaker> speaker) {
  SpeechSource source;
  source.speak = [speaker](const SpeechRequest& request) { return speaker->speak(request); };
  source.find = [speaker](const SpeechRequest& request) { return speaker->find(request); };
  source.prepare = [speaker](const std::vector<SpeechRequest>& lines) { speaker->prepare(lines); };
  source.counts = [speaker] { return speaker->counts(); };
  return source;
}

std::vector<SpeechRequest> lines_of(const Exhibit& exhibit) {
  std::vector<SpeechRequest> lines;
  auto add = [&](const LocalLines& local) {
    for (const std::string& lang : exhibit.languages)
      if (auto found = local.find(lang); found != local.end())
        for (const std::string& text : found->second) lines.push_back({.text = text, .lang = lang});
  };
  if (!exhibit.storyteller) return lines;
  add(exhibit.storyteller->greetings);
  for (const StoryText& story : exhibit.stories) add(story.text);
  add(exhibit.storyteller->farewells);
  return lines;
}

namespace {

bool listens(const Visitor& visitor) { return visitor.welcomed && visitor.sound; }

SpeechRequest request_of(const Show& show, const LocalText& text) {
  const std::vector<std::string>& languages = show.exhibit.languages;
  std::string lang = spoken_language(show);
  return {.text = text_in(text, lang, languages), .lang = tag_in(text, lang, languages)};
}

SpeechState ask_speech(Show& show, const Utterance& utterance) {
  Sounding& sounding = show.sounding;
  SpeechRequest request = request_of(show, utterance.text);
  if (auto speech = show.speech.find(request)) return {speech, false};
  if (std::none_of(show.visitors.begin(), show.visitors.end(), listens)) return {};
  bool same = sounding.asked.text == request.text && sounding.asked.lang == request.lang;
  if (!same || !sounding.answer.valid()) {
    sounding.answer = show.speech.speak(request);
    sounding.asked = std::move(request);
  }
  if (!is_ready(sounding.answer)) return {nullptr, true};
  SpeechAnswer answer = sounding.answer.get();
  sounding.answer = {};
  if (!answer.speech && answer.error != sounding.last_error)
    log::warn("no voice, subtitles only: {}", sounding.last_error = answer.error);
  return {answer.speech, false};
}

void stop_sound(Visitor& visitor) {
  if (visitor.utterance == 0) return;
  visitor.link->drop_sound();
  visitor.link->send_text(speech_stop_news(visitor.utterance));
  visitor.utterance = 0;
}

void send_pieces(Show& show, Visitor& visitor, dvec3 mouth) {
  const Sounding& sounding = show.sounding;
  const Speech& speech = *sounding.speech;
  const size_t piece = std::max(size_t(sound_piece * speech.rate), size_t(1));
  const double due = (double(show.voice.elapsed) + sound_ahead) * speech.rate;
  while (visitor.samples_sent < speech.pcm.size() && double(visitor.samples_sent) < due) {
    const size_t count = std::min(piece, speech.pcm.size() - visitor.samples_sent);
    SoundHeader header;
    header.utterance = sounding.number;
    header.start = uint32_t(visitor.samples_sent);
    header.time_us = sounding.zero_us + uint64_t(1e6 * double(header.start) / speech.rate);
    header.total = uint32_t(speech.pcm.size());
    header.rate = uint32_t(speech.rate);
    header.mouth = mouth;
    auto packet = std::make_shared<Packet>(
        make_sound_packet(header, std::span(speech.pcm).subspan(header.start, count)));
    if (!visitor.link->send_sound(std::move(packet))) {
      visitor.given_up = sounding.number;
      show.totals.sounds_given_up++;
      stop_sound(visitor);
      return;
    }
    show.totals.sounds++;
    visitor.samples_sent += count;
  }
}

// A visitor begins to hear what is being said, from the present moment on.
void start_sound(const Show& show, Visitor& visitor, dvec3 mouth) {
  const Sounding& sounding = show.sounding;
  double at = std::max(double(show.voice.elapsed), 0.0) * sounding.speech->rate;
  visitor.utterance = sounding.number;
  visitor.samples_sent = std::min(size_t(at), sounding.speech->pcm.size());
  visitor.link->send_text(speech_news(sounding.number, *sounding.speech, mouth));
}

}  // namespace

std::string spoken_language(const Show& show) {
  const Visitor *kiosk = nullptr, *first = nullptr;
  for (const Visitor& visitor : show.visitors) {
    if (!visitor.welcomed) continue;
    if (show.voice.asked_by != 0 && visitor.link->id == show.voice.asked_by) return visitor.lang;
    if (!kiosk && visitor.kiosk) kiosk = &visitor;
    if (!first && visitor.sound) first = &visitor;
  }
  if (kiosk) return kiosk->lang;
  return first ? first->lang : show.exhibit.languages.front();
}

VoiceEvents advance_speech(Show& show, float dt) {
  AskSpeech ask;
  if (show.speech.find && show.speech.speak)
    ask = [&show](const Utterance& utterance) { return ask_speech(show, utterance); };
  VoiceEvents events = advance_voice(show.voice, dt, ask);
  Sounding& sounding = show.sounding;
  if (events.ended) {  // heard to its end: nothing to stop
    for (Visitor& visitor : show.visitors)
      if (visitor.utterance == sounding.number) visitor.utterance = 0;
    sounding.going = false;
  }
  if (events.begun) {
    show.totals.utterances += events.begun->speech != nullptr;
    // The next line, should it have been forgotten meanwhile.
    if (show.speech.prepare && events.begun->speech && show.voice.queue.size() > 1)
      show.speech.prepare({request_of(show, show.voice.queue[1].text)});
  }
  return events;
}

void send_sounds(Show& show) {
  Sounding& sounding = show.sounding;
  const Speech* now = heard(show.voice);
  if (!now || now != sounding.speech.get() || show.voice.cuts != sounding.cuts) sounding.going = false;
  if (now && !sounding.going) {
    sounding.number++;
    sounding.going = true;
    sounding.cuts = show.voice.cuts;
    sounding.speech = show.voice.queue.front().speech;
    sounding.zero_us = show.time_us - uint64_t(std::llround(1e6 * double(show.voice.elapsed)));
  }
  if (!now) sounding.speech = nullptr;
  const bool anybody = now && std::any_of(show.visitors.begin(), show.visitors.end(), listens);
  const dvec3 mouth = anybody ? dvec3(eval_mouth(show.mind, show.storyteller, show.pose)) +
                                    show.exhibit.scene.origin
                              : dvec3(0);
  for (Visitor& visitor : show.visitors) {
    const bool hears = now && listens(visitor) && visitor.given_up != sounding.number;
    if (!hears || visitor.utterance != sounding.number) stop_sound(visitor);
    if (!hears) continue;
    if (visitor.utterance == 0) start_sound(show, visitor, mouth);
    send_pieces(show, visitor, mouth);
  }
}

}  // namespace wellspring
