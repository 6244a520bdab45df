// SPDX-License-Identifier: Apache-2.0
// The mouth of a speaker over time: fifteen weights (the MPEG-4 set in Oculus' naming) that glide
// from one held shape to the next. visemes.h makes it from sounds.
//
// Laws, at every time: each weight in [0, 1]; their sum is 1, `sil` being the rest; a closure (p b
// m) holds PP = 1 from the beginning of its sound until it opens. Evaluation keeps no state, so it
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
extern const std::array<const char*, viseme_count> viseme_names;  // as above, order of Rig::viseme

using VisemeWeights = std::array<float, viseme_count>;

struct VisemeKey {
  double time = 0;
  VisemeWeights weights{};
};

struct VisemeTrack {
  // Times increase strictly; before the first and after the last the weights are theirs.
  std::vector<VisemeKey> keys;
};

// Weights at `time`; an empty track and a time that is not a number are silence.
VisemeWeights eval_visemes(const VisemeTrack& track, double time);

// From the name of a sound to the shapes of a mouth. The International Phonetic Alphabet is the
// key, because it means the same in every language, where eSpeak NG's own mnemonics do not ("y" is
// a rounded vowel in French and an unrounded one in Portuguese).

enum class MouthKind : uint8_t {
  closure,    // lips shut from the beginning: p b m
  tight,      // lip to teeth: f v
  consonant,  // made by the tongue
  vowel,
};

struct MouthShape {
  Viseme viseme = Viseme::sil;
  float share = 1;  // 0..1 of the mouth that it claims; the vowels around have the rest
  MouthKind kind = MouthKind::vowel;
  float part = 1;  // of the sound's time; all shapes of a sound sum to 1
};

// Shapes in order of time. Symbols that are not known are appended to `unknown` (once a call each)
// and count for nothing; a sound without any known shape holds what was before.
std::vector<MouthShape> mouth_shapes(std::string_view ipa, std::string* unknown = nullptr);

// Whether an eSpeak NG mnemonic is a pause ("_", "_:", "_::", "_!", "_|" ...).
bool is_pause(std::string_view mnemonic);

// From the sounds of a speech to the mouth of its speaker over time, once a speech.
//
// Co-articulation. Every phoneme has a shape and a share: bilabials and labiodentals keep all of
// the mouth, the tongue's consonants (d, k, n, ...) leave most of it to the vowels around them,
// the coming vowel more than the past one (look-ahead, Pelachaud, Badler, Steedman 1996, section
// 4; the shares stand for the dominance of Cohen & Massaro 1993). Diphthongs are two shapes or
// three. A held shape is reached and left by a smooth step, so weights have no corners.

// A phoneme as the mouth sees it.
struct MouthSound {
  double begin = 0, end = 0;
  std::vector<MouthShape> shapes;  // none: keeps on its way to the next (h, glottal stop)
  bool pause = false;
};

// `sounds` in order of time. Sounds shorter than 15 ms are passed over, but for closures.
VisemeTrack make_visemes(const std::vector<MouthSound>& sounds);

}  // namespace wellspring::avatar
