// SPDX-License-Identifier: Apache-2.0
#include "show/draw/parts.h"

#include <cstdlib>

#include "frame/tiles.h"
#include "image/image.h"
#include "show/visit/flow.h"

namespace wellspring::show {
namespace {

// Differences, out of 255, below these are not seen, and are sent with the fine tiles. Noise that
// goes is a little everywhere.
constexpr int seen_of_one = 16;    // difference of any byte
constexpr double seen_of_all = 1;  // mean difference of a tile
constexpr size_t most_changed = max_parts / 2;

// Keeps as many of the wanted tiles, from `next` on, as are expected to fit into that many bytes;
// one at least. The other tiles are found again the next time. Returns the expected bytes.
double bound(const TileGrid& grid, double bytes, double bytes_per_pixel, size_t& next,
             std::vector<char>& wanted) {
  double expected = 0;
  const size_t begin = next % grid.size();
  bool full = false;
  for (size_t i = 0; i < grid.size(); i++) {
    const size_t tile = (begin + i) % grid.size();
    if (!wanted[tile]) continue;
    const ImagePart part = grid.part(tile);
    const double more = part.width * part.height * bytes_per_pixel;
    if (!full && expected > 0 && expected + more > bytes) full = true, next = tile;
    if (full) wanted[tile] = 0;
    else expected += more;
  }
  return expected;
}

bool is_seen(const Image8& a, const Image8& b, const ImagePart& part) {
  if (differs(a, b, part, seen_of_one)) return true;
  int sum = 0;
  for (int y = part.y; y < part.y + part.height; y++) {
    const size_t at = (size_t(y) * size_t(a.width) + size_t(part.x)) * 3;
    for (size_t i = at; i < at + size_t(part.width) * 3; i++)
      sum += std::abs(int(a.rgb[i]) - int(b.rgb[i]));
  }
  return sum > seen_of_all * part.width * part.height * 3;
}

double cost(const PartsOrder& order, int quality, bool full_chroma) {
  Flow flow;
  flow.bytes_per_pixel = float(order.bytes_per_pixel);
  return expected_bytes(flow, 1, quality, full_chroma);
}

}  // namespace

void make_parts(const Image8& newest, const PartsOrder& order, PacketHeader header,
                BrowserPicture& has, Packet& packet) {
  const TileGrid grid{newest.width, newest.height};
  std::vector<char> changed(grid.size()), fine(grid.size());
  has.pending = false;
  for (size_t tile = 0; tile < grid.size(); tile++) {
    const ImagePart part = grid.part(tile);
    const bool other = differs(newest, has.image, part, 0);
    changed[tile] = other && is_seen(newest, has.image, part);
    if (changed[tile]) has.changed_at[tile] = order.now;
    const bool finer = order.fine_quality > 0 && (other || has.quality[tile] < order.fine_quality);
    fine[tile] = finer && order.now - has.changed_at[tile] >= order.quiet;
    has.pending |= changed[tile] || finer;
  }
  std::vector<PicturePart> parts;
  std::vector<uint8_t> jpegs;
  auto encode = [&](const ImagePart& part, int quality, bool full_chroma) {
    const size_t before = jpegs.size();
    encode_jpeg(newest, part, quality, full_chroma, jpegs, before);
    parts.push_back({uint16_t(part.x), uint16_t(part.y), uint16_t(part.width),
                     uint16_t(part.height), uint32_t(jpegs.size() - before)});
    copy_part(newest, part, has.image);
    for (size_t tile : tiles_in(grid, part)) has.quality[tile] = uint8_t(quality);
  };
  const double used =
      bound(grid, order.bytes, cost(order, order.quality, order.full_chroma), has.next, changed);
  for (const ImagePart& part : cover(grid, changed, most_changed)) {
    encode(part, order.quality, order.full_chroma);
    // A tile between moving things is not made fine with each of their pictures.
    for (size_t tile : tiles_in(grid, part)) fine[tile] = 0, has.changed_at[tile] = order.now;
  }
  const bool only_fine = parts.empty();
  if (order.fine_quality > 0 && used < 0.5 * order.bytes) {
    bound(grid, order.bytes - used, cost(order, order.fine_quality, true), has.next_fine, fine);
    for (const ImagePart& part : cover(grid, fine)) {
      if (parts.size() == max_parts) break;
      encode(part, order.fine_quality, true);
    }
  }
  packet.clear();
  if (parts.empty() && !order.must) return;
  header.flags &= uint8_t(~packet_complete);
  header.quality = uint8_t(only_fine && !parts.empty() ? order.fine_quality : order.quality);
  packet.resize(parts_header_bytes(parts.size()));
  write_packet_header(header, parts, packet);
  packet.insert(packet.end(), jpegs.begin(), jpegs.end());
}

void note_complete(const Image8& newest, int quality, bool in_full, double now,
                   BrowserPicture& has) {
  const TileGrid grid{newest.width, newest.height};
  has.image = newest;
  has.quality.assign(grid.size(), in_full ? uint8_t(quality) : 0);
  has.changed_at.assign(grid.size(), now);
  has.next = has.next_fine = 0;
  has.pending = true;
}

}  // namespace wellspring::show
