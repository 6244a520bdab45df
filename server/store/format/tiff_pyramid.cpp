// SPDX-License-Identifier: Apache-2.0
#include "store/format/tiff_pyramid.h"

#include <algorithm>
#include <mutex>
#include <optional>
#include <sys/stat.h>
#include <unordered_map>

#include "base/load_error.h"
#include "base/log.h"
#include "store/format/tiff_file.h"

namespace wellspring::store {
namespace {

// So often a shown file is looked at, in case it was replaced. One that is being written changes
// from one time to the next, and is left alone.
constexpr double look_again_seconds = 5;

// Tells whether a path still leads to the same file, and nobody has written to it.
struct FileStamp {
  uint64_t device = 0, number = 0;
  int64_t size = 0, seconds = 0, nanoseconds = 0;  // bytes; when it was written
  bool operator==(const FileStamp&) const = default;
};

// Returns nothing if there is no file.
std::optional<FileStamp> find_stamp(const std::string& file) {
  struct stat about {};
  if (stat(file.c_str(), &about) != 0) return std::nullopt;
  return FileStamp{about.st_dev, about.st_ino, about.st_size, about.st_mtim.tv_sec,
                   about.st_mtim.tv_nsec};
}

// Holds what a TIFF is read from; bands: the description beside it.
struct TiffStamps {
  std::optional<FileStamp> tiff, bands;
  bool operator==(const TiffStamps&) const = default;
};

TiffStamps find_stamps(const std::string& file) {
  return {find_stamp(file), find_stamp(bands_file_of(file))};
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

// Holds a file that is open, its pages, and which of its pieces somebody still has.
class OpenTiff {
 public:
  OpenTiff(const std::string& file, const BandView& view)
      : stamps_(find_stamps(file)), tiff_(file, view), pages_(tiff_.read_pages()) {}
  const TiffStamps& stamps() const { return stamps_; }  // before it was opened
  const TiffFile& tiff() const { return tiff_; }
  const std::vector<TiffPage>& pages() const { return pages_; }

  // Returns the piece if somebody has it: it is good for as long as the file is.
  std::shared_ptr<const Piece> find(PieceKey key) const {
    const std::lock_guard lock(mutex_);
    const auto found = given_.find(key.bits);
    return found == given_.end() ? nullptr : found->second.lock();
  }
  void note(PieceKey key, const std::shared_ptr<const Piece>& piece) const {
    const std::lock_guard lock(mutex_);
    given_[key.bits] = piece;
    if (given_.size() < forget_at_) return;
    std::erase_if(given_, [](const auto& one) { return one.second.expired(); });
    forget_at_ = std::max(least_forgotten, 2 * given_.size());
  }
  // Says whether the other file is cut into levels and tiles as this one is.
  bool is_like(const OpenTiff& other) const {
    return std::ranges::equal(pages_, other.pages_, [](const TiffPage& a, const TiffPage& b) {
      return a.width == b.width && a.height == b.height && a.is_tiled == b.is_tiled &&
             a.block_width == b.block_width && a.block_height == b.block_height &&
             a.orientation.code == b.orientation.code;
    });
  }

 private:
  static constexpr size_t least_forgotten = 1024;
  TiffStamps stamps_;
  TiffFile tiff_;
  std::vector<TiffPage> pages_;  // one a stored level
  mutable std::mutex mutex_;     // guards what follows
  mutable std::unordered_map<uint64_t, std::weak_ptr<const Piece>> given_;
  mutable size_t forget_at_ = least_forgotten;
};

class TiffPyramid : public KeptLevels {
 public:
  TiffPyramid(std::shared_ptr<const OpenTiff> open, const std::string& file, BandView view,
              int64_t most_texels, std::function<double()> clock)
      : file_(file),
        view_(std::move(view)),
        clock_(std::move(clock)),
        orientation_(open->pages()[0].orientation),
        open_(std::move(open)),
        look_at_(clock_() + look_again_seconds),
        seen_(open_->stamps()),
        tried_(seen_) {
    const std::vector<TiffPage>& pages = open_->pages();
    for (const TiffPage& page : pages) {
      PyramidLevel level{page.width, page.height, page.block_width, page.block_height};
      if (std::min(level.tile_width, level.tile_height) < 16)
        throw LoadError(file, page.name, "tiles have fewer than 16 texels a side");
      if (orientation_.swaps_sides()) {
        std::swap(level.width, level.height);
        std::swap(level.tile_width, level.tile_height);
      }
      levels_.push_back(level);
    }
    if (pages.size() > 1) {
      add_coarser_levels(file);
      return;
    }
    if (std::max(pages[0].width, pages[0].height) > coarsest_side)
      check_stored(pages[0], open_->tiff().size(), file);  // it is read whole
    add_coarser_levels(file, most_texels);
  }

 protected:
  Fetched fetch_stored(PieceKey key) const override {
    const std::shared_ptr<const OpenTiff> open = open_now();
    if (auto known = open->find(key)) return {std::move(known), replaced_seconds};
    const PyramidLevel& level = levels_[size_t(key.level())];
    const TiffPage& page = open->pages()[size_t(key.level())];
    const int column = int(key.column()), row = int(key.row());
    image::ImagePart part{column * level.tile_width, row * level.tile_height,
                          level.width_at(column), level.height_at(row)};
    // The part as it is stored.
    if (orientation_.swaps_sides()) std::swap(part.x, part.y), std::swap(part.width, part.height);
    if (orientation_.mirrors_columns()) part.x = int(page.width) - part.x - part.width;
    if (orientation_.mirrors_rows()) part.y = int(page.height) - part.y - part.height;
    std::optional<Piece> stored = read_part(open->tiff(), page, part);
    if (!stored) return {nullptr, absent_seconds, absent_seconds};
    auto piece = std::make_shared<const Piece>(turn(std::move(*stored), orientation_));
    open->note(key, piece);
    return {std::move(piece), replaced_seconds};
  }

  // Tiles at the right and lower edge reach over, so they are decoded.
  std::vector<uint8_t> take_stored_jpeg(PieceKey key) const override {
    const PyramidLevel& level = levels_[size_t(key.level())];
    const int column = int(key.column()), row = int(key.row());
    if (!orientation_.is_upright() || level.width_at(column) != level.tile_width ||
        level.height_at(row) != level.tile_height)
      return {};
    const std::shared_ptr<const OpenTiff> open = open_now();
    return open->tiff().read_jpeg(open->pages()[size_t(key.level())], column, row);
  }

 private:
  // Returns the file that is to be read now.
  std::shared_ptr<const OpenTiff> open_now() const {
    look_again();
    const std::lock_guard lock(mutex_);
    return open_;
  }

  // Opens the file anew if another one lies in its place, or another description of its bands
  // beside it. The old one is good until then.
  void look_again() const {
    const std::unique_lock looking(looking_, std::try_to_lock);
    if (!looking || clock_() < look_at_) return;
    look_at_ = clock_() + look_again_seconds;
    const TiffStamps found = find_stamps(file_);
    const bool is_written = found != seen_;
    seen_ = found;
    if (!found.tiff || is_written || found == tried_) return;
    tried_ = found;
    try {
      auto opened = std::make_shared<const OpenTiff>(file_, view_);
      if (!opened->is_like(*open_))
        throw LoadError(file_, "", "was replaced by a picture of other sizes");
      const std::lock_guard lock(mutex_);
      open_ = std::move(opened);
    } catch (const LoadError& error) {
      log::warn("{}; the old one is shown until the exhibit is loaded anew", error.what());
    }
  }

  const std::string file_;
  const BandView view_;
  const std::function<double()> clock_;
  const Orientation orientation_;
  mutable std::mutex mutex_;                      // guards open_
  mutable std::shared_ptr<const OpenTiff> open_;  // changed by who has looking_, too
  mutable std::mutex looking_;                    // guards what follows
  mutable double look_at_;                        // seconds of the clock
  mutable TiffStamps seen_, tried_;               // the last seen, and the last opened
};

}  // namespace

std::shared_ptr<const PicturePyramid> load_tiff(const std::string& file, int64_t most_texels,
                                                std::function<double()> clock,
                                                const BandView& view) {
  auto open = std::make_shared<const OpenTiff>(file, view);
  const TiffPage& first = open->pages()[0];
  if (first.is_tiled)
    return std::make_shared<TiffPyramid>(std::move(open), file, view, most_texels,
                                         std::move(clock));
  if (first.width > most_texels / first.height) fail_as_too_large(file, first.width, first.height);
  check_stored(first, open->tiff().size(), file);
  std::optional<Piece> whole =
      read_part(open->tiff(), first, {0, 0, int(first.width), int(first.height)});
  if (!whole) throw LoadError(file, first.name, "has no texels");
  return make_pyramid(turn(std::move(*whole), first.orientation));
}

}  // namespace wellspring::store
