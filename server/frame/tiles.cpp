// SPDX-License-Identifier: Apache-2.0
#include "frame/tiles.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>

namespace wellspring::frame {
namespace {

// Tiles that cost about as many bytes as the tables of one more rectangle.
constexpr int cheap_tiles = 4;

constexpr size_t most_boxes = 64;  // boxes that are worth a search

struct TileBox {
  int left, top, right, bottom;  // tiles; right and bottom are outside
  int area() const { return (right - left) * (bottom - top); }
  bool meets(const TileBox& b) const {
    return left < b.right && b.left < right && top < b.bottom && b.top < bottom;
  }
};

TileBox around(const TileBox& a, const TileBox& b) {
  return {std::min(a.left, b.left), std::min(a.top, b.top), std::max(a.right, b.right),
          std::max(a.bottom, b.bottom)};
}

// Finds runs of wanted tiles, each joined to one of the same columns above it.
std::vector<TileBox> find_runs(const TileGrid& grid, const std::vector<char>& wanted) {
  std::vector<TileBox> boxes;
  const int columns = grid.columns();
  for (int y = 0; y < grid.rows(); y++)
    for (int x = 0; x < columns; x++) {
      const int begin = x;
      while (x < columns && wanted[size_t(y * columns + x)]) x++;
      if (x == begin) continue;
      const auto above = std::ranges::find_if(boxes, [&](const TileBox& box) {
        return box.left == begin && box.right == x && box.bottom == y;
      });
      if (above != boxes.end()) above->bottom++;
      else boxes.push_back({begin, y, x, y + 1});
    }
  return boxes;
}

// Joins two boxes, and whatever then lies under both.
void join(std::vector<TileBox>& boxes, size_t first, size_t second) {
  TileBox box = around(boxes[first], boxes[second]);
  boxes.erase(boxes.begin() + ptrdiff_t(std::max(first, second)));
  boxes.erase(boxes.begin() + ptrdiff_t(std::min(first, second)));
  for (size_t i = 0; i < boxes.size();)
    if (boxes[i].meets(box)) {
      box = around(box, boxes[i]);
      boxes.erase(boxes.begin() + ptrdiff_t(i));
      i = 0;
    } else {
      i++;
    }
  boxes.push_back(box);
}

std::vector<ImagePart> parts_of(const TileGrid& grid, const std::vector<TileBox>& boxes) {
  std::vector<ImagePart> parts;
  for (const TileBox& box : boxes) {
    const int x = box.left * tile_side, y = box.top * tile_side;
    parts.push_back({x, y, std::min(box.right * tile_side, grid.width) - x,
                     std::min(box.bottom * tile_side, grid.height) - y});
  }
  return parts;
}

}  // namespace

ImagePart TileGrid::part(size_t tile) const {
  const int x = int(tile) % columns() * tile_side, y = int(tile) / columns() * tile_side;
  return {x, y, std::min(tile_side, width - x), std::min(tile_side, height - y)};
}

bool differs(const Image8& a, const Image8& b, const ImagePart& part, int tolerance) {
  for (int y = part.y; y < part.y + part.height; y++) {
    const size_t at = (size_t(y) * size_t(a.width) + size_t(part.x)) * 3;
    const size_t count = size_t(part.width) * 3;
    if (std::memcmp(&a.rgb[at], &b.rgb[at], count) == 0) continue;
    if (tolerance == 0) return true;
    int most = 0;
    for (size_t i = at; i < at + count; i++)
      most = std::max(most, std::abs(int(a.rgb[i]) - int(b.rgb[i])));
    if (most > tolerance) return true;
  }
  return false;
}

std::vector<ImagePart> cover(const TileGrid& grid, const std::vector<char>& wanted) {
  return parts_of(grid, find_runs(grid, wanted));
}

std::vector<ImagePart> cover(const TileGrid& grid, const std::vector<char>& wanted, size_t most) {
  std::vector<TileBox> boxes = find_runs(grid, wanted);
  // Boxes are so scattered that nearly all has changed.
  while (boxes.size() > most_boxes) join(boxes, 0, boxes.size() - 1);
  while (boxes.size() > 1) {
    int least = std::numeric_limits<int>::max();
    size_t first = 0, second = 1;
    for (size_t i = 0; i < boxes.size(); i++)
      for (size_t j = i + 1; j < boxes.size(); j++) {
        const int more = around(boxes[i], boxes[j]).area() - boxes[i].area() - boxes[j].area();
        if (more < least) least = more, first = i, second = j;
      }
    if (least > cheap_tiles && boxes.size() <= most) break;
    join(boxes, first, second);
  }
  return parts_of(grid, boxes);
}

std::vector<size_t> tiles_in(const TileGrid& grid, const ImagePart& part) {
  std::vector<size_t> tiles;
  for (int y = part.y / tile_side; y * tile_side < part.y + part.height; y++)
    for (int x = part.x / tile_side; x * tile_side < part.x + part.width; x++)
      tiles.push_back(size_t(y * grid.columns() + x));
  return tiles;
}

void copy_part(const Image8& from, const ImagePart& part, Image8& to) {
  for (int y = part.y; y < part.y + part.height; y++) {
    const size_t at = (size_t(y) * size_t(from.width) + size_t(part.x)) * 3;
    std::memcpy(&to.rgb[at], &from.rgb[at], size_t(part.width) * 3);
  }
}

namespace {

// Holds the first source pixel of one target pixel, and the weights of it and of those that follow,
// 256 in all.
struct Span {
  int first = 0;
  std::vector<uint32_t> weights;
};

std::vector<Span> make_spans(int from, int to) {
  std::vector<Span> spans(static_cast<size_t>(to));
  const double scale = double(from) / to;
  for (int i = 0; i < to; i++) {
    const double low = i * scale, high = std::min((i + 1) * scale, double(from));
    Span& span = spans[size_t(i)];
    span.first = int(low);
    uint32_t sum = 0;
    for (int x = span.first; x < high && x < from; x++) {
      const double share = (std::min(x + 1.0, high) - std::max(double(x), low)) / (high - low);
      span.weights.push_back(uint32_t(256 * share + 0.5));
      sum += span.weights.back();
    }
    span.weights[span.weights.size() / 2] += 256 - sum;
  }
  return spans;
}

}  // namespace

Image8 shrink(const Image8& image, int width, int height) {
  const std::vector<Span> columns = make_spans(image.width, width),
                          rows = make_spans(image.height, height);
  Image8 small{width, height, {}};
  small.rgb.resize(size_t(width) * size_t(height) * 3);
  std::vector<uint32_t> line(size_t(image.width) * 3);
  uint8_t* out = small.rgb.data();
  for (const Span& row : rows) {
    std::ranges::fill(line, 0);
    for (size_t i = 0; i < row.weights.size(); i++) {
      const uint8_t* in = &image.rgb[(size_t(row.first) + i) * line.size()];
      for (size_t x = 0; x < line.size(); x++) line[x] += row.weights[i] * in[x];
    }
    for (const Span& column : columns)
      for (size_t channel = 0; channel < 3; channel++) {
        uint32_t sum = 0;
        for (size_t i = 0; i < column.weights.size(); i++)
          sum += column.weights[i] * line[(size_t(column.first) + i) * 3 + channel];
        *out++ = uint8_t((sum + (1 << 15)) >> 16);
      }
  }
  return small;
}

}  // namespace wellspring::frame
