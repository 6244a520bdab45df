// SPDX-License-Identifier: Apache-2.0
// Several pages, the tiles of a wall of screens, show parts of one wide picture. The picture is one
// flat window: a screen's part is as an eye before the middle of the wall sees it, an off-axis
// frustum (Kooima, "Generalized Perspective Projection", 2008). All that lies behind the frames
// between two pictures, as wide as a `bezel` says, is drawn and cut away, so that lines go on
// there.
#pragma once
#include <cstdint>
#include <deque>
#include <vector>

#include "cache/project.h"
#include "wire/wall_part.h"

namespace wellspring::show {

inline constexpr int most_tiles = 16;
// Pixels of the wide picture's longer side, at most: the rasteriser reaches as far with some around
// it (world/raster/raster_setup.h).
inline constexpr int most_wall_pixels = 6144;

// Seconds after which pictures of a moment are shown, whether or not all tiles have decoded theirs.
// A tile that is as late with the last one is not waited for with the next.
inline constexpr double most_tile_wait = 0.15;

// Says what part a visit has in a wall. The camera is a visit without a page: what the wall shows.
enum class WallRole : uint8_t { none, tile, leader, camera };

struct Visitor;  // show/state/visitor.h

struct VisitorWall {
  // Holds pictures of one moment, which were sent to all tiles that could take them.
  struct Moment {
    uint32_t frame = 0;
    double sent_at = 0;  // show time
  };
  WallRole role = WallRole::none;
  WallPart part;                // a camera's: the part of the tile that came last
  std::vector<Visitor*> tiles;  // a camera's
  std::deque<Moment> moments;   // a camera's: those that tiles do not show yet, oldest first
};

struct WallSize {
  int width = 0, height = 0;  // pixels
  bool operator==(const WallSize&) const = default;
};

// Returns what is wrong with the part, "hello.wall.column: ..."; null: nothing.
const char* check_part(const WallPart& part);
// Returns the pixels of the wide picture, where each tile has as many.
WallSize wall_size(const WallPart& wall, const WallSize& tile);
// Returns the pixels of each tile, multiples of 8: as wanted, or so many fewer that the wide
// picture has no more than `most`, nor a side longer than most_wall_pixels.
WallSize tile_size(const WallPart& wall, const WallSize& wanted, double most);
// Returns where in a wide picture of that size the tile is; nothing if it is none of its screens.
PictureWindow tile_window(const WallPart& wall, const WallSize& whole, int column, int row);
// Returns the vertical field of view of the wide picture: such that it is as wide as the wall says,
// else the viewpoint's `fov`, but not wider than 100 degrees, beyond which its edges are drawn out.
float wall_fov(const WallPart& wall, const WallSize& whole, float fov);

}  // namespace wellspring::show
