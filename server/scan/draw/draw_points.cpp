// SPDX-License-Identifier: Apache-2.0
#include "scan/draw/draw_points.h"

#include <algorithm>
#include <stdexcept>

#include "base/memory.h"
#include "base/parallel.h"
#include "scan/draw/disc_bins.h"
#include "scan/draw/disc_tile.h"

namespace wellspring::scan {

struct PointRaster::Arrays {
  std::vector<Piece> pieces;
  std::vector<PieceDiscs> discs;  // a piece each
  // The runs of discs of all tiles, tile by tile, in the order of the pieces.
  std::vector<uint32_t> first_run;  // a tile each, and the end
  std::vector<std::span<const Disc>> runs;
  std::vector<uint64_t> area;  // a tile each
  // The large spheres of all tiles, likewise.
  std::vector<uint32_t> first_large;
  std::vector<Disc> large;

  void find_pieces(std::span<const NodePoints> nodes, const ScanCamera& view,
                   const DiscStyle& style);
  void sort_runs(size_t tiles);
  void sort_large(const ScanCamera& view, int tiles_x, int tiles_y);
};

void PointRaster::Arrays::find_pieces(std::span<const NodePoints> nodes, const ScanCamera& view,
                                      const DiscStyle& style) {
  pieces.clear();
  for (size_t n = 0; n < nodes.size(); n++) {
    if (!may_see_node(nodes[n], view, style)) continue;
    for (uint64_t first = 0; first < nodes[n].count; first += piece_points)
      pieces.push_back(
          {.node = uint32_t(n),
           .first = uint32_t(first),
           .count = uint32_t(std::min<uint64_t>(piece_points, nodes[n].count - first))});
  }
  if (pieces.size() > most_pieces) throw std::length_error("too many points for one picture");
  if (discs.size() < pieces.size()) discs.resize(pieces.size());
}

void PointRaster::Arrays::sort_runs(size_t tiles) {
  first_run.assign(tiles + 1, 0);
  area.assign(tiles, 0);
  for (size_t p = 0; p < pieces.size(); p++)
    for (const TileDiscs& run : discs[p].runs()) {
      first_run[run.tile + 1]++;
      area[run.tile] += run.area;
    }
  for (size_t t = 0; t < tiles; t++) first_run[t + 1] += first_run[t];
  runs.resize(first_run[tiles]);
  std::vector<uint32_t> next(first_run.begin(), first_run.end() - 1);
  for (size_t p = 0; p < pieces.size(); p++)
    for (const TileDiscs& run : discs[p].runs())
      runs[next[run.tile]++] = {discs[p].discs() + run.begin, discs[p].discs() + run.end};
}

void PointRaster::Arrays::sort_large(const ScanCamera& view, int tiles_x, int tiles_y) {
  first_large.assign(size_t(tiles_x) * size_t(tiles_y) + 1, 0);
  // Calls take(tile, sphere) for all that a tile may show.
  const auto each = [&](const auto& take) {
    for (size_t p = 0; p < pieces.size(); p++)
      for (const Disc& sphere : discs[p].large()) {
        const vec2 at = place_of(sphere);
        const float reach = large_reach(sphere, view);
        const auto tile = [](float place, int count) {
          return int(std::clamp(place / tile_side, 0.0f, float(count - 1)));
        };
        const int right = tile(at.x + reach, tiles_x), low = tile(at.y + reach, tiles_y);
        for (int y = tile(at.y - reach, tiles_y); y <= low; y++)
          for (int x = tile(at.x - reach, tiles_x); x <= right; x++)
            take(size_t(y * tiles_x + x), sphere);
      }
  };
  each([&](size_t tile, const Disc&) { first_large[tile + 1]++; });
  for (size_t t = 1; t < first_large.size(); t++) first_large[t] += first_large[t - 1];
  large.resize(first_large.back());
  std::vector<uint32_t> next(first_large.begin(), first_large.end() - 1);
  each([&](size_t tile, const Disc& sphere) { large[next[tile]++] = sphere; });
}

size_t PointRaster::memory_bytes() const {
  size_t sum = bytes_of(arrays_->pieces, arrays_->discs, arrays_->first_run, arrays_->runs,
                        arrays_->area, arrays_->first_large, arrays_->large);
  for (const PieceDiscs& one : arrays_->discs) sum += one.memory_bytes();
  return sum;
}

PointRaster::PointRaster() : arrays_(std::make_unique<Arrays>()) {}
PointRaster::~PointRaster() = default;

void PointRaster::draw(PointBuffer& buffer, std::span<const NodePoints> nodes,
                       const ScanCamera& view, const DiscStyle& style) {
  Arrays& arrays = *arrays_;
  buffer.resize(view.width, view.height);
  arrays.find_pieces(nodes, view, style);
  parallel_each(int(arrays.pieces.size()), [&](int p) {
    const Piece& piece = arrays.pieces[size_t(p)];
    arrays.discs[size_t(p)].make(piece, uint32_t(p), nodes[piece.node], view, style);
  });
  const int tiles_x = (view.width + tile_side - 1) / tile_side;
  const int tiles_y = (view.height + tile_side - 1) / tile_side;
  arrays.sort_runs(size_t(tiles_x) * size_t(tiles_y));
  arrays.sort_large(view, tiles_x, tiles_y);
  const DiscScene scene{.nodes = nodes,
                        .pieces = arrays.pieces,
                        .view = &view,
                        .blended = style.blended && !style.spheres,
                        .spheres = style.spheres};
  parallel_each(tiles_x * tiles_y, [&](int t) {
    static thread_local TilePlanes planes;
    const uint32_t begin = arrays.first_run[size_t(t)], end = arrays.first_run[size_t(t) + 1];
    const uint32_t first = arrays.first_large[size_t(t)], last = arrays.first_large[size_t(t) + 1];
    draw_disc_tile(buffer, planes, scene, t % tiles_x, t / tiles_x,
                   std::span(arrays.runs).subspan(begin, end - begin), arrays.area[size_t(t)],
                   std::span(arrays.large).subspan(first, last - first));
  });
}

}  // namespace wellspring::scan
