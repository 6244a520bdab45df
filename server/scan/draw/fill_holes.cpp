// SPDX-License-Identifier: Apache-2.0
#include "scan/draw/fill_holes.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "base/simd.h"

namespace wellspring::scan {
namespace {

constexpr int block_side = 32;        // pixels
constexpr int most_width = 32;        // pixels between the borders of a gap
constexpr float gap_spacings = 1.5f;  // width of a gap between discs, in spacings
constexpr float steepest_pair = 8;    // slope of a surface that a pair may lie on
constexpr float behind_spacings = 2;  // another surface is at least so far behind
constexpr int directions = 4, agreeing = 3;
constexpr int step_x[directions] = {1, 0, 1, 1}, step_y[directions] = {0, 1, 1, -1};
constexpr float endless = std::numeric_limits<float>::infinity();

// Returns the greatest distance of two pixels that bound a gap, for a spacing in pixels.
int gap_width(float spacing) {
  return std::clamp(int(gap_spacings * spacing + 1.5f), 2, most_width);
}

// Holds what the surfaces of a block need.
struct BlockNeed {
  float spacing = endless;  // metres: the least
  int width = 0;            // the widest gap, pixels
};

struct Hole {
  size_t pixel = 0, nearer = 0;
  float depth = 0;
  uint32_t color = 0;
};

float least_lane(const Lanes& a) {
  float least = a[0];
  for (int i = 1; i < lane_count; i++) least = std::min(least, a[i]);
  return least;
}

// Mixes four bytes; `share` of b, 0 to 1.
uint32_t mixed_color(uint32_t a, uint32_t b, float share) {
  uint32_t mix = 0;
  for (int shift = 0; shift < 32; shift += 8) {
    const float from = float(a >> shift & 255), to = float(b >> shift & 255);
    mix |= uint32_t(from + (to - from) * share + 0.5f) << shift;
  }
  return mix;
}

class HoleFinder {
 public:
  HoleFinder(const PointBuffer& buffer, std::span<const NodePoints> nodes, float focal)
      : buffer_(buffer), nodes_(nodes), focal_(focal) {}

  BlockNeed need_of(int left, int top) const {
    BlockNeed need;
    uint32_t last = PointBuffer::no_node;
    float nearest = endless;
    const auto add = [&] {
      if (last == PointBuffer::no_node) return;
      const float spacing = nodes_[last].spacing;
      need.spacing = std::min(need.spacing, spacing);
      need.width = std::max(need.width, gap_width(spacing * focal_ / nearest));
    };
    for (int y = top; y < std::min(top + block_side, buffer_.height); y++)
      for (int x = left; x < std::min(left + block_side, buffer_.width); x++) {
        const size_t pixel = at(x, y);
        const uint32_t node = buffer_.node[pixel];
        if (node != last) {
          add();
          last = node, nearest = endless;
        }
        nearest = std::min(nearest, buffer_.depth[pixel]);
      }
    add();
    return need;
  }

  // Appends the holes of a block; `need` is of the block and its neighbours.
  void find(std::vector<Hole>& holes, int left, int top, const BlockNeed& need) const {
    if (need.width == 0) return;
    const int margin = need.width - 1;
    constexpr int stride = block_side + 2 * most_width + lane_count;
    static thread_local std::vector<float> window(size_t(stride) * stride, endless);
    Lanes least = all_lanes(endless);  // the depths in the window
    const int first_x = std::max(left - margin, 0),
              last_x = std::min(left + block_side + margin, buffer_.width);
    for (int y = -margin; y < block_side + margin; y++) {
      float* row = &window[size_t(y + margin) * stride];
      std::fill(row, row + block_side + 2 * margin + lane_count, endless);
      if (top + y < 0 || top + y >= buffer_.height) continue;
      const float* from = &buffer_.depth[at(0, top + y)];
      std::copy(from + first_x, from + last_x, row + (first_x - left + margin));
      for (int x = 0; x < block_side + 2 * margin; x += lane_count)
        least = lanes_min(least, load_lanes(row + x));
    }
    least = all_lanes(least_lane(least));
    const int width = std::min(block_side, buffer_.width - left),
              height = std::min(block_side, buffer_.height - top);
    for (int y = 0; y < height; y++)
      for (int x = 0; x < width; x += lane_count) {
        const float* middle = &window[size_t(y + margin) * stride + size_t(x + margin)];
        const Lanes limit = load_lanes(middle) - need.spacing;
        if (!any_lane(limit > least)) continue;
        LaneMask agree{};
        for (int d = 0; d < directions; d++) {
          // Directions that are left must suffice.
          if (!any_lane(agree + (directions - d) >= agreeing)) break;
          const std::ptrdiff_t step = step_x[d] + step_y[d] * stride;
          Lanes before = all_lanes(endless), after = before;
          for (int t = 1; t <= margin; t++) {
            before = lanes_min(before, load_lanes(middle - t * step));
            after = lanes_min(after, load_lanes(middle + t * step));
          }
          agree -= lanes_max(before, after) < limit;
        }
        unsigned lanes = negative_lanes(agree >= agreeing);
        for (; lanes != 0; lanes &= lanes - 1) {
          const int lane = std::countr_zero(lanes);
          if (x + lane < width) judge(holes, left + x + lane, top + y, margin);
        }
      }
  }

