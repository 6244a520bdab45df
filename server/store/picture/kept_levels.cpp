// SPDX-License-Identifier: Apache-2.0
#include "store/picture/kept_levels.h"

#include <algorithm>

#include "base/load_error.h"
#include "store/picture/texels.h"

namespace wellspring::store {
namespace {

bool is_coarse(const PyramidLevel& level) {
  return std::max(level.width, level.height) <= coarsest_side;
}

// Reads all tiles of a level; those that are absent stay transparent. Returns no texels if all are.
Piece read_tiles(const PicturePyramid& pyramid, int number) {
  const PyramidLevel& level = pyramid.levels()[size_t(number)];
  Piece whole{int(level.width), int(level.height), {}};
  for (int row = 0; row < level.rows(); row++)
    for (int column = 0; column < level.columns(); column++) {
      const Fetched tile = pyramid.fetch({1, number, uint32_t(column), uint32_t(row)});
      if (!tile.piece) continue;
      if (whole.bytes.empty()) whole = make_piece(whole.width, whole.height);
      paste(*tile.piece, {0, 0, tile.piece->width, tile.piece->height}, column * level.tile_width,
            row * level.tile_height, whole);
    }
  return whole;
}

// Half of nothing is nothing.
Piece half_of(const Piece& whole) {
  if (whole.bytes.empty()) return {(whole.width + 1) / 2, (whole.height + 1) / 2, {}};
  return halve(whole);
}

struct MemoryPyramid : KeptLevels {
  explicit MemoryPyramid(Piece whole) { keep(std::move(whole)); }
};

}  // namespace

Fetched KeptLevels::fetch(PieceKey key) const {
  if (size_t(key.level()) >= levels_.size()) return {};
  const PyramidLevel& level = levels_[size_t(key.level())];
  const int column = int(key.column()), row = int(key.row());
  if (column >= level.columns() || row >= level.rows()) return {};
  const size_t stored = levels_.size() - kept_.size();
  if (size_t(key.level()) < stored) return fetch_stored(key);
  const Piece& whole = kept_[size_t(key.level()) - stored];
  if (whole.bytes.empty()) return {nullptr, absent_seconds, absent_seconds};
  const image::ImagePart part{column * level.tile_width, row * level.tile_height,
                              level.width_at(column), level.height_at(row)};
  return {std::make_shared<Piece>(cut(whole, part))};
}

std::vector<uint8_t> KeptLevels::stored_jpeg(PieceKey key) const {
  if (size_t(key.level()) >= levels_.size() - kept_.size()) return {};
  const PyramidLevel& level = levels_[size_t(key.level())];
  if (int(key.column()) >= level.columns() || int(key.row()) >= level.rows()) return {};
  return take_stored_jpeg(key);
}

Fetched KeptLevels::fetch_stored(PieceKey) const { return {}; }

void KeptLevels::add_coarser_levels(const std::string& file, int64_t most_texels) {
  const PyramidLevel& last = levels_.back();
  if (is_coarse(last)) return;
  if (last.width > most_texels / last.height) fail_as_too_large(file, last.width, last.height);
  keep(half_of(read_tiles(*this, int(levels_.size()) - 1)));
}

void KeptLevels::keep(Piece whole) {
  for (;;) {
    levels_.push_back({whole.width, whole.height});
    kept_.push_back(std::move(whole));
    if (is_coarse(levels_.back())) return;
    whole = half_of(kept_.back());
  }
}

void fail_as_too_large(const std::string& file, int64_t width, int64_t height) {
  throw LoadError(file, "",
                  "picture of " + std::to_string(width) + " x " + std::to_string(height) +
                      " has no smaller versions; `./wellspring import picture " + file +
                      "` makes them");
}

std::shared_ptr<const PicturePyramid> make_pyramid(Piece whole) {
  return std::make_shared<MemoryPyramid>(std::move(whole));
}

Piece read_level(const PicturePyramid& pyramid, int level) {
  if (level < 0 || size_t(level) >= pyramid.levels().size() ||
      !is_coarse(pyramid.levels()[size_t(level)]))
    throw std::invalid_argument("read_level: no level that is read whole");
  Piece whole = read_tiles(pyramid, level);
  return whole.bytes.empty() ? make_piece(whole.width, whole.height) : whole;
}

}  // namespace wellspring::store
