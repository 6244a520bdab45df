// SPDX-License-Identifier: Apache-2.0
// Pixels of a warped picture that nothing drawn shows: what something nearer hid there, and what
// lies outside. They get a smooth continuation of what is around, the calmer the farther away from
// it (push and pull: Gortler, Grzeszczuk, Szeliski, Cohen 1996, "The Lumigraph"). What was hidden
// goes on with what lies behind: of both ends of its epipolar line the farther one says how far
// that is, and nearer pixels have no part in it, as depth-aware inpainting of warped pictures has
// it (Fehn 2004), but in all directions at once, so that no row of pixels stands for itself.
#pragma once
#include <cstdint>
#include <vector>

#include "base/vec.h"
#include "frame/frame.h"

namespace wellspring {

// What a picture's pixels are, in blocks of eight by eight, row after row.
struct Unseen {
  static constexpr int block = 8;
  static constexpr float many = -1;  // in `flat`: the block's pixels have disparities of their own
  int width = 0, height = 0, columns = 0, rows = 0;
  // Bits of eight pixels side by side each, `columns` a row of the picture. No pixel is both.
  std::vector<uint8_t> hidden, outside;
  std::vector<float> flat;  // of blocks: all their pixels' disparity, or `many`
  std::vector<float>
      disparity;  // of pixels of blocks of many; of hidden ones that of what hid them
};
// What it says of pixels of that many is for the caller to write. Reuses its memory.
void resize_unseen(int width, int height, Unseen& unseen);

// Means of 2x2, 4x4 ... pixels. Kept to save the memory's making.
struct FillScratch {
  struct Cell {
    float red = 0, green = 0, blue = 0;
    float weight = 0;       // how much of it is known: 0 to 1
    float disparity = 0;    // of that
    float behind = 0;       // the farthest that its hidden pixels show; infinity: it has none
    bool complete = false;  // what is not known of it has been guessed; or nothing needs to be
  };
  struct BlockCells {
    Cell two[16], four[4];  // of 2x2 and of 4x4 pixels
  };
  struct Level {
    int columns = 0, rows = 0;
    std::vector<Cell> cells;
    std::vector<uint8_t> state;  // 0: not in use, else with 2: some of its pixels are unseen
    std::vector<int> used;       // cells
  };
  std::vector<Level> levels;   // of 8x8 pixels and more, up to one for all
  std::vector<int> slot;       // of blocks in use: where in `blocks` they are
  std::vector<int> unseen;     // blocks with unseen pixels: those around are in use, too
  std::vector<uint8_t> hides;  // of blocks: they or some of those around have hidden pixels
  std::vector<BlockCells> blocks;
};

// `parallax`: (p.x, p.y) - place * p.z is how far a unit of disparity moves what is seen at a
// place, in pixels. Pixels that are unseen are left as they are where no pixel is known. The same
// bits whatever the number of threads.
void fill_unseen(const Unseen& unseen, vec3 parallax, FillScratch& scratch, Image8& out);

size_t memory_bytes(const Unseen& unseen);
size_t memory_bytes(const FillScratch& scratch);

}  // namespace wellspring
