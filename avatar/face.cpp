// SPDX-License-Identifier: Apache-2.0
#include "avatar/face.h"

#include "avatar/noise.h"

namespace wellspring {
namespace {

// How far the jaw opens for each viseme, 0..1 (ARKit blends of the viseme table, jawOpen scaled to
// 0.65 = 1).
constexpr float jaw_of[15] = {0,     0,     0.06f, 0.15f, 0.14f, 0.24f, 0.10f, 0.06f,
                              0.16f, 0.16f, 0.85f, 0.50f, 0.24f, 0.60f, 0.24f};
constexpr double syllables_a_second = 4.6;

float blend(float low, float high, float x) { return smooth_step(low, high, x); }

}  // namespace

void tick_face(FaceState& state, float speaking, const std::array<float, 15>* visemes, float smile,
               float brow, bool humanlike, double now, float dt, FacePose& face) {
  speaking = speaking > 0 ? std::min(speaking, 1.0f) : 0;  // NaN is silence
  state.talking = approach(state.talking, speaking, 0.07f, dt);
  if (state.talking < 1e-4f) state.talking = 0;
  settle(state.smile, smile, 4, dt);
  settle(state.brow, brow, 6, dt);

  if (state.talking > 0) {
    // The head's emphasis keeps time with the syllables, made up or not.
    double pace = syllables_a_second * (1 + 0.2 * double(smooth_noise(40, state.syllables * 0.7)));
    state.syllables = std::fmod(state.syllables + pace * double(dt), 1e6);
  }
  if (visemes) {
    for (size_t i = 0; i < 15; i++) {
      face.viseme[i] = (*visemes)[i];
      face.open += face.viseme[i] * jaw_of[i];
    }
  } else if (state.talking > 0) {
    // Each syllable: a consonant, then a vowel; the vowel carries over into the next consonant.
    auto of = [](double index, uint64_t salt) {
      return mix64(uint64_t(int64_t(index)) * 2 + salt);
    };
    double index = std::floor(state.syllables);
    float p = float(state.syllables - index);
    size_t consonant = 1 + size_t(of(index, 0) % 9), vowel = 10 + size_t(of(index, 1) % 5);
    size_t vowel_before = 10 + size_t(of(index - 1, 1) % 5);
    float stress = 0.40f + 0.35f * float(of(index, 1) >> 40) * 0x1p-24f;
    float on = blend(0, 0.2f, p) * (1 - blend(0.22f, 0.45f, p));
    face.viseme[consonant] +=
        state.talking * (consonant == 1 ? 0.9f : 0.6f) * on;  // only p, b, m must close
    face.viseme[vowel_before] += state.talking * 0.4f * (1 - blend(0, 0.22f, p));
    face.viseme[vowel] += state.talking * stress * blend(0.2f, 0.5f, p);
    for (size_t i = 0; i < 15; i++) face.open += face.viseme[i] * jaw_of[i];
    if (consonant == 1) face.open *= 1 - on;  // lips meet for p, b and m
  }
  // A mouth that speaks smiles less.
  float level = state.smile.value * (1 - 0.45f * state.talking);
  face.smile = {level, level};
  face.brow_up = {state.brow.value, state.brow.value};
  face.squint = 0.35f * level;
  if (humanlike) {
    float a = smooth_noise(30, now * 0.3), b = smooth_noise(31, now * 0.22);
    for (float& v : face.smile) v += 0.04f * a;
    face.smile[0] += 0.03f * b;
    float lift = 0.05f * b + state.talking * 0.18f * std::max(smooth_noise(32, now * 0.8), 0.0f);
    for (float& v : face.brow_up) v += lift;
    face.brow_inner_up += 0.04f * smooth_noise(33, now * 0.2);
  }
}

void eval_face(const Rig& rig, const FacePose& face, Pose& pose) {
  auto set = [&](int displacer, float weight) {
    if (displacer >= 0) pose.displacers[size_t(displacer)] += std::clamp(weight, 0.0f, 1.0f);
  };
  for (size_t side = 0; side < 2; side++) {
    float closed = std::clamp(face.closed[side], 0.0f, 1.0f);
    if (rig.blink[side] >= 0) set(rig.blink[side], closed);
    else if (rig.lids_move)
      pose.rotations[size_t(rig.lid[side])] = glm::angleAxis(38_deg * closed, vec3(1, 0, 0));
    set(rig.smile[side], face.smile[side]);
    set(rig.brow_up[side], face.brow_up[side]);
    set(rig.squint[side], face.squint * (1 - closed));
    set(rig.lid_wide[side], face.wide * (1 - closed));
  }
  set(rig.brow_inner_up, face.brow_inner_up);
  set(rig.breathe, face.breath);
  for (size_t i = 0; i < 15; i++) set(rig.viseme[i], face.viseme[i]);
  // Mouth shapes bring their own opening of the jaw.
  if (rig.viseme[10] >= 0) return;
  if (rig.jaw_moves)
    pose.rotations[size_t(rig.jaw)] =
        glm::angleAxis(12_deg * std::min(face.open, 1.0f), vec3(1, 0, 0));
  else set(rig.mouth_open, 0.8f * face.open);
}

}  // namespace wellspring
