// SPDX-License-Identifier: Apache-2.0
#include "avatar/speech/make_visemes.h"

#include <algorithm>

namespace wellspring::avatar {
namespace {

constexpr double shortest_sound = 0.015;  // shorter ones are passed over
constexpr double shortest_pause = 0.08;   // shorter ones do not close the mouth
constexpr double shortest_glide = 0.04;   // between two held shapes
constexpr double relax = 0.16;            // from the end of the last sound to rest
constexpr double full_vowel = 0.09;       // shorter vowels do not reach their shape
constexpr float ahead = 0.65f;            // of what a consonant leaves goes to the coming vowel

// One shape held from `begin` to `end`.
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

// The nearest vowel on one side without a pause between, as far as four sounds away.
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

// The stretch of a part's time in which its shape stands.
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

// Makes room for a glide between two holds: the one that is no closure gives way.
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

  // The mouth prepares before the first sound where there is time, and rests after the last.
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
