// SPDX-License-Identifier: Apache-2.0
// Projects points to discs and sorts these by the tiles that they touch.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "scan/draw/disc.h"
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

 private:
  std::vector<TileDiscs> runs_;
  std::unique_ptr<Disc[]> discs_;
  size_t room_ = 0;
};

// Returns whether some of the node's discs may be in the picture.
bool may_see_node(const NodePoints& node, const ScanCamera& view, const DiscStyle& style);

}  // namespace wellspring::scan
