// SPDX-License-Identifier: Apache-2.0
// From the name of a sound to the shapes of a mouth. The International Phonetic Alphabet is the
// key, because it means the same in every language, where eSpeak NG's own mnemonics do not ("y" is
// a rounded vowel in French and an unrounded one in Portuguese).
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "avatar/speech/visemes.h"

namespace wellspring::avatar {

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

}  // namespace wellspring::avatar
