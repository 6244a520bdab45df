// SPDX-License-Identifier: Apache-2.0
// Holds the mouth of a speaker over time: fifteen weights (the MPEG-4 set in Oculus' naming) that
// glide from one held shape to the next, which gives coarticulation. visemes.h makes it from
// sounds.
//
// At every time, each weight is in [0, 1]; their sum is 1, `sil` being the rest; a closure (p b m)
// holds PP = 1 from the beginning of its sound until it opens. Evaluation keeps no state, so it
// does not depend on the time step.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace wellspring::avatar {

enum class Viseme : uint8_t { sil, PP, FF, TH, DD, kk, CH, SS, nn, RR, aa, E, ih, oh, ou };
inline constexpr size_t viseme_count = 15;
// names as above, order of Rig::viseme
extern const std::array<const char*, viseme_count> viseme_names;

using VisemeWeights = std::array<float, viseme_count>;

struct VisemeKey {
  double time = 0;
  VisemeWeights weights{};
};

struct VisemeTrack {
  // Keys at times that increase strictly; the first and the last one hold outside.
  std::vector<VisemeKey> keys;
};

// Returns weights at `time`; an empty track and a time that is not a number are silence.
VisemeWeights eval_visemes(const VisemeTrack& track, double time);

// Turns the name of a sound into shapes of a mouth. The International Phonetic Alphabet is the key,
// because it means the same in every language; eSpeak NG's own mnemonics do not ("y" is a rounded
// vowel in French and an unrounded one in Portuguese).

enum class MouthKind : uint8_t {
  closure,    // lips shut from the beginning: p b m
  tight,      // lip to teeth: f v
  consonant,  // made by the tongue
  vowel,
};

struct MouthShape {
  Viseme viseme = Viseme::sil;
  float share = 1;  // share of the mouth that it claims, 0..1; the vowels around have the rest
  MouthKind kind = MouthKind::vowel;
  float part = 1;  // share of the sound's time; all shapes of a sound sum to 1
};

// Returns shapes in order of time. Unknown symbols are appended to `unknown` (once a call each) and
// count for nothing; a sound without any known shape holds the shape before it.
std::vector<MouthShape> mouth_shapes(std::string_view ipa, std::string* unknown = nullptr);

// Returns whether an eSpeak NG mnemonic is a pause ("_", "_:", "_::", "_!", "_|" ...).
bool is_pause(std::string_view mnemonic);

// Turns the sounds of a speech into the mouth of its speaker over time, once a speech.
//
// Co-articulation: every phoneme has a shape and a share. Bilabials and labiodentals keep all of
// the mouth, the tongue's consonants (d, k, n, ...) leave most of it to the vowels around them, the
// coming vowel more than the past one (look-ahead, Pelachaud, Badler, Steedman 1996, section 4; the
// shares stand for the dominance of Cohen & Massaro 1993). Diphthongs are two shapes or three. A
// held shape is reached and left by a smooth step, so weights have no corners.

// This is a phoneme as the mouth shows it.
struct MouthSound {
  double begin = 0, end = 0;
  std::vector<MouthShape> shapes;  // none: the mouth keeps on its way to the next (h, glottal stop)
  bool pause = false;
};

// Makes the track of `sounds`, which are in order of time. Sounds shorter than 15 ms are passed
// over, but for closures.
VisemeTrack make_visemes(const std::vector<MouthSound>& sounds);

}  // namespace wellspring::avatar
