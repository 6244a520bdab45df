// SPDX-License-Identifier: Apache-2.0
// Keeps those levels of a pyramid in memory that no file has: all of a plain picture, or those
// coarser than the coarsest that a file has.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "store/picture/pyramid.h"

namespace wellspring::store {

// A picture of more texels is not read whole.
inline constexpr int64_t most_whole_texels = int64_t(1) << 26;

// A piece that is absent is looked for again after so many seconds.
inline constexpr double absent_seconds = 60;
// So often a tile that has a file of its own is read again, in case the file was replaced.
inline constexpr double replaced_seconds = 60;

class KeptLevels : public PicturePyramid {
 public:
  // Answers for levels that are kept; asks fetch_stored() for others. There are no pieces outside.
  Fetched fetch(PieceKey key) const final;
  std::vector<uint8_t> stored_jpeg(PieceKey key) const final;

 protected:
  // Fetches a piece of a level that is not kept; `key` is one of its places.
  virtual Fetched fetch_stored(PieceKey key) const;
  // Returns such a piece as PicturePyramid::stored_jpeg() does.
  virtual std::vector<uint8_t> take_stored_jpeg(PieceKey) const { return {}; }
  // Adds levels, each half as large as the last, until one has at most `coarsest_side` texels a
  // side. Reads all of the last level for that; throws a LoadError if it has more texels.
  void add_coarser_levels(const std::string& file, int64_t most_texels = int64_t(1) << 24);
  // Adds a level that is kept, and those coarser.
  void keep(Piece whole);

 private:
  std::vector<Piece> kept_;  // the last levels; one without texels is absent
};

// Refuses a picture that is too large to be read whole.
[[noreturn]] void fail_as_too_large(const std::string& file, int64_t width, int64_t height);

// Returns a picture that is in memory as a pyramid.
std::shared_ptr<const PicturePyramid> make_pyramid(Piece whole);

}  // namespace wellspring::store
