// SPDX-License-Identifier: Apache-2.0
#include "show/answer/sound.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/log.h"
#include "show/answer/events.h"
#include "wire/packet.h"

namespace wellspring::show {

namespace {

VoiceManner manner_of(const ExhibitStage& stage, const ShowCast& cast, const Teller& teller) {
  const StorytellerPlace* storyteller_place = storyteller_of(stage, cast, teller);
  return storyteller_place ? storyteller_place->voice : VoiceManner{};
}

constexpr uint8_t heard_everywhere = 1;  // flag of a sound packet

bool listens(const Visitor& visitor) { return visitor.welcomed && visitor.hearing.wanted; }

bool has_listener(const Show& show, const Teller& teller) {
  return std::any_of(show.visits.visitors.begin(), show.visits.visitors.end(),
                     [&](const Visitor& visitor) {
                       return visitor.hearing.wanted && listens_to(show, visitor, teller);
                     });
}

// A voice, whose it is, what is heard of it, and the language it speaks.
struct Channel {
  const Teller& teller;
  Voice& voice;
  Sounding& sounding;
  std::string lang;
  bool anybody = false;  // listens
};

SpeechState ask_speech(const ExhibitStage& stage, const ShowCast& cast, Channel& channel,
                       const Utterance& utterance) {
  Sounding& sounding = channel.sounding;
  const auto* line = line_in(utterance.line, channel.lang, stage.exhibit.languages);
  if (line->second.recording) return {line->second.recording, false, line->first};
  SpeechRequest request =
      request_of(line->second, line->first, manner_of(stage, cast, channel.teller));
  std::string lang = request.lang;
  if (!cast.speech.find || !cast.speech.speak) return {nullptr, false, channel.lang};
  if (auto speech = cast.speech.find(request)) return {speech, false, lang};
  if (!channel.anybody) return {nullptr, false, lang};
  if (sounding.asked != request || !sounding.answer.valid()) {
    sounding.answer = cast.speech.speak(request);
    sounding.asked = std::move(request);
  }
  if (!is_ready(sounding.answer)) return {nullptr, true, lang};
  SpeechAnswer answer = sounding.answer.get();
  sounding.answer = {};
  if (!answer.speech && answer.error != sounding.last_error)
    log::warn("no voice, subtitles only: {}", sounding.last_error = answer.error);
  return {answer.speech, false, lang};
}

VoiceEvents advance_channel(Show& show, Channel channel, float dt) {
  auto ask = [&](const Utterance& utterance) {
    return ask_speech(show.stage, show.cast, channel, utterance);
  };
  VoiceEvents events = advance_voice(channel.voice, dt, ask);
  if (events.ended) {  // heard to its end: nothing to stop
    for (Visitor& visitor : show.visits.visitors)
      if (visitor.hearing.utterance == channel.sounding.number) visitor.hearing.utterance = 0;
    channel.sounding.going = false;
  }
  if (events.begun) {
    show.totals.utterances += events.begun->speech != nullptr;
    // The next line, should it have been forgotten meanwhile.
    if (show.cast.speech.prepare && events.begun->speech && channel.voice.queue.size() > 1) {
      const auto* next =
          line_in(channel.voice.queue[1].line, channel.lang, show.stage.exhibit.languages);
      if (!next->second.recording)
        show.cast.speech.prepare({request_of(next->second, next->first,
                                             manner_of(show.stage, show.cast, channel.teller))});
    }
  }
  return events;
}

// Whether something of the voice is heard now, under which number and since when.
const Speech* update_sounding(ShowCast& cast, uint64_t time_us, const Voice& voice,
                              Sounding& sounding) {
  const Speech* now = heard(voice);
  if (!now || now != sounding.speech.get() || voice.cuts != sounding.cuts) sounding.going = false;
  if (now && !sounding.going) {
    sounding.number = ++cast.utterances;
    sounding.going = true;
    sounding.cuts = voice.cuts;
    sounding.speech = voice.queue.front().speech;
    sounding.zero_us = time_us - uint64_t(std::llround(1e6 * double(voice.elapsed)));
  }
  if (!now) sounding.speech = nullptr;
  return now;
}

void stop_sound(Visitor& visitor) {
  if (visitor.hearing.utterance == 0) return;
  visitor.link->drop_sound();
  visitor.link->send_text(speech_stop_message(visitor.hearing.utterance));
  visitor.hearing.utterance = 0;
}

// Holds one sound that a visitor is to hear.
struct Source {
  const Voice* voice = nullptr;
  const Sounding* sounding = nullptr;
  dvec3 mouth{0};
  bool everywhere = false;
};

void send_pieces(ShowTotals& totals, Visitor& visitor, const Source& source) {
  VisitorSound& hearing = visitor.hearing;
  const Sounding& sounding = *source.sounding;
  const Speech& speech = *sounding.speech;
  const size_t piece = std::max(size_t(sound_piece * speech.rate), size_t(1));
  const double due = (double(source.voice->elapsed) + sound_ahead) * speech.rate;
  while (hearing.samples_sent < speech.pcm.size() && double(hearing.samples_sent) < due) {
    const size_t count = std::min(piece, speech.pcm.size() - hearing.samples_sent);
    SoundHeader header;
    header.utterance = sounding.number;
    header.start = uint32_t(hearing.samples_sent);
    header.time_us = sounding.zero_us + uint64_t(1e6 * double(header.start) / speech.rate);
    header.total = uint32_t(speech.pcm.size());
    header.rate = uint32_t(speech.rate);
    header.flags = source.everywhere ? heard_everywhere : 0;
    header.mouth = source.mouth;
    auto packet = std::make_shared<Packet>(
        make_sound_packet(header, std::span(speech.pcm).subspan(header.start, count)));
    if (!visitor.link->send_sound(std::move(packet))) {
      hearing.given_up = sounding.number;
      totals.sounds_given_up++;
      stop_sound(visitor);
      return;
    }
    totals.sounds++;
    hearing.samples_sent += count;
  }
}

// A visitor begins to hear what is being said, from the present moment on.
void start_sound(Visitor& visitor, const Source& source) {
  VisitorSound& hearing = visitor.hearing;
  const Sounding& sounding = *source.sounding;
  double from = std::max({double(source.voice->elapsed), double(source.voice->silent_until), 0.0});
  double at = std::round(from * sounding.speech->rate);
  hearing.utterance = sounding.number;
  hearing.samples_sent = std::min(size_t(at), sounding.speech->pcm.size());
  visitor.link->send_text(speech_message(sounding.number, *sounding.speech, source.mouth));
}

}  // namespace

std::string spoken_language(const Show& show, const Teller& teller) {
  const Visitor *kiosk = nullptr, *first = nullptr;
  for (const Visitor& visitor : show.visits.visitors) {
    if (!listens_to(show, visitor, teller)) continue;
    if (teller.voice.asked_by != 0 && visitor.link->id == teller.voice.asked_by)
      return visitor.lang;
    if (!kiosk && visitor.kiosk) kiosk = &visitor;
    if (!first && visitor.hearing.wanted) first = &visitor;
  }
  if (kiosk) return kiosk->lang;
  return first ? first->lang : show.stage.exhibit.languages.front();
}

VoiceEvents advance_speech(Show& show, Teller& teller, float dt) {
  const bool anybody = has_listener(show, teller);
  return advance_channel(
      show, {teller, teller.voice, teller.sounding, spoken_language(show, teller), anybody}, dt);
}

VoiceEvents advance_narration(Show& show, Visitor& visitor, float dt) {
  Narration& narration = visitor.hearing.narration;
  return advance_channel(show,
                         {teller_of(show.cast, show.visits, visitor), narration.voice,
                          narration.sounding, visitor.lang, listens(visitor)},
                         dt);
}

void send_sounds(Show& show) {
  std::map<const Teller*, Source> told;
  for (Teller* teller : tellers_of(show.cast, show.visits)) {
    if (!update_sounding(show.cast, show.time_us, teller->voice, teller->sounding)) continue;
    if (!has_listener(show, *teller)) continue;
    const vec3 mouth = eval_mouth(teller->mind, teller->storyteller, teller->pose);
    told[teller] = {&teller->voice, &teller->sounding,
                    dvec3(mouth) + show.stage.exhibit.scene.origin};
  }
  for (Visitor& visitor : show.visits.visitors)
    update_sounding(show.cast, show.time_us, visitor.hearing.narration.voice,
                    visitor.hearing.narration.sounding);
  for (Visitor& visitor : show.visits.visitors) {
    const auto own = told.find(&teller_of(show.cast, show.visits, visitor));
    Source source = own != told.end() && hears_storyteller(show, visitor) ? own->second : Source{};
    const Visitor* leader = leader_of(show.visits, visitor);
    const Narration& narration = (leader ? *leader : visitor).hearing.narration;
    const bool narrated = narration.sounding.going;
    if (!narration.voice.queue.empty())
      source = {&narration.voice, narrated ? &narration.sounding : nullptr,
                visitor.place.view.position, true};
    const bool hears =
        source.sounding && listens(visitor) && visitor.hearing.given_up != source.sounding->number;
    if (!hears || visitor.hearing.utterance != source.sounding->number) stop_sound(visitor);
    if (!hears) continue;
    if (visitor.hearing.utterance == 0) start_sound(visitor, source);
    send_pieces(show.totals, visitor, source);
  }
}

}  // namespace wellspring::show
