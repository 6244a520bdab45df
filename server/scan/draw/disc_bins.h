// SPDX-License-Identifier: Apache-2.0
// Projects points to discs and sorts these by the tiles that they touch.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "base/memory.h"
#include "scan/draw/disc.h"
#include "scan/camera.h"
#include "scan/draw/disc_style.h"

namespace wellspring::scan {

// The discs of a piece, tile by tile, in the order of its points. Memory is kept.
class PieceDiscs {
 public:
  // Replaces the discs by those of `piece`.
  void make(const Piece& piece, uint32_t number, const NodePoints& node, const ScanCamera& view,
            const DiscStyle& style);
  std::span<const TileDiscs> runs() const { return runs_; }
  const Disc* discs() const { return discs_.get(); }
  // Spheres that are too large for tiles' lists; their extents are their radii.
  std::span<const Disc> large() const { return large_; }
  size_t memory_bytes() const { return room_ * sizeof(Disc) + bytes_of(runs_, large_); }

 private:
  std::vector<TileDiscs> runs_;
  std::vector<Disc> large_;
  std::unique_ptr<Disc[]> discs_;
  size_t room_ = 0;
};

// Returns how many pixels from its middle a large sphere may reach.
float large_reach(const Disc& sphere, const ScanCamera& view);

// Returns whether some of the node's discs may be in the picture.
bool may_see_node(const NodePoints& node, const ScanCamera& view, const DiscStyle& style);

}  // namespace wellspring::scan
