// SPDX-License-Identifier: Apache-2.0
// Looks up very large pictures as a pixel sees them: the level of detail by the pixel's footprint,
// trilinear, up to 16 taps along its longer axis (Taibo, Seoane and Hernandez, "Dynamic Virtual
// Textures", section 4.3), of the finest level that is there. There is never a hole.
#pragma once
#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "base/vec.h"
#include "store/picture/pyramid.h"
#include "store/seen_pieces.h"

namespace wellspring::store {

// Holds a picture that can be looked up.
struct LargePicture {
  std::shared_ptr<PieceStore> store;
  std::shared_ptr<const PicturePyramid> pyramid;
  int source = 0;
  Piece coarsest;  // the whole last level
  // Logarithm to base 2 of how many texels of the finest level a level's texel is wide.
  std::vector<float> scale;
  LevelSizes sizes;
  mutable SeenPieces seen;  // pieces that were looked for since somebody took them

  // Adds the source to the store, and reads its coarsest level. Throws LoadError.
  LargePicture(std::shared_ptr<PieceStore> store, std::shared_ptr<const PicturePyramid> pyramid);
  // Adds a picture that differs from another one in small things, as words on it, and takes its
  // coarsest level: nothing is read. The levels are of the same size.
  LargePicture(const LargePicture& other, std::shared_ptr<const PicturePyramid> pyramid);
  ~LargePicture();
  LargePicture(const LargePicture&) = delete;
  LargePicture& operator=(const LargePicture&) = delete;
};

// Holds what a pixel sees of a picture: its middle, 0 to 1 from the upper left, and how far that
// moves from pixel to pixel. Doubles: a float does not tell apart the texels of 2^24 a side.
struct PictureFootprint {
  dvec2 at{0};
  dvec2 across{0}, down{0};
};

// Says how two pictures are shown at one place: the second one from `share` of the width on, mixed
// in by `share`, or by how much it differs from the first.
enum class Blend : uint8_t { none, curtain, fade, difference };

// Holds a picture and how it lies: its homogeneous coordinates are `placing` times (u, v, 1).
struct PictureLayer {
  std::shared_ptr<const LargePicture> picture;  // null: there is none
  glm::dmat3 placing{1};
  bool operator==(const PictureLayer&) const = default;
};

// Holds what is shown at the place of a picture: one layer, or two.
struct ShownPicture {
  PictureLayer base, over;
  Blend blend = Blend::none;
  float share = 0.5f;
  bool operator==(const ShownPicture&) const = default;
};

// Returns the projective map of the unit square, whose corners go around from its upper left, to
// these corners; none: three of them lie on a line (Heckbert 1989, section 2.2.3).
std::optional<glm::dmat3> square_to_corners(const std::array<dvec2, 4>& corners);
// Returns the same footprint in the coordinates that `placing` leads to.
PictureFootprint placed_footprint(const PictureFootprint& footprint, const glm::dmat3& placing);

// Looks up on one thread, for as short as a PieceReader lives.
class PictureSampler {
 public:
  explicit PictureSampler(const PieceStore& store);
  ~PictureSampler();
  PictureSampler(const PictureSampler&) = delete;
  PictureSampler& operator=(const PictureSampler&) = delete;

  // Returns linear RGB, and notes what it looked for with the picture. Coordinates beyond the
  // picture read its edge.
  vec3 look(const LargePicture& picture, const PictureFootprint& footprint);
  vec3 look(const ShownPicture& shown, const PictureFootprint& footprint);

 private:
  struct Found {
    uint64_t key = 0;
    const Piece* piece = nullptr;
  };
  struct Tile {
    const LargePicture* picture = nullptr;
    int level = 0;
    int left = 0, top = 0, right = 0, bottom = 0;  // texels of the level
    PieceKey key;
    const Piece* piece = nullptr;  // null: it is not there
  };
  const Piece* find(PieceKey key);
  const Tile& tile_at(const LargePicture& picture, int level, int x, int y);
  vec3 look(const PictureLayer& layer, const PictureFootprint& footprint);
  void see(const LargePicture& picture, PieceKey key);
  bool read(const LargePicture& picture, int level, dvec2 at, vec3& color);
  vec3 read_finest(const LargePicture& picture, int level, dvec2 at, int& got);

  const PieceReader reader_;
  const PieceStore& store_;
  std::array<Found, 8> found_;  // pieces of the last look-ups
  std::array<Tile, 4> tiles_;   // tiles of the last look-ups, by level
  struct Noted {
    const LargePicture* picture = nullptr;
    SeenPiece piece;
  };
  Noted noted_[2];
  uint64_t looked_ = 0, looked_coarse_ = 0;
};

}  // namespace wellspring::store
