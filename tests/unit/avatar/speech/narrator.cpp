// SPDX-License-Identifier: Apache-2.0
#include "unit/avatar/speech/narrator.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string_view>

#include "avatar/speech/visemes.h"
#include "base/rng.h"

namespace wellspring::test {

namespace {

using Samples = std::vector<float>;

Speech speak(SpeechProcess& process, const SpeechRequest& request) {
  std::string error;
  auto speech = process.speak(request, error);
  if (!speech) throw std::runtime_error(error);
  return *speech;
}

float between(Rng& rng, float low, float high) { return low + (high - low) * rng.uniform(); }

// Sounds join over 4 ms, so that no click tells where.
void append(Samples& all, const Samples& piece) {
  size_t overlap = std::min({size_t(88), all.size(), piece.size()}), start = all.size() - overlap;
  for (size_t i = 0; i < overlap; i++) {
    float share = (float(i) + 0.5f) / float(overlap);
    all[start + i] = all[start + i] * (1 - share) + piece[i] * share;
  }
  all.insert(all.end(), piece.begin() + ptrdiff_t(overlap), piece.end());
}

// Grains of 40 ms of the middle of a sound, each half over the one before, at places drawn anew.
Samples drag_out(const Samples& sound, size_t begin, size_t end, size_t length, Rng& rng) {
  size_t grain = std::min<size_t>(880, end - begin);
  Samples out(length + grain);
  for (size_t at = 0; at < length; at += grain / 2) {
    size_t from = begin + size_t(rng.uniform() * float(end - begin - grain + 1));
    for (size_t i = 0; i < grain; i++) {
      float window =
          0.5f - 0.5f * std::cos(2 * std::numbers::pi_v<float> * (float(i) + 0.5f) / float(grain));
      if (at + i < out.size()) out[at + i] += window * sound[from + i];
    }
  }
  return out;
}

bool can_last(const SpeechPhoneme& phoneme) {
  for (std::string_view stop : {"p", "b", "t", "d", "k", "ɡ", "c", "ɟ", "ʔ", "ɾ"})
    if (std::string_view(phoneme.ipa).substr(0, stop.size()) == stop) return false;
  return phoneme.end - phoneme.begin > 0.06;
}

struct Telling {
  const Speech& speech;
  const Samples& sound;
  Rng& rng;
  Samples out;
  std::vector<SpeechWord> words;

