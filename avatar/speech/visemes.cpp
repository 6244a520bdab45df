// SPDX-License-Identifier: Apache-2.0
#include "avatar/speech/visemes.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace wellspring::avatar {

const std::array<const char*, viseme_count> viseme_names = {
    "sil", "PP", "FF", "TH", "DD", "kk", "CH", "SS", "nn", "RR", "aa", "E", "ih", "oh", "ou"};

VisemeWeights eval_visemes(const VisemeTrack& track, double time) {
  const auto& keys = track.keys;
  if (keys.empty() || std::isnan(time)) {
    VisemeWeights rest{};
    rest[size_t(Viseme::sil)] = 1;
    return rest;
  }
  auto after = std::upper_bound(keys.begin(), keys.end(), time,
                                [](double t, const VisemeKey& key) { return t < key.time; });
  if (after == keys.begin()) return keys.front().weights;
  if (after == keys.end()) return keys.back().weights;
  const VisemeKey &a = *(after - 1), &b = *after;
  float x = float((time - a.time) / (b.time - a.time));
  x = std::clamp(x * x * (3 - 2 * x), 0.0f, 1.0f);
  VisemeWeights weights;
  for (size_t i = 0; i < viseme_count; i++)
    weights[i] = std::clamp(a.weights[i] + (b.weights[i] - a.weights[i]) * x, 0.0f, 1.0f);
  return weights;
}

