// SPDX-License-Identifier: Apache-2.0
#include "scan/draw/draw_points.h"

#include <algorithm>
#include <stdexcept>

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

  void find_pieces(std::span<const NodePoints> nodes, const ScanCamera& view,
                   const DiscStyle& style);
  void sort_runs(size_t tiles);
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
  const DiscScene scene{
      .nodes = nodes, .pieces = arrays.pieces, .view = &view, .blended = style.blended};
  parallel_each(tiles_x * tiles_y, [&](int t) {
    static thread_local TilePlanes planes;
    const uint32_t begin = arrays.first_run[size_t(t)], end = arrays.first_run[size_t(t) + 1];
    draw_disc_tile(buffer, planes, scene, t % tiles_x, t / tiles_x,
                   std::span(arrays.runs).subspan(begin, end - begin), arrays.area[size_t(t)]);
  });
}

}  // namespace wellspring::scan
