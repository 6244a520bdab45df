// SPDX-License-Identifier: Apache-2.0
#include "avatar/speech/mouth_shapes.h"

#include <optional>

namespace wellspring::avatar {

namespace {

struct Symbols {
  const char32_t* symbols;
  Viseme viseme;
  float share;
  MouthKind kind;
};

// Place of articulation and rounding decide the shape; openness and rounding that of vowels.
// Capitals are the ASCII names (Kirshenbaum 1993) that some voices use where the alphabet's sign is
// not known.
constexpr Symbols table[] = {
    {U"pbmɓʙʘᵬ", Viseme::PP, 1, MouthKind::closure},
    {U"βɸB", Viseme::PP, 0.5f, MouthKind::consonant},
    {U"fvɱʋⱱ", Viseme::FF, 1, MouthKind::tight},
    {U"θðTD", Viseme::TH, 0.8f, MouthKind::consonant},
    {U"tdʈɖɾɽɗǀǃ", Viseme::DD, 0.5f, MouthKind::consonant},
    {U"kgɡcɟqɢxχɣʁçʝɰʀʄɠʛǂɧCJQX", Viseme::kk, 0.4f, MouthKind::consonant},
    {U"ʃʒɕʑʂʐʧʤʨʥSZ", Viseme::CH, 0.85f, MouthKind::consonant},
    {U"szʦʣ", Viseme::SS, 0.75f, MouthKind::consonant},
    {U"nlɲŋɳʎɭɫɬɮɴʟǁNL", Viseme::nn, 0.45f, MouthKind::consonant},
    {U"rɹɻɺR", Viseme::RR, 0.65f, MouthKind::consonant},
    {U"aɑæɶäãáàâåA", Viseme::aa, 1, MouthKind::vowel},
    {U"ʌɐV", Viseme::aa, 0.8f, MouthKind::vowel},
    {U"eɛɜɝɘëẽéèêεE", Viseme::E, 1, MouthKind::vowel},
    {U"əɚᵊɤ", Viseme::E, 0.7f, MouthKind::vowel},
    {U"iɪɨɯᵻïĩíìîI", Viseme::ih, 1, MouthKind::vowel},
    {U"jʲ", Viseme::ih, 0.7f, MouthKind::consonant},
    {U"oɔɒøœɵɞöõóòôO", Viseme::oh, 1, MouthKind::vowel},
    {U"uʊʉyʏüũúùûUY", Viseme::ou, 1, MouthKind::vowel},
    {U"wɥʍ", Viseme::ou, 0.9f, MouthKind::consonant},
};

bool contains(const char32_t* symbols, char32_t c) {
  for (; *symbols; symbols++)
    if (*symbols == c) return true;
  return false;
}

// Sounds of the throat, which no lip shows, and signs that change a sound but not the mouth:
// length, stress, tones, nasality, aspiration, ties.
bool is_silent_symbol(char32_t c) {
  if (c >= 0x300 && c <= 0x36f) return true;               // combining
  if (c >= 0x2b0 && c <= 0x2ff && c != U'ʲ') return true;  // raised letters, stress, length, tones
  if (c >= U'0' && c <= U'9') return true;                 // tone numbers
  if (c >= 0x1d2c && c <= 0x1d6a && c != U'ᵊ') return true;  // small raised letters
  if (c == 0x200d) return true;                              // joins a tie
  return contains(U"hɦʔʕħʜʢʡⁿ-[].'`|‖‿ꜛꜜ↑↓→^_:;,!?*~#()", c);
}

char32_t next_character(std::string_view text, size_t& at) {
  unsigned char first = static_cast<unsigned char>(text[at++]);
  int more = first >= 0xf0 ? 3 : first >= 0xe0 ? 2 : first >= 0xc0 ? 1 : 0;
  char32_t c = more == 0 ? first : first & (0x3fu >> more);
  for (; more > 0 && at < text.size(); more--)
    c = (c << 6) | (static_cast<unsigned char>(text[at++]) & 0x3fu);
  return c;
}

std::optional<MouthShape> shape_of(char32_t c) {
  for (const Symbols& row : table)
    if (contains(row.symbols, c)) return MouthShape{row.viseme, row.share, row.kind, 1};
  return std::nullopt;
}

// Shares of time: consonants before and after a vowel (affricates, syllabic l) and glides.
void divide_time(std::vector<MouthShape>& shapes) {
  if (shapes.size() == 2) {
    shapes[0].part = 0.6f;
    shapes[1].part = 0.4f;
  } else if (shapes.size() == 3) {
    shapes[0].part = 0.5f;
    shapes[1].part = shapes[2].part = 0.25f;
  } else {
    for (MouthShape& shape : shapes) shape.part = 1 / float(shapes.size());
  }
}

}  // namespace

bool is_pause(std::string_view mnemonic) { return !mnemonic.empty() && mnemonic[0] == '_'; }

std::vector<MouthShape> mouth_shapes(std::string_view ipa, std::string* unknown) {
  std::vector<MouthShape> shapes;
  for (size_t at = 0; at < ipa.size();) {
    size_t begin = at;
    char32_t c = next_character(ipa, at);
    auto shape = shape_of(c);
    if (!shape) {
      std::string_view symbol = ipa.substr(begin, at - begin);
      if (!is_silent_symbol(c) && unknown && unknown->find(symbol) == std::string::npos)
        *unknown += symbol;
      continue;
    }
    if (!shapes.empty()) {
      MouthShape& last = shapes.back();
      if (last.viseme == shape->viseme) continue;
      // The sign of softening colours a sound, it is none of its own.
      if (c == U'ʲ') continue;
      // Rounding starts with the closure of tʃ and dʒ: one shape.
      if (last.viseme == Viseme::DD && shape->viseme == Viseme::CH) {
        last = *shape;
        continue;
      }
    }
    shapes.push_back(*shape);
  }
  divide_time(shapes);
  return shapes;
}

}  // namespace wellspring::avatar