  size_t at(double time) const { return std::min(size_t(time * speech.rate), sound.size()); }
  double now() const { return double(out.size()) / speech.rate; }
  Samples part(double begin, double end) const {
    return {sound.begin() + ptrdiff_t(at(begin)),
            sound.begin() + ptrdiff_t(at(std::max(begin, end)))};
  }
  void be_silent(float seconds) { append(out, Samples(size_t(seconds * float(speech.rate)))); }
  std::vector<const SpeechPhoneme*> phonemes(size_t word) const {
    std::vector<const SpeechPhoneme*> list;
    for (const SpeechPhoneme& phoneme : speech.phonemes)
      if (phoneme.word == int(word)) list.push_back(&phoneme);
    return list;
  }
  void say(size_t word) { append(out, part(speech.words[word].begin, speech.words[word].end)); }
  void stutter(size_t word) {
    auto sounds = phonemes(word);
    if (sounds.size() < 2) return;
    size_t count = sounds.size() > 3 && rng.uniform() < 0.5f ? 2 : 1;
    int times = 1 + int(3 * rng.uniform());
    const SpeechPhoneme& last = *sounds[count - 1];
    double quarter = (last.end - last.begin) / 4;
    bool dragged = can_last(last) && rng.uniform() < 0.4f;
    for (int i = 0; i < times; i++) {
      append(out, part(speech.words[word].begin, last.end - (dragged ? quarter : 0)));
      if (dragged)
        append(out, drag_out(sound, at(last.begin + quarter), at(last.end - quarter),
                             size_t(between(rng, 0.1f, 0.4f) * float(speech.rate)), rng));
      be_silent(between(rng, 0.03f, 0.25f));
    }
  }
  void drag(size_t word) {
    double begin = speech.words[word].begin, end = speech.words[word].end;
    for (const SpeechPhoneme* phoneme : phonemes(word)) {
      if (!can_last(*phoneme)) continue;
      double quarter = (phoneme->end - phoneme->begin) / 4, middle = phoneme->begin + 2 * quarter;
      append(out, part(begin, middle));
      append(out, drag_out(sound, at(middle - quarter), at(middle + quarter),
                           size_t(between(rng, 0.2f, 0.7f) * float(speech.rate)), rng));
      append(out, part(middle, end));
      return;
    }
    say(word);
  }
  void block(size_t word) {
    auto sounds = phonemes(word);
    double begin = speech.words[word].begin, split = sounds.size() > 1 ? sounds[0]->end : begin;
    append(out, part(begin, split));
    be_silent(between(rng, 0.1f, 0.4f));
    append(out, part(split, speech.words[word].end));
  }
};

Samples reverberate(const Samples& sound, double seconds, int rate, Rng& rng) {
  // Sparse echoes, denser than the ear tells apart, falling by 60 dB in the time given.
  struct Echo {
    size_t delay;
    float gain;
  };
  std::vector<Echo> echoes;
  for (int i = 0; i < 400; i++) {
    double time = seconds * double(rng.uniform());
    float sign = rng.uniform() < 0.5f ? -1.0f : 1.0f;
    echoes.push_back(
        {size_t((0.003 + time) * rate), 0.06f * sign * float(std::pow(10.0, -3 * time / seconds))});
  }
  Samples out = sound;
  for (const Echo& echo : echoes)
    for (size_t i = echo.delay; i < out.size(); i++) out[i] += echo.gain * sound[i - echo.delay];
  return out;
}

// Breaths, 30 dB under the loudest, where nobody speaks, and clicks wherever they fall.
void disturb(Samples& sound, int rate, const Manner& manner, Rng& rng) {
  size_t length = size_t(rate) / 5;
  for (size_t i = 0; i + length < sound.size(); i += length) {
    float loudest = 0;
    for (size_t k = i; k < i + length; k++) loudest = std::max(loudest, std::abs(sound[k]));
    if (loudest > 0.001f || rng.uniform() >= manner.breath) continue;
    for (size_t k = 0; k < length; k++) {
      float phase = (float(k) + 0.5f) / float(length);
      sound[i + k] += 0.04f * std::sin(std::numbers::pi_v<float> * phase) * (rng.uniform() - 0.5f);
    }
  }
  for (double at = 0; manner.clicks > 0;) {
    at -= std::log(1 - double(rng.uniform())) / double(manner.clicks);
    size_t i = size_t(at * rate);
    if (i + 20 >= sound.size()) break;
    float height = between(rng, 0.02f, 0.2f);
    for (size_t k = 0; k < 20; k++) sound[i + k] += height * (rng.uniform() - 0.5f);
  }
}

void record(Samples& sound, int rate, const Manner& manner, Rng& rng) {
  disturb(sound, rate, manner, rng);
  if (manner.room > 0) sound = reverberate(sound, manner.room, rate, rng);
  for (size_t i = 0; i < sound.size(); i++) {
    float turn = 2 * std::numbers::pi_v<float> * float(double(i % size_t(rate)) / rate);
    float noise = 0;
    for (int k = 0; k < 4; k++) noise += rng.uniform() - 0.5f;  // variance 1/3
    sound[i] = 0.4f * sound[i] + manner.hiss * 1.732f * noise +
               manner.hum * (std::sin(50 * turn) + 0.4f * std::sin(150 * turn));
  }
}

}  // namespace

Narrated narrate(SpeechProcess& process, const SpeechRequest& request, const Manner& manner) {
  Speech speech = speak(process, request);
  SpeechRequest other = request;
  other.text = "oh";
  Samples sound = from_pcm(speech.pcm), filler = from_pcm(speak(process, other).pcm);
  Rng rng{manner.seed};
  Telling telling{speech, sound, rng, {}, {}};
  telling.be_silent(0.6f);
  for (size_t w = 0; w < speech.words.size(); w++) {
    const SpeechWord& word = speech.words[w];
    if (w > 0) append(telling.out, telling.part(speech.words[w - 1].end, word.begin));
    float draw = rng.uniform();
    auto befalls = [&](float chance) { return (draw -= chance) < 0 && draw >= -chance; };
    bool paused = befalls(manner.pause), repeated = befalls(manner.repeat),
         again = befalls(manner.again);
    bool dragged = befalls(manner.prolong), blocked = befalls(manner.block),
         filled = befalls(manner.filler);
    if (paused) telling.be_silent(between(rng, 0.15f, 0.8f));
    if (repeated) telling.stutter(w);
    if (again && w > 0) {
      telling.be_silent(between(rng, 0.1f, 0.4f));
      SpeechWord& before = telling.words.back();
      before.begin = telling.now();
      telling.say(w - 1);
      before.end = telling.now();
    }
    if (filled) {
      telling.be_silent(between(rng, 0.05f, 0.2f));
      append(telling.out, filler);
      telling.be_silent(between(rng, 0.05f, 0.2f));
    }
    SpeechWord told = word;
    told.begin = telling.now();
    if (dragged) telling.drag(w);
    else if (blocked) telling.block(w);
    else telling.say(w);
    told.end = telling.now();
    telling.words.push_back(told);
  }
  telling.be_silent(0.6f);
  record(telling.out, speech.rate, manner, rng);
  return {{manner.rate, resample(telling.out, speech.rate, manner.rate)}, std::move(telling.words)};
}

}  // namespace wellspring::test
