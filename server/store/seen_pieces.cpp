// SPDX-License-Identifier: Apache-2.0
#include "store/seen_pieces.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <unordered_set>

namespace wellspring::store {

SeenPieces::SeenPieces() : places_(new Place[size]) {}

void SeenPieces::add(PieceKey key, uint32_t pixels) {
  uint64_t at = (key.bits * 0x9e3779b97f4a7c15u) >> 40;
  for (int probe = 0; probe < 16; probe++, at++) {
    Place& place = places_[at % size];
    uint64_t there = place.key.load(std::memory_order_relaxed);
    if (there == 0 && place.key.compare_exchange_strong(there, key.bits)) there = key.bits;
    if (there != key.bits) continue;
    place.pixels.fetch_add(pixels, std::memory_order_relaxed);
    any_.store(true, std::memory_order_relaxed);
    return;
  }
}

std::vector<SeenPiece> SeenPieces::take() {
  std::vector<SeenPiece> seen;
  if (!any_.exchange(false)) return seen;
  for (uint32_t i = 0; i < size; i++) {
    Place& place = places_[i];
    SeenPiece one;
    one.key.bits = place.key.exchange(0);
    one.pixels = place.pixels.exchange(0);
    if (one.key.bits) seen.push_back(one);
  }
  std::sort(seen.begin(), seen.end(), [](const SeenPiece& a, const SeenPiece& b) {
    return a.pixels != b.pixels ? a.pixels > b.pixels : a.key.bits < b.key.bits;
  });
  return seen;
}

namespace {

constexpr float fast_way = 0.5f;  // pieces a picture

// Returns where a piece's middle lies in columns and rows of another level.
dvec2 middle_on(const LevelSizes& sizes, PieceKey key, int level) {
  const LevelSize &from = sizes[size_t(key.level())], &to = sizes[size_t(level)];
  return {(key.column() + 0.5) * to.columns / from.columns,
          (key.row() + 0.5) * to.rows / from.rows};
}

// Adds up the wishes of one source.
class SourceWishes {
 public:
  SourceWishes(int source, const LevelSizes& sizes) : source_(source), sizes_(sizes) {
    for (auto& level : levels_) level.resize(sizes.size());
  }

  void see(std::span<const SeenPiece> seen) {
    double pixels = 0;
    finest_ = int(sizes_.size()) - 1;
    for (const SeenPiece& piece : seen) finest_ = std::min(finest_, piece.key.level());
    for (const SeenPiece& piece : seen) {
      // Coarser levels come before every piece, so that it becomes sharper by steps; but of the
      // long way to the coarsest, which is always there, three levels are enough.
      for (int step : {0, 1, 3})
        if (const int level = piece.key.level() + step; level < int(sizes_.size()) - 1)
          add(level, middle_on(sizes_, piece.key, level), Urgency::shown);
      middle_ += middle_on(sizes_, piece.key, finest_) * double(piece.pixels);
      pixels += piece.pixels;
    }
    middle_ /= std::max(pixels, 1.0);
  }

  PieceMotion follow(const PieceMotion* last) {
    PieceMotion motion{source_, middle_, vec2(0), finest_};
    if (last && last->finest < int(sizes_.size())) {
      const LevelSize &was = sizes_[size_t(last->finest)], &is = sizes_[size_t(finest_)];
      motion.way =
          vec2(middle_ - last->middle * dvec2(is.columns, is.rows) / dvec2(was.columns, was.rows));
    }
    way_ = motion.way;
    return motion;
  }

  // Adds the border in the direction of motion, then the ring around and the level below.
  void look_ahead() {
    constexpr float still = 0.02f;  // pieces a picture
    for (int level = finest_; level < int(sizes_.size()); level++) {
      const std::vector<PieceKey> shown = levels_[size_t(Urgency::shown)][size_t(level)];
      ivec2 low(1 << 30), high(-1);
      for (PieceKey key : shown) {
        const ivec2 place(int(key.column()), int(key.row()));
        low = glm::min(low, place), high = glm::max(high, place);
      }
      for (PieceKey key : shown)
        for (int dy = -1; dy <= 1; dy++)
          for (int dx = -1; dx <= 1; dx++) {
            const int x = int(key.column()) + dx, y = int(key.row()) + dy;
            const bool ahead = (way_.x > still && x > high.x) || (way_.x < -still && x < low.x) ||
                               (way_.y > still && y > high.y) || (way_.y < -still && y < low.y);
            add(level, dvec2(x + 0.5, y + 0.5), ahead ? Urgency::ahead : Urgency::wished);
          }
    }
    if (finest_ == 0) return;
    const LevelSize &here = sizes_[size_t(finest_)], &below = sizes_[size_t(finest_ - 1)];
    const dvec2 middle =
        middle_ * dvec2(below.columns, below.rows) / dvec2(here.columns, here.rows);
    for (int dy = -1; dy <= 1; dy++)
      for (int dx = -1; dx <= 1; dx++) add(finest_ - 1, middle + dvec2(dx, dy), Urgency::wished);
  }