 private:
  size_t at(int x, int y) const { return size_t(y) * size_t(buffer_.width) + size_t(x); }

  // Returns how many steps away the first pixel lies that is before `depth`, or 0.
  int find_nearer(int x, int y, int dx, int dy, float depth, int most) const {
    for (int t = 1; t <= most; t++) {
      x += dx, y += dy;
      if (x < 0 || y < 0 || x >= buffer_.width || y >= buffer_.height) return 0;
      const size_t pixel = at(x, y);
      if (buffer_.depth[pixel] >= depth) continue;
      const float behind = behind_spacings * nodes_[buffer_.node[pixel]].spacing;
      if (buffer_.depth[pixel] + behind < depth) return t;
    }
    return 0;
  }

  void judge(std::vector<Hole>& holes, int x, int y, int margin) const {
    const float depth = buffer_.depth[at(x, y)];
    int agree = 0, best = 0;
    Hole hole{.pixel = at(x, y)};
    for (int d = 0; d < directions; d++) {
      const int dx = step_x[d], dy = step_y[d];
      const int before = find_nearer(x, y, -dx, -dy, depth, margin);
      if (before == 0) continue;
      const int after = find_nearer(x, y, dx, dy, depth, margin);
      if (after == 0) continue;
      const size_t a = at(x - dx * before, y - dy * before), b = at(x + dx * after, y + dy * after);
      const float near_a = buffer_.depth[a], near_b = buffer_.depth[b];
      const float spacing =
          std::max(nodes_[buffer_.node[a]].spacing, nodes_[buffer_.node[b]].spacing);
      const int width = before + after;
      const float least = std::min(near_a, near_b);
      if (width > gap_width(spacing * focal_ / least)) continue;
      const float along = float(width) * steepest_pair * least / focal_;
      if (std::abs(near_a - near_b) > along + behind_spacings * spacing) continue;
      // A plane's reciprocal depth is linear in the picture.
      const float share = float(before) / float(width);
      const float between = 1 / ((1 - share) / near_a + share / near_b);
      if (between + behind_spacings * spacing >= depth) continue;
      agree++;
      if (best != 0 && width >= best) continue;
      best = width;
      hole.nearer = before <= after ? a : b;
      hole.depth = between;
      hole.color = mixed_color(buffer_.color[a], buffer_.color[b], share);
    }
    if (agree >= agreeing) holes.push_back(hole);
  }

  const PointBuffer& buffer_;
  std::span<const NodePoints> nodes_;
  float focal_;
};

}  // namespace

void fill_holes(PointBuffer& buffer, std::span<const NodePoints> nodes, const ScanCamera& view) {
  const int columns = (buffer.width + block_side - 1) / block_side;
  const int rows = (buffer.height + block_side - 1) / block_side;
  const HoleFinder finder(buffer, nodes, view.focal());
  std::vector<BlockNeed> needs(size_t(columns) * size_t(rows));
  parallel_for(rows, [&](int row) {
    for (int column = 0; column < columns; column++)
      needs[size_t(row * columns + column)] = finder.need_of(column * block_side, row * block_side);
  });
  std::vector<std::vector<Hole>> holes(static_cast<size_t>(rows));
  parallel_for(rows, [&](int row) {
    for (int column = 0; column < columns; column++) {
      BlockNeed need;
      for (int y = std::max(row - 1, 0); y <= std::min(row + 1, rows - 1); y++)
        for (int x = std::max(column - 1, 0); x <= std::min(column + 1, columns - 1); x++) {
          const BlockNeed& one = needs[size_t(y * columns + x)];
          need.spacing = std::min(need.spacing, one.spacing);
          need.width = std::max(need.width, one.width);
        }
      finder.find(holes[size_t(row)], column * block_side, row * block_side, need);
    }
  });
  for (const std::vector<Hole>& found : holes)
    for (const Hole& hole : found) {
      buffer.depth[hole.pixel] = hole.depth;
      buffer.color[hole.pixel] = hole.color;
      buffer.normal[hole.pixel] = buffer.normal[hole.nearer];
      buffer.classification[hole.pixel] = buffer.classification[hole.nearer];
      buffer.node[hole.pixel] = buffer.node[hole.nearer];
    }
}

}  // namespace wellspring::scan
