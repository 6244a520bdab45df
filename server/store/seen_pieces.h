// SPDX-License-Identifier: Apache-2.0
// Collects which pieces a picture would have liked to show, from all threads that draw it, and
// makes of them what a visitor needs now and soon.
#pragma once
#include <array>
#include <atomic>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "base/vec.h"
#include "store/piece_store.h"

namespace wellspring::store {

// Holds a piece that was looked for, and by how many pixels.
struct SeenPiece {
  PieceKey key;
  uint32_t pixels = 0;
};

class SeenPieces {
 public:
  SeenPieces();
  // Any thread. Beyond 2048 pieces some are not collected.
  void add(PieceKey key, uint32_t pixels);
  // Returns what was collected, most pixels first, and forgets it. While nobody adds.
  std::vector<SeenPiece> take();

 private:
  struct Place {
    std::atomic<uint64_t> key{0};
    std::atomic<uint32_t> pixels{0};
  };
  static constexpr uint32_t size = 2048;
  std::unique_ptr<Place[]> places_;
  std::atomic<bool> any_{false};
};

// Holds the middle of what a visitor saw of a source, from one picture to the next.
struct PieceMotion {
  int source = 0;
  dvec2 middle{0};  // in columns and rows of `finest`
  vec2 way{0};      // pieces of the finest level that the middle moves from picture to picture
  int finest = 0;
};

// Holds how many columns and rows of pieces a level has.
struct LevelSize {
  int columns = 0, rows = 0;
};
using LevelSizes = std::vector<LevelSize>;  // a source's, from the finest

// Makes wishes of what a picture has seen of sources with levels `sizes_of(source)`: shown are the
// pieces themselves with some of coarser levels below them, coarse to fine, the middle first
// and, at the same distance, those in the direction of motion (section 4.2); ahead is the border in
// that direction, wished for the ring around and the next finer level in the middle (section 5.1).
// While the view is slow all that is shown comes before all that is ahead: detail is there soonest.
// In fast motion each level comes with what is ahead of it, so that it stays whole. `motions` are
// the last picture's, and become this one's.
std::vector<Wish> make_wishes(std::span<const SeenPiece> seen,
                              const std::function<const LevelSizes*(int)>& sizes_of,
                              std::vector<PieceMotion>& motions);

}  // namespace wellspring::store
