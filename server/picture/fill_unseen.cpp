// SPDX-License-Identifier: Apache-2.0
#include "picture/fill_unseen.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "base/memory.h"
#include "base/priority.h"

namespace wellspring {
namespace {

using Cell = FillScratch::Cell;
using BlockCells = FillScratch::BlockCells;
constexpr int block = Unseen::block;
constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr int longest_walk = 256;  // pixels along an epipolar line to what is known
constexpr float known_at = 0.25f;  // share of a cell's pixels that are enough to know it
constexpr float may_be_nearer =
    0.75f;  // pixels that what is around a hole may move against what lies behind
constexpr float opens_at_least =
    0.5f;  // pixels that what hides moves against what is behind, for each of a hole
constexpr float guess_counts = 0.05f;  // beside a cell that is known

struct Filling {
  const Unseen& unseen;
  vec3 parallax;
  FillScratch& scratch;

  vec2 motion(float x, float y) const {
    return {parallax.x - x * parallax.z, parallax.y - y * parallax.z};
  }
  // By how much disparities around (x, y) may be nearer than what lies behind.
  float slack(float x, float y) const {
    return may_be_nearer / std::max(length(motion(x, y)), 1e-30f);
  }
  float pixels(int x, int y) const { return length(motion(float(x), float(y))); }
  float cell_slack(int x, int y, int size) const {
    return slack((float(x) + 0.5f) * float(size), (float(y) + 0.5f) * float(size));
  }
  float block_slack(int bx, int by) const { return cell_slack(bx, by, block); }
  unsigned bits(const std::vector<uint8_t>& of, int x, int y) const {
    return of[size_t(y) * size_t(unseen.columns) + size_t(x / block)];
  }
  float disparity(int x, int y) const {
    float flat = unseen.flat[size_t(y / block) * size_t(unseen.columns) + size_t(x / block)];
    return flat == Unseen::many ? unseen.disparity[size_t(y) * size_t(unseen.width) + size_t(x)]
                                : flat;
  }
};

// The most that the disparity of what lies behind the hidden pixel may be: that of the farther of
// both ends of its epipolar line, and so far behind what hid it that a hole of that width has
// opened. Without that, lead between panes would be taken for what is behind it. Infinity: neither
// end is in the picture.
float find_behind(const Filling& f, int x, int y, vec2 step, float pixels) {
  float behind = infinity;
  int width = 1, ends = 0;
  for (float side : {1.0f, -1.0f})
    for (int i = 1; i <= longest_walk; i++) {
      float sx = float(x) + 0.5f + side * float(i) * step.x,
            sy = float(y) + 0.5f + side * float(i) * step.y;
      if (!(sx >= 0 && sy >= 0 && sx < float(f.unseen.width) && sy < float(f.unseen.height))) break;
      int ix = int(sx), iy = int(sy);
      if (f.bits(f.unseen.outside, ix, iy) >> (ix % block) & 1) break;
      if (f.bits(f.unseen.hidden, ix, iy) >> (ix % block) & 1) continue;
      behind = std::min(behind, f.disparity(ix, iy));
      width += i - 1, ends++;
      break;
    }
  if (ends < 2) return behind;
  float opened = opens_at_least * float(width - 1) / std::max(pixels, 1e-30f);
  return std::min(behind, std::max(f.disparity(x, y) - opened, 0.0f));
}

// The mean of what is known of four cells, but for what is nearer than their hidden pixels may
// show, or, if they have none, much nearer than the farthest: `size` pixels a side, surfaces may
// slope.
Cell merge(const Cell& a, const Cell& b, const Cell& c, const Cell& d, float slack, int size) {
  Cell sum;
  sum.behind = std::min(std::min(a.behind, b.behind), std::min(c.behind, d.behind));
  float farthest = sum.behind;
  if (!(farthest < infinity)) {
    for (const Cell* one : {&a, &b, &c, &d})
      if (one->weight > 0) farthest = std::min(farthest, one->disparity);
  }
  slack *= std::max(float(size) / block, 1.0f);
  bool all = !(sum.behind < infinity) && size > block;
  for (const Cell* one : {&a, &b, &c, &d}) {
    if (!(one->weight > 0 && (all || one->disparity <= farthest + slack))) continue;
    sum.red += one->weight * one->red, sum.green += one->weight * one->green,
        sum.blue += one->weight * one->blue;
    sum.disparity += one->weight * one->disparity;
    sum.weight += one->weight;
  }
  if (!(sum.weight > 0)) return sum;
  float share = 1 / sum.weight;
  sum.red *= share, sum.green *= share, sum.blue *= share, sum.disparity *= share;
  sum.weight = std::min(sum.weight * (0.25f / known_at), 1.0f);
  sum.complete = true;
  return sum;
}

// Of a block without hidden ones among it and around: all its pixels count.
Cell read_plain(const Unseen& u, const Image8& out, int x0, int y0, unsigned (&seen)[block],
                float disparity, int cell) {
  int left = cell % 4 * 2, top = cell / 4 * 2, red = 0, green = 0, blue = 0, count = 0;
  for (int y = top; y < top + 2; y++)
    for (int x = left; x < left + 2; x++) {
      if (!(seen[y] >> x & 1)) continue;
      const uint8_t* rgb = &out.rgb[3 * (size_t(y0 + y) * size_t(u.width) + size_t(x0 + x))];
      red += rgb[0], green += rgb[1], blue += rgb[2], count++;
    }
  Cell sum;
  sum.behind = infinity;
  if (count == 0) return sum;
  float share = 1 / float(count);
  return {float(red) * share,
          float(green) * share,
          float(blue) * share,
          std::min(float(count) * (0.25f / known_at), 1.0f),
          disparity,
          infinity,
          true};
}

// Two by two of the block's pixels, some of which are hidden or nearer than what lies behind such
// ones.
Cell read_pixels(const Filling& f, const Image8& out, int x0, int y0, const unsigned (&seen)[block],
                 vec2 step, float slack, int cell) {
  const Unseen& u = f.unseen;
  int left = cell % 4 * 2, top = cell / 4 * 2;
  Cell pixel[4];
  float behind = infinity;
  for (int i = 0; i < 4; i++) {
    int in_x = left + i % 2, in_y = top + i / 2, x = x0 + in_x, y = y0 + in_y;
    pixel[i].behind = infinity;
    if (seen[in_y] >> in_x & 1) {
      const uint8_t* rgb = &out.rgb[3 * (size_t(y) * size_t(u.width) + size_t(x))];
      pixel[i] = {float(rgb[0]),     float(rgb[1]), float(rgb[2]), 1,
                  f.disparity(x, y), infinity,      true};
    } else if (x < u.width && y < u.height && (f.bits(u.hidden, x, y) >> in_x & 1) &&
               !(behind < infinity)) {
      behind = find_behind(f, x, y, step, f.pixels(x, y));
    }
  }
  pixel[0].behind = behind;
  return merge(pixel[0], pixel[1], pixel[2], pixel[3], slack, 2);
}

// The pixels of a block, two by two, and those cells four by four. Returns the block's.
Cell read_block(const Filling& f, const Image8& out, int bx, int by, BlockCells& cells) {
  const Unseen& u = f.unseen;
  int x0 = bx * block, y0 = by * block;
  unsigned seen[block], all = 0xffu >> std::max(x0 + block - u.width, 0);
  for (int y = 0; y < block; y++)
    seen[y] = y0 + y < u.height
                  ? all & ~(f.bits(u.hidden, x0, y0 + y) | f.bits(u.outside, x0, y0 + y))
                  : 0;
  size_t b = size_t(by) * size_t(u.columns) + size_t(bx);
  float slack = f.block_slack(bx, by), flat = u.flat[b];
  // Who knows how far what lies outside is.
  if (!f.scratch.hides[b]) slack = infinity, flat = std::max(flat, 0.0f);
  vec2 step = f.motion(float(x0) + 0.5f * block, float(y0) + 0.5f * block);
  float longest = std::max(std::abs(step.x), std::abs(step.y));
  step = longest > 0 && longest < infinity ? step / longest : vec2(1, 0);
  for (int cell = 0; cell < 16; cell++)
    cells.two[cell] = flat != Unseen::many ? read_plain(u, out, x0, y0, seen, flat, cell)
                                           : read_pixels(f, out, x0, y0, seen, step, slack, cell);
  for (int cell = 0; cell < 4; cell++) {
    const Cell* first = &cells.two[cell / 2 * 8 + cell % 2 * 2];
    cells.four[cell] = merge(first[0], first[1], first[4], first[5], slack, 4);
  }
  return merge(cells.four[0], cells.four[1], cells.four[2], cells.four[3], slack, 8);
}

// What the coarser cells around say at cell (x, y), bilinear: as far as they may lie behind it, and
// those that are known the more. `at(x, y)`: null where there is none.
template <class At>
Cell ask_coarser(const At& at, int x, int y, float behind, float slack) {
  int px = x >> 1, py = y >> 1, sx = x & 1 ? 1 : -1, sy = y & 1 ? 1 : -1;
  Cell sum;
  auto add = [&](const Cell* one, float weight, bool own) {
    if (!one || !one->complete || !(own || one->disparity <= behind + slack)) return;
    weight *= guess_counts + (1 - guess_counts) * one->weight;
    sum.red += weight * one->red, sum.green += weight * one->green, sum.blue += weight * one->blue;
    sum.disparity += weight * one->disparity;
    sum.weight += weight;
  };
  add(at(px, py), 9, true);
  add(at(px + sx, py), 3, false), add(at(px, py + sy), 3, false),
      add(at(px + sx, py + sy), 1, false);
  if (!(sum.weight > 0)) return sum;
  float share = 1 / sum.weight;
  sum.red *= share, sum.green *= share, sum.blue *= share, sum.disparity *= share;
  return sum;
}
template <class At>
void complete(const At& coarser, int x, int y, float slack, Cell& cell) {
  if (cell.weight >= 1) return;
  Cell above = ask_coarser(coarser, x, y, cell.behind, slack);
  if (!(above.weight > 0)) return;
  float own = cell.weight, other = 1 - own;
  cell.red = own * cell.red + other * above.red;
  cell.green = own * cell.green + other * above.green;
  cell.blue = own * cell.blue + other * above.blue;
  cell.disparity = own * cell.disparity + other * above.disparity;
  cell.complete = true;
}

bool has_hidden(const Unseen& u, int b) {
  size_t columns = size_t(u.columns), x = size_t(b) % columns, y = size_t(b) / columns * block;
  unsigned bits = 0;
  for (size_t row = y; row < std::min(y + block, size_t(u.height)); row++)
    bits |= u.hidden[row * columns + x];
  return bits != 0;
}

// Says which blocks have unseen pixels and which lie beside them. False: none has any.
bool find_blocks(const Unseen& u, FillScratch& s) {
  FillScratch::Level& level = s.levels[0];
  s.hides.assign(level.state.size(), 0);
  for (int y = 0; y < u.height; y++) {
    const uint8_t* hidden = &u.hidden[size_t(y) * size_t(u.columns)];
    const uint8_t* outside = &u.outside[size_t(y) * size_t(u.columns)];
    uint8_t* unseen = &s.hides[size_t(y / block) * size_t(u.columns)];
    for (int x = 0; x < u.columns; x++) unseen[x] |= hidden[x] | outside[x];
  }
  s.unseen.clear();
  for (int b = 0; b < int(s.hides.size()); b++)
    if (std::exchange(s.hides[size_t(b)], 0)) s.unseen.push_back(b);
  for (int b : s.unseen) {
    int bx = b % u.columns, by = b / u.columns;
    bool hides = has_hidden(u, b);
    for (int y = std::max(by - 1, 0); y <= std::min(by + 1, u.rows - 1); y++)
      for (int x = std::max(bx - 1, 0); x <= std::min(bx + 1, u.columns - 1); x++) {
        size_t i = size_t(y) * size_t(u.columns) + size_t(x);
        s.hides[i] |= uint8_t(hides);
        if (level.state[i]) continue;
        level.state[i] = 1;
        s.slot[i] = int(level.used.size());
        level.used.push_back(int(i));
      }
    level.state[size_t(b)] = 2;
  }
  if (s.blocks.size() < level.used.size()) s.blocks.resize(level.used.size());
  return !s.unseen.empty();
}

void prepare_levels(const Unseen& u, FillScratch& s) {
  size_t count = 1;
  for (int side = std::max(u.columns, u.rows); side > 1; side = (side + 1) / 2) count++;
  s.levels.resize(count);
  int columns = u.columns, rows = u.rows;
  for (FillScratch::Level& level : s.levels) {
    level.columns = columns, level.rows = rows;
    level.cells.resize(size_t(columns) * size_t(rows));
    level.state.assign(level.cells.size(), 0);
    level.used.clear();
    columns = (columns + 1) / 2, rows = (rows + 1) / 2;
  }
  s.slot.resize(s.levels[0].cells.size());
}

auto cell_of(const FillScratch::Level& level) {
  return [&level](int x, int y) -> const Cell* {
    if (x < 0 || y < 0 || x >= level.columns || y >= level.rows) return nullptr;
    size_t i = size_t(y) * size_t(level.columns) + size_t(x);
    return level.state[i] ? &level.cells[i] : nullptr;
  };
}
// Of the blocks' own cells, `Side` a side.
template <int Side>
auto cell_of(const Filling& f) {
  return [&f](int x, int y) -> const Cell* {
    int bx = x / Side, by = y / Side;
    if (x < 0 || y < 0 || bx >= f.unseen.columns || by >= f.unseen.rows) return nullptr;
    size_t i = size_t(by) * size_t(f.unseen.columns) + size_t(bx);
    if (!f.scratch.levels[0].state[i]) return nullptr;
    const BlockCells& cells = f.scratch.blocks[size_t(f.scratch.slot[i])];
    return (Side == 4 ? cells.two : cells.four) + y % Side * Side + x % Side;
  };
}

void gather_levels(const Filling& f) {
  std::vector<FillScratch::Level>& levels = f.scratch.levels;
  Cell nothing;
  nothing.behind = infinity;
  for (size_t k = 1; k < levels.size(); k++) {
    FillScratch::Level& level = levels[k];
    const FillScratch::Level& below = levels[k - 1];
    for (int b : below.used) {
      size_t i =
          size_t(b / below.columns / 2) * size_t(level.columns) + size_t(b % below.columns / 2);
      if (!level.state[i]) level.used.push_back(int(i));
      level.state[i] |= below.state[size_t(b)];
    }
    auto at = cell_of(below);
    auto cell = [&](int x, int y) -> const Cell& {
      const Cell* found = at(x, y);
      return found ? *found : nothing;
    };
    int size = block << k;
    for (int i : level.used) {
      int x = i % level.columns, y = i / level.columns;
      level.cells[size_t(i)] =
          merge(cell(2 * x, 2 * y), cell(2 * x + 1, 2 * y), cell(2 * x, 2 * y + 1),
                cell(2 * x + 1, 2 * y + 1), f.cell_slack(x, y, size), size);
    }
  }
}

void complete_levels(const Filling& f) {
  std::vector<FillScratch::Level>& levels = f.scratch.levels;
  for (size_t k = levels.size() - 1; k-- > 0;) {
    FillScratch::Level& level = levels[k];
    auto coarser = cell_of(levels[k + 1]);
    for (int i : level.used) {
      int x = i % level.columns, y = i / level.columns;
      if (level.state[size_t(i)] & 2)
        complete(coarser, x, y, f.cell_slack(x, y, block << k), level.cells[size_t(i)]);
    }
  }
}

void write_pixels(const Filling& f, int bx, int by, Image8& out) {
  const Unseen& u = f.unseen;
  auto coarser = cell_of<4>(f);
  float slack = f.block_slack(bx, by);
  for (int y = by * block; y < std::min((by + 1) * block, u.height); y++)
    for (unsigned bits = f.bits(u.hidden, bx * block, y) | f.bits(u.outside, bx * block, y);
         bits != 0; bits &= bits - 1) {
      int x = bx * block + std::countr_zero(bits);
      Cell cell = ask_coarser(coarser, x, y, coarser(x / 2, y / 2)->behind, slack);
      if (!(cell.weight > 0)) continue;
      uint8_t* rgb = &out.rgb[3 * (size_t(y) * size_t(u.width) + size_t(x))];
      rgb[0] = uint8_t(cell.red + 0.5f), rgb[1] = uint8_t(cell.green + 0.5f),
      rgb[2] = uint8_t(cell.blue + 0.5f);
    }
}

}  // namespace

void resize_unseen(int width, int height, Unseen& unseen) {
  unseen.width = width, unseen.height = height;
  unseen.columns = (width + block - 1) / block, unseen.rows = (height + block - 1) / block;
  size_t words = size_t(unseen.columns) * size_t(height);
  unseen.hidden.resize(words), unseen.outside.resize(words);
  unseen.flat.resize(size_t(unseen.columns) * size_t(unseen.rows));
  unseen.disparity.resize(size_t(width) * size_t(height));
}

void fill_unseen(const Unseen& unseen, vec3 parallax, FillScratch& scratch, Image8& out) {
  const Unseen& u = unseen;
  Filling f{unseen, parallax, scratch};
  prepare_levels(u, scratch);
  if (!find_blocks(u, scratch)) return;
  auto each = [](const std::vector<int>& blocks, const auto& body) {
    priority_ranges(int(blocks.size()), 32, [&](int begin, int end) {
      for (int i = begin; i < end; i++) body(blocks[size_t(i)]);
    });
  };
  auto cells = [&](int b) -> BlockCells& {
    return scratch.blocks[size_t(scratch.slot[size_t(b)])];
  };
  each(scratch.levels[0].used, [&](int b) {
    scratch.levels[0].cells[size_t(b)] = read_block(f, out, b % u.columns, b / u.columns, cells(b));
  });
  gather_levels(f);
  complete_levels(f);
  each(scratch.unseen, [&](int b) {
    int bx = b % u.columns, by = b / u.columns;
    auto coarser = cell_of(scratch.levels[0]);
    for (int c = 0; c < 4; c++)
      complete(coarser, bx * 2 + c % 2, by * 2 + c / 2, f.block_slack(bx, by), cells(b).four[c]);
  });
  each(scratch.unseen, [&](int b) {
    int bx = b % u.columns, by = b / u.columns;
    auto coarser = cell_of<2>(f);
    for (int c = 0; c < 16; c++)
      complete(coarser, bx * 4 + c % 4, by * 4 + c / 4, f.block_slack(bx, by), cells(b).two[c]);
  });
  each(scratch.unseen, [&](int b) { write_pixels(f, b % u.columns, b / u.columns, out); });
}

size_t memory_bytes(const Unseen& unseen) {
  return bytes_of(unseen.hidden, unseen.outside, unseen.flat, unseen.disparity);
}

size_t memory_bytes(const FillScratch& scratch) {
  size_t sum = bytes_of(scratch.slot, scratch.unseen, scratch.hides, scratch.blocks);
  for (const FillScratch::Level& level : scratch.levels)
    sum += bytes_of(level.cells, level.state, level.used);
  return sum;
}

}  // namespace wellspring