  // Appends wishes in the order in which they are to be fetched.
  void append(std::vector<Wish>& wishes) {
    const bool fast = length(way_) > fast_way;
    for (int level = int(sizes_.size()) - 1; level >= 0; level--)
      for (auto& levels : levels_) order(level, levels[size_t(level)]);
    for (int urgency = 0; urgency < urgency_count; urgency++)
      for (int level = int(sizes_.size()) - 1; level >= 0; level--) {
        auto put = [&](Urgency from, Urgency as) {
          for (PieceKey key : levels_[size_t(from)][size_t(level)]) wishes.push_back({key, as});
        };
        const bool merged = fast && Urgency(urgency) == Urgency::ahead;
        if (!merged) put(Urgency(urgency), Urgency(urgency));
        if (fast && Urgency(urgency) == Urgency::shown) put(Urgency::ahead, Urgency::shown);
      }
  }

 private:
  void add(int level, dvec2 at, Urgency urgency) {
    const LevelSize& size = sizes_[size_t(level)];
    if (!(at.x >= 0 && at.y >= 0 && at.x < size.columns && at.y < size.rows)) return;
    PieceKey key(source_, level, uint32_t(at.x), uint32_t(at.y));
    if (known_.insert(key.bits).second) levels_[size_t(urgency)][size_t(level)].push_back(key);
  }

  // Sorts by squares around the middle, inside out; within one those in the direction of motion
  // come first.
  void order(int level, std::vector<PieceKey>& keys) const {
    const LevelSize &here = sizes_[size_t(finest_)], &to = sizes_[size_t(level)];
    const dvec2 middle = middle_ * dvec2(to.columns, to.rows) / dvec2(here.columns, here.rows);
    struct Place {
      int ring;
      double along, distance;
      PieceKey key;
    };
    std::vector<Place> places;
    for (PieceKey key : keys) {
      const dvec2 off = dvec2(key.column(), key.row()) + 0.5 - middle;
      const double farther = std::max(std::abs(off.x), std::abs(off.y));
      places.push_back({int(farther + 0.5), dot(off, dvec2(way_)), dot(off, off), key});
    }
    std::ranges::stable_sort(places, [](const Place& a, const Place& b) {
      return std::tuple(a.ring, -a.along, a.distance) < std::tuple(b.ring, -b.along, b.distance);
    });
    std::ranges::transform(places, keys.begin(), &Place::key);
  }

  const int source_;
  const LevelSizes& sizes_;
  int finest_ = 0;
  dvec2 middle_{0};
  vec2 way_{0};
  std::array<std::vector<std::vector<PieceKey>>, urgency_count> levels_;
  std::unordered_set<uint64_t> known_;
};

}  // namespace

std::vector<Wish> make_wishes(std::span<const SeenPiece> seen,
                              const std::function<const LevelSizes*(int)>& sizes_of,
                              std::vector<PieceMotion>& motions) {
  std::vector<SeenPiece> sorted(seen.begin(), seen.end());
  std::stable_sort(sorted.begin(), sorted.end(), [](const SeenPiece& a, const SeenPiece& b) {
    return a.key.source() < b.key.source();
  });
  std::vector<Wish> wishes;
  std::vector<PieceMotion> now;
  for (size_t begin = 0, end = 0; begin < sorted.size(); begin = end) {
    const int source = sorted[begin].key.source();
    while (end < sorted.size() && sorted[end].key.source() == source) end++;
    const LevelSizes* sizes = sizes_of(source);
    if (!sizes) continue;
    const PieceMotion* last = nullptr;
    for (const PieceMotion& motion : motions)
      if (motion.source == source) last = &motion;
    SourceWishes one(source, *sizes);
    one.see(std::span(sorted).subspan(begin, end - begin));
    now.push_back(one.follow(last));
    one.look_ahead();
    one.append(wishes);
  }
  motions = std::move(now);
  return wishes;
}

}  // namespace wellspring::store
