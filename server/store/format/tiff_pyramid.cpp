// SPDX-License-Identifier: Apache-2.0
#include "store/format/tiff_pyramid.h"

#include <algorithm>

#include "base/load_error.h"
#include "store/format/tiff_file.h"

namespace wellspring::store {
namespace {

// Refuses a page of more texels than may be packed into the file.
void check_stored(const TiffPage& page, const TiffFile& tiff, const std::string& file) {
  const int64_t bytes = page.width * page.height / 8 * page.bits * page.channels;
  if (bytes / page.most_packed > tiff.size())
    throw LoadError(file, page.name,
                    "picture of " + std::to_string(page.width) + " x " +
                        std::to_string(page.height) + " texels is in a file of " +
                        std::to_string(tiff.size()) + " bytes");
}

// Reads a part of a page, which lies within it. Blocks that are absent stay transparent; nothing is
// returned if all are.
std::optional<Piece> read_part(const TiffFile& tiff, const TiffPage& page,
                               const image::ImagePart& part) {
  std::optional<Piece> piece;
  const int last_column = (part.x + part.width - 1) / page.block_width;
  const int last_row = (part.y + part.height - 1) / page.block_height;
  for (int row = part.y / page.block_height; row <= last_row; row++)
    for (int column = part.x / page.block_width; column <= last_column; column++) {
      std::optional<Piece> block = tiff.read_block(page, column, row);
      if (!block) continue;
      if (block->width == part.width && block->height == part.height &&
          column * page.block_width == part.x && row * page.block_height == part.y)
        return block;
      if (!piece) piece = make_piece(part.width, part.height);
      paste(*block, {0, 0, block->width, block->height}, column * page.block_width - part.x,
            row * page.block_height - part.y, *piece);
    }
  return piece;
}

class TiffPyramid : public KeptLevels {
 public:
  TiffPyramid(std::shared_ptr<const TiffFile> tiff, std::vector<TiffPage> pages,
              const std::string& file, int64_t most_texels)
      : tiff_(std::move(tiff)), pages_(std::move(pages)), orientation_(pages_[0].orientation) {
    for (const TiffPage& page : pages_) {
      PyramidLevel level{page.width, page.height, page.block_width, page.block_height};
      if (std::min(level.tile_width, level.tile_height) < 16)
        throw LoadError(file, page.name, "tiles have fewer than 16 texels a side");
      if (orientation_.swaps_sides()) {
        std::swap(level.width, level.height);
        std::swap(level.tile_width, level.tile_height);
      }
      levels_.push_back(level);
    }
    if (pages_.size() > 1) {
      add_coarser_levels(file);
      return;
    }
    if (std::max(pages_[0].width, pages_[0].height) > coarsest_side)
      check_stored(pages_[0], *tiff_, file);  // it is read whole
    add_coarser_levels(file, most_texels);
  }

 protected:
  Fetched fetch_stored(PieceKey key) const override {
    const PyramidLevel& level = levels_[size_t(key.level())];
    const TiffPage& page = pages_[size_t(key.level())];
    const int column = int(key.column()), row = int(key.row());
    image::ImagePart part{column * level.tile_width, row * level.tile_height,
                          level.width_at(column), level.height_at(row)};
    // The part as it is stored.
    if (orientation_.swaps_sides()) std::swap(part.x, part.y), std::swap(part.width, part.height);
    if (orientation_.mirrors_columns()) part.x = int(page.width) - part.x - part.width;
    if (orientation_.mirrors_rows()) part.y = int(page.height) - part.y - part.height;
    std::optional<Piece> piece = read_part(*tiff_, page, part);
    if (!piece) return {nullptr, absent_seconds, absent_seconds};
    return {std::make_shared<Piece>(turn(std::move(*piece), orientation_))};
  }

  // Tiles at the right and lower edge reach over, so they are decoded.
  std::vector<uint8_t> take_stored_jpeg(PieceKey key) const override {
    const PyramidLevel& level = levels_[size_t(key.level())];
    const int column = int(key.column()), row = int(key.row());
    if (!orientation_.is_upright() || level.width_at(column) != level.tile_width ||
        level.height_at(row) != level.tile_height)
      return {};
    return tiff_->read_jpeg(pages_[size_t(key.level())], column, row);
  }

 private:
  std::shared_ptr<const TiffFile> tiff_;
  std::vector<TiffPage> pages_;  // one a stored level
  Orientation orientation_;
};

}  // namespace

std::shared_ptr<const PicturePyramid> load_tiff(const std::string& file, int64_t most_texels) {
  const auto tiff = std::make_shared<TiffFile>(file);
  std::vector<TiffPage> pages = tiff->read_pages();
  const TiffPage& first = pages[0];
  if (first.is_tiled)
    return std::make_shared<TiffPyramid>(tiff, std::move(pages), file, most_texels);
  if (first.width > most_texels / first.height) fail_as_too_large(file, first.width, first.height);
  check_stored(first, *tiff, file);
  std::optional<Piece> whole = read_part(*tiff, first, {0, 0, int(first.width), int(first.height)});
  if (!whole) throw LoadError(file, first.name, "has no texels");
  return make_pyramid(turn(std::move(*whole), first.orientation));
}

}  // namespace wellspring::store
