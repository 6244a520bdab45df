// SPDX-License-Identifier: Apache-2.0
#include "avatar/face/face.h"

#include <cmath>

#include "avatar/figure/noise.h"
#include "avatar/figure/spring_bones.h"

namespace wellspring::avatar {
namespace {

constexpr double syllables_a_second = 4.6;
constexpr float emotion_rate =
    7;  // 1/s, critically damped: an emotion is nine tenths there after 0.56 s
constexpr float situation_settle = 0.8f;
// share of Perlin's noise: his face is a cartoon's, this one a person's
constexpr float stir = 0.3f;

float blend(float low, float high, float x) { return smooth_step(low, high, x); }

// Makes up syllables, each a consonant and a vowel; the vowel carries over into the next consonant.
void make_up_syllables(double syllables, float talking, std::array<float, 15>& viseme) {
  auto of = [](double index, uint64_t salt) { return mix64(uint64_t(int64_t(index)) * 2 + salt); };
  double index = std::floor(syllables);
  float p = float(syllables - index);
  size_t consonant = 1 + size_t(of(index, 0) % 9), vowel = 10 + size_t(of(index, 1) % 5);
  size_t vowel_before = 10 + size_t(of(index - 1, 1) % 5);
  float stress = 0.40f + 0.35f * float(of(index, 1) >> 40) * 0x1p-24f;
  float on = blend(0, 0.2f, p) * (1 - blend(0.22f, 0.45f, p));
  viseme[consonant] += talking * (consonant == 1 ? 0.9f : 0.6f) * on;  // only p, b, m must close
  viseme[vowel_before] += talking * 0.4f * (1 - blend(0, 0.22f, p));
  viseme[vowel] += talking * stress * blend(0.2f, 0.5f, p);
}

void tick_talk(FaceState& state, const FaceInput& input, float dt, Protected& words) {
  float speaking = input.speaking > 0 ? std::min(input.speaking, 1.0f) : 0;  // NaN is silence
  state.talking = approach(state.talking, speaking, 0.07f, dt);
  if (state.talking < 1e-4f) state.talking = 0;
  words.talking = state.talking;
  if (state.talking > 0) {
    // The head's emphasis keeps time with the syllables, whether they are made up or not.
    double pace = syllables_a_second * (1 + 0.2 * double(smooth_noise(40, state.syllables * 0.7)));
    state.syllables = std::fmod(state.syllables + pace * double(dt), 1e6);
  }
  if (input.visemes) words.visemes = *input.visemes;
  else if (state.talking > 0) make_up_syllables(state.syllables, state.talking, words.visemes);
}

float unpleasant(const Emotions& e) {
  return std::min(e[Emotion::sadness] + e[Emotion::anger] + e[Emotion::fear] + e[Emotion::disgust],
                  1.0f);
}

void add_flexes(const PerlinFace& face, const ExpressionRig& rig, ExpressionSum& sum,
                StorytellerWork& work) {
  for (size_t f = 0; f < flex_count; f++)
    for (size_t side = 0; side < 2; side++) {
      float value = face.flex[f][side].sum();
      int expression = rig.flex[f][side][value > 0];
      if (value == 0 || expression < 0) continue;
      add(sum, rig, expression, std::abs(value));
      work.flexes++;
    }
}

}  // namespace

Emotions layered(const Emotions& story, const Emotions& visitor, float weight,
                 float override_amount) {
  // A farewell is absolute: it leaves nothing of the story to combine with.
  return bounded(add(mix(story, Emotions{}, override_amount), visitor, weight));
}

void tick_face(FaceState& state, const ExpressionRig& rig, const FaceInput& input, double now,
               float dt, ExpressionSum& sum, Protected& words, StorytellerWork& work) {
  clear(sum, rig);
  words.visemes = {};
  words.talking = 0;
  if (input.detail == Detail::none) return;
  tick_talk(state, input, dt, words);
  if (words.talking > 0 || input.visemes) work.visemes++;
  bool full = input.detail == Detail::full;

  Emotions felt;
  if (full) {
    felt = tick_empathy(state.empathy, input.visitor, dt);
    work.empathy++;
  }
  Emotions wanted = layered(input.story, felt, empathy_weight, input.parting ? 1.0f : 0.0f);
  state.beat_wanted = std::max(approach(state.beat_wanted, 0, 0.12f, dt),
                               input.beat > 0 ? std::min(input.beat, 1.0f) : 0);
  settle(state.beat, state.beat_wanted, 14, dt);

  // The situation moves Perlin's flexes by mood and noise; farther away they make all of the face.
  PerlinFace& perlin = state.perlin;
  for (auto& sides : perlin.flex)
    for (PerlinFace::Value& value : sides) value.target = 0;
  float pleasant = 1 - unpleasant(wanted);
  set_target(perlin, Flex::smile, input.smile * pleasant);
  set_target(perlin, Flex::brows, input.brows);
  if (!full)
    for (size_t i = 0; i < emotion_count; i++) add_targets(perlin, Emotion(i), wanted.weight[i]);
  work.flex_noise +=
      uint64_t(tick_perlin(perlin, full && input.humanlike ? stir : 0, situation_settle, now, dt));
  add_flexes(perlin, rig, sum, work);
  if (state.beat.value > 1e-3f)
    for (size_t side = 0; side < 2; side++)
      add(sum, rig, rig.flex[size_t(Flex::brows)][side][1], 0.45f * state.beat.value);

  // Emotions show by their own expressions, near by.
  for (size_t i = 0; i < emotion_count; i++) {
    Spring& shown = state.emotion[i];
    settle(shown, full ? wanted.weight[i] : 0, emotion_rate, dt);
    if (shown.value < 1e-4f) continue;
    add(sum, rig, rig.emotion[i], shown.value);
    work.expressions++;
  }
}

namespace {
constexpr float down = 0.07f, held = 0.035f, up = 0.12f;
}

float tick_blink(BlinkState& state, Rng& rng, double now, bool humanlike) {
  if (now >= state.next) {
    // After a long pause between ticks no blinks are made up for.
    state.begun = now - state.next < 0.5 ? state.next : now;
    state.count++;
    if (!humanlike) {
      state.next = state.begun + 4;
      state.twice = false;
    } else if (!state.twice && rng.uniform() < 0.12f) {
      state.next = state.begun + 0.30;
      state.twice = true;
    } else {
      state.next = state.begun + 2 + 3 * double(rng.uniform());
      state.twice = false;
    }
  }
  float t = float(std::min(now - state.begun, 1e3));
  if (t < down) return smooth_step(0, down, t);
  if (t < down + held) return 1;
  return 1 - smooth_step(down + held, down + held + up, t);
}

void ask_blink(BlinkState& state, double now) {
  if (now - state.begun > 0.8 && state.next - now > 0.25) state.next = now;
}

namespace {

// [seen][shown]: joy, sadness, anger, fear, disgust, surprise.
constexpr float answers[emotion_count][emotion_count] = {
    {0.9f, 0, 0, 0, 0, 0},      // joy is shared
    {0, 0.6f, 0, 0, 0, 0},      // sadness: concern
    {0, 0.25f, 0, 0, 0, 0},     // anger is met with calm attention
    {0, 0.3f, 0, 0, 0, 0.1f},   // fear: concern
    {0, 0, 0, 0, 0, 0.25f},     // disgust: is something wrong?
    {0.15f, 0, 0, 0, 0, 0.6f},  // surprise is shared, with pleasure
};

}  // namespace

Emotions answer_to(const Emotions& seen) {
  Emotions answer;
  for (size_t s = 0; s < emotion_count; s++) {
    float weight = seen.weight[s];
    if (!(weight > 0)) continue;  // skips NaN, too
    weight = std::min(weight, 1.0f) * smooth_step(0.2f, 0.4f, weight);
    for (size_t a = 0; a < emotion_count; a++) answer.weight[a] += weight * answers[s][a];
  }
  return answer;
}

Emotions tick_empathy(EmpathyState& state, const Emotions* seen, float dt) {
  Emotions wanted = seen ? answer_to(*seen) : Emotions{}, felt;
  for (size_t i = 0; i < emotion_count; i++) {
    settle(state.felt[i], wanted.weight[i], empathy_rate, dt);
    felt.weight[i] = state.felt[i].value;
  }
  return felt;
}

}  // namespace wellspring::avatar
