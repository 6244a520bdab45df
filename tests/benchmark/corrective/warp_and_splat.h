// SPDX-License-Identifier: Apache-2.0
// Shows remembered samples in a new view by corrective splatting (Haber, Myszkowski, Yamauchi,
// Seidel 2001, sections 4.1 and 4.3): each is warped to where the view sees it and splatted as a
// square over pixels of its own object. Finer levels cover coarser ones; within a level the nearest
// counts, and of samples equally near the newest.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "base/memory.h"
#include "object_samples.h"

namespace wellspring::test {

struct SplatStats {
  int samples = 0;  // warped samples
  int splats = 0;   // splats that fall into the picture
  int pixels = 0;   // pixels that show a sample
};

// A sample where the view sees it: pixels [x0, x1) x [y0, y1) of the picture.
struct Splat {
  uint16_t x0, y0, x1, y1;
  uint32_t key;  // the greater is shown: level, then nearness
  uint32_t object;
  SampleWords words;
};

// Memory that is kept from picture to picture.
struct SplatScratch {
  // Samples that one thread warps, then sorts by tile.
  struct Chunk {
    uint32_t first_list = 0, list_count = 0;  // pieces of lists
    uint32_t first_splat = 0, splat_count = 0;
    std::vector<uint32_t> entries, tile_begin;  // splats by tile
  };
  struct Piece {
    const LevelSamples* list = nullptr;
    uint32_t object = 0;
    int level = 1, begin = 0, count = 0;
  };
  std::vector<Piece> pieces;
  std::vector<Chunk> chunks;
  RawVector<Splat> splats;
};

// `object`: of each pixel, as Frame::object. Writes every pixel's level, 0 where no sample is
// shown, and its words where one is; others stay. All planes are view.width * view.height
// long, at most 65535 each way. A footprint is as wide as its level's when it was traced, less or
// more as its distance has changed, up to four times. Samples whose surface shows its other side
// now are left out. Many threads; the result does not depend on them.
SplatStats warp_and_splat(const SampleStore& store, const View& view,
                          std::span<const uint32_t> object, SplatScratch& scratch,
                          std::span<SampleWords> words, std::span<uint8_t> level);

}  // namespace wellspring::test
