// SPDX-License-Identifier: Apache-2.0
#include "frame/jpeg.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <turbojpeg.h>

#include "base/load_error.h"

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

namespace {

constexpr int largest_side = 16384;

struct CloseHandle {
  void operator()(void* handle) const { tjDestroy(handle); }
};
using Handle = std::unique_ptr<void, CloseHandle>;

}  // namespace

void encode_jpeg(const Image8& image, int quality, bool full_chroma, std::vector<uint8_t>& out,
                 size_t skip) {
  encode_jpeg(image, {0, 0, image.width, image.height}, quality, full_chroma, out, skip);
}

void encode_jpeg(const Image8& image, const ImagePart& part, int quality, bool full_chroma,
                 std::vector<uint8_t>& out, size_t skip) {
  if (part.width < 1 || part.height < 1 || part.width > largest_side ||
      part.height > largest_side || part.x < 0 || part.y < 0 || part.x + part.width > image.width ||
      part.y + part.height > image.height ||
      image.rgb.size() != size_t(image.width) * size_t(image.height) * 3)
    throw std::invalid_argument("encode_jpeg: no picture of a size JPEG can hold");
  thread_local Handle handle{tjInitCompress()};
  int chroma = full_chroma ? TJSAMP_444 : TJSAMP_420;
  unsigned long size = tjBufSize(part.width, part.height, chroma);
  // This is several times what most pictures need, but the system gives no memory until it is
  // written.
  auto room = std::make_unique_for_overwrite<unsigned char[]>(size);
  unsigned char* bytes = room.get();
  const uint8_t* first = &image.rgb[(size_t(part.y) * size_t(image.width) + size_t(part.x)) * 3];
  if (!handle ||
      tjCompress2(handle.get(), first, part.width, image.width * 3, part.height, TJPF_RGB, &bytes,
                  &size, chroma, std::clamp(quality, 1, 100), TJFLAG_NOREALLOC) != 0)
    throw std::runtime_error(std::string("encode_jpeg: ") + tjGetErrorStr2(handle.get()));
  out.resize(skip);
  out.reserve(skip + size);
  out.insert(out.end(), bytes, bytes + size);
}

void add_jpeg_comment(const std::string& comment, std::vector<uint8_t>& jpeg) {
  constexpr size_t most = 65533, begin = 2;  // begin: length of the file's beginning, SOI
  const size_t size = std::min(comment.size(), most) + 2;
  std::vector<uint8_t> segment = {0xff, 0xfe, uint8_t(size >> 8), uint8_t(size)};
  segment.insert(segment.end(), comment.begin(), comment.begin() + ptrdiff_t(size - 2));
  jpeg.insert(jpeg.begin() + begin, segment.begin(), segment.end());
}

Image8 decode_jpeg(std::span<const uint8_t> bytes, const char* file) {
  Handle handle(tjInitDecompress());
  if (!handle) throw LoadError(file, "", tjGetErrorStr2(nullptr));
  Image8 image;
  int chroma = 0, colorspace = 0;
  if (tjDecompressHeader3(handle.get(), bytes.data(), bytes.size(), &image.width, &image.height,
                          &chroma, &colorspace) != 0)
    throw LoadError(file, "JPEG header", tjGetErrorStr2(handle.get()));
  if (image.width < 1 || image.height < 1 || image.width > largest_side ||
      image.height > largest_side)
    throw LoadError(file, "JPEG header",
                    "picture of " + std::to_string(image.width) + "x" +
                        std::to_string(image.height) + " is larger than 16384 a side");
  image.rgb.resize(size_t(image.width) * size_t(image.height) * 3);
  if (tjDecompress2(handle.get(), bytes.data(), bytes.size(), image.rgb.data(), image.width, 0,
                    image.height, TJPF_RGB, TJFLAG_STOPONWARNING | TJFLAG_LIMITSCANS) != 0)
    throw LoadError(file, "JPEG data", tjGetErrorStr2(handle.get()));
  return image;
}

}  // namespace wellspring::frame