namespace {

struct Symbols {
  const char32_t* symbols;
  Viseme viseme;
  float share;
  MouthKind kind;
};

// Place of articulation and rounding decide the shape of consonants, openness and rounding that of
// vowels. Capitals are the ASCII names (Kirshenbaum 1993) that some voices use if they lack the
// alphabet's sign.
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

// Knows sounds of the throat, which no lip shows, and signs that change a sound but not the mouth:
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

// Divides a sound's time: consonants before and after a vowel (affricates, syllabic l) and glides.
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
      // The sign of softening colours a sound and is none of its own.
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

namespace {

constexpr double shortest_sound = 0.015;  // seconds; shorter ones are passed over
constexpr double shortest_pause = 0.08;   // seconds; shorter ones do not close the mouth
constexpr double shortest_glide = 0.04;   // seconds between two held shapes
constexpr double relax = 0.16;            // seconds from the end of the last sound to rest
constexpr double full_vowel = 0.09;       // seconds; shorter vowels do not reach their shape
constexpr float ahead = 0.65f;            // the coming vowel's share of what a consonant leaves

// This is one shape, held from `begin` to `end`.
struct Hold {
  double begin = 0, end = 0;
  VisemeWeights weights{};
  bool closed = false;  // must not be cut short
};

struct Part {
  MouthShape shape;
  double begin = 0, end = 0;
  bool pause = false;
};

constexpr size_t index(Viseme viseme) { return size_t(viseme); }

std::vector<Part> split(const std::vector<MouthSound>& sounds) {
  std::vector<Part> parts;
  for (const MouthSound& sound : sounds) {
    double length = sound.end - sound.begin;
    if (sound.pause) {
      if (length >= shortest_pause) parts.push_back({MouthShape{}, sound.begin, sound.end, true});
      continue;
    }
    double at = sound.begin;
    for (const MouthShape& shape : sound.shapes) {
      double end = std::min(at + length * double(shape.part), sound.end);
      if (length >= shortest_sound || shape.kind == MouthKind::closure)
        parts.push_back({shape, at, end, false});
      at = end;
    }
  }
  return parts;
}

// Finds the nearest vowel on one side without a pause between, as far as four sounds away.
const Part* vowel_near(const std::vector<Part>& parts, size_t from, int step) {
  for (int n = 1; n <= 4; n++) {
    ptrdiff_t i = ptrdiff_t(from) + n * step;
    if (i < 0 || i >= ptrdiff_t(parts.size()) || parts[size_t(i)].pause) return nullptr;
    if (parts[size_t(i)].shape.kind == MouthKind::vowel) return &parts[size_t(i)];
  }
  return nullptr;
}

VisemeWeights mix(const std::vector<Part>& parts, size_t i) {
  const Part& part = parts[i];
  VisemeWeights weights{};
  float share = part.shape.share;
  if (part.shape.kind == MouthKind::vowel)
    share *= std::clamp(float((part.end - part.begin) / full_vowel), 0.6f, 1.0f);
  const Part* before = share < 1 ? vowel_near(parts, i, -1) : nullptr;
  const Part* after = share < 1 ? vowel_near(parts, i, 1) : nullptr;
  if (!before && !after && part.shape.kind != MouthKind::vowel && part.shape.share >= 0.75f)
    share = 1;
  weights[index(part.shape.viseme)] += share;
  float left = 1 - share;
  if (before && after) {
    weights[index(before->shape.viseme)] += left * (1 - ahead);
    weights[index(after->shape.viseme)] += left * ahead;
  } else if (before || after) {
    weights[index((before ? before : after)->shape.viseme)] += left;
  } else {
    weights[index(Viseme::sil)] += left;
  }
  return weights;
}

// Sets the stretch of a part's time in which its shape stands.
void place(const Part& part, Hold& hold) {
  double length = part.end - part.begin;
  auto at = [&](double from, double to) {
    hold.begin = part.begin + from * length;
    hold.end = part.begin + to * length;
  };
  if (part.pause) {
    double ease = std::min(relax, 0.4 * length);
    hold.begin = part.begin + ease;
    hold.end = part.end - std::min(0.1, 0.4 * length);
    return;
  }
  switch (part.shape.kind) {
    case MouthKind::closure:
      at(0, 0.7);
      hold.closed = true;
      break;
    case MouthKind::tight: at(0.1, 0.75); break;
    case MouthKind::consonant: at(0.3, 0.6); break;
    case MouthKind::vowel: at(0.35, 0.65); break;
  }
}

void add_key(VisemeTrack& track, double time, const VisemeWeights& weights) {
  if (!track.keys.empty()) time = std::max(time, track.keys.back().time + 1e-3);
  track.keys.push_back({time, weights});
}

// Makes room for a glide between two holds: one that is no closure gives way.
void part_holds(Hold& earlier, Hold& later) {
  double lack = shortest_glide - (later.begin - earlier.end);
  if (lack <= 0) return;
  if (!earlier.closed) {
    double give = std::min(lack, std::max(earlier.end - earlier.begin, 0.0));
    earlier.end -= give;
    lack -= give;
  }
  if (lack > 0 && !later.closed) {
    double middle = 0.5 * (later.begin + later.end);
    later.begin = std::min(later.begin + lack, std::max(middle, later.begin));
    later.end = std::max(later.end, later.begin);
  }
}

}  // namespace

VisemeTrack make_visemes(const std::vector<MouthSound>& sounds) {
  std::vector<Part> parts = split(sounds);
  VisemeTrack track;
  if (parts.empty()) return track;
  VisemeWeights rest{};
  rest[index(Viseme::sil)] = 1;

  std::vector<Hold> holds;
  for (size_t i = 0; i < parts.size(); i++) {
    Hold hold;
    hold.weights = parts[i].pause ? rest : mix(parts, i);
    place(parts[i], hold);
    holds.push_back(hold);
  }
  for (size_t i = 0; i + 1 < holds.size(); i++) part_holds(holds[i], holds[i + 1]);

  // The mouth prepares before the first sound if there is time, and rests after the last.
  if (!parts.front().pause) add_key(track, std::max(0.0, holds.front().begin - 0.1), rest);
  for (const Hold& hold : holds) {
    add_key(track, hold.begin, hold.weights);
    if (hold.end > hold.begin + 1e-3) add_key(track, hold.end, hold.weights);
  }
  if (!parts.back().pause)
    add_key(track, std::max(parts.back().end, holds.back().end) + relax, rest);
  return track;
}

}  // namespace wellspring::avatar
