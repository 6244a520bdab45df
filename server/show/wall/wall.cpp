// SPDX-License-Identifier: Apache-2.0
#include "show/wall/wall.h"

#include <algorithm>
#include <cmath>

namespace wellspring::show {

namespace {

constexpr float widest = 1.7453f;  // radians

// Returns pixels of `count` pictures side by side, and of the frames between them.
int side_of(int count, int side, float bezel) {
  return count * side + (count - 1) * int(std::lround(bezel * float(side)));
}

// Returns how many pixels one of `count` pictures has of `whole`: the inverse of side_of().
int part_of(int whole, int count, float bezel) {
  int side = int(float(whole) / (float(count) + float(count - 1) * bezel));
  while (side > 1 && side_of(count, side, bezel) > whole) side--;
  while (side_of(count, side + 1, bezel) <= whole) side++;
  return side;
}

}  // namespace

const char* check_part(const WallPart& part) {
  if (part.columns * part.rows > most_tiles) return "hello.wall: has more than 16 screens";
  if (part.column.has_value() != part.row.has_value())
    return "hello.wall: column and row go together";
  if (part.column && *part.column >= part.columns)
    return "hello.wall.column: must be less than columns";
  if (part.row && *part.row >= part.rows) return "hello.wall.row: must be less than rows";
  if (part.bezel.x < 0 || part.bezel.y < 0) return "hello.wall.bezel: must be 0 or more";
  return nullptr;
}

WallSize wall_size(const WallPart& wall, const WallSize& tile) {
  return {side_of(wall.columns, tile.width, wall.bezel.x),
          side_of(wall.rows, tile.height, wall.bezel.y)};
}

WallSize tile_size(const WallPart& wall, const WallSize& wanted, double most) {
  const WallSize whole = wall_size(wall, wanted);
  const double longest = std::max(whole.width, whole.height);
  const double scale = std::min(
      {1.0, std::sqrt(most / (double(whole.width) * whole.height)), most_wall_pixels / longest});
  const auto fit = [&](int side) { return std::max(16, int(side * scale) / 8 * 8); };
  return {fit(wanted.width), fit(wanted.height)};
}

PictureWindow tile_window(const WallPart& wall, const WallSize& whole, int column, int row) {
  if (column >= wall.columns || row >= wall.rows) return {};
  const int width = part_of(whole.width, wall.columns, wall.bezel.x),
            height = part_of(whole.height, wall.rows, wall.bezel.y);
  return {column * (width + int(std::lround(wall.bezel.x * float(width)))),
          row * (height + int(std::lround(wall.bezel.y * float(height)))), width, height};
}

float wall_fov(const WallPart& wall, const WallSize& whole, float fov) {
  const float aspect = float(whole.width) / float(whole.height);
  const float across = wall.fov > 0 ? wall.fov : widest;
  const float most = 2 * std::atan(std::tan(0.5f * across) / aspect);
  return wall.fov > 0 ? most : std::min(fov, most);
}

}  // namespace wellspring::show
