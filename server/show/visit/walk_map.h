// SPDX-License-Identifier: Apache-2.0
// Holds where a visitor can stand: the ground that can be walked to from the viewpoints, as a grid
// of places with the distance to obstacles. Made once for an exhibit.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "show/exhibit/exhibit.h"
#include "show/exhibit/json_fields.h"
#include "world/world.h"

namespace wellspring::show {

struct WalkPlace {
  vec3 ground{0};   // position relative to the scene's origin
  float clear = 0;  // metres, horizontally, to the nearest obstacle; at most WalkMap::farthest
  std::array<int32_t, 8> next{-1, -1, -1, -1, -1, -1, -1, -1};  // places around it; -1: no way
};

struct WalkMap {
  float cell = 0.1f;  // metres between places
  float eye_height = 1.65f, radius = 0.25f;
  float farthest = 0.6f;  // metres; obstacles farther away are not told apart
  vec3 corner{0};         // the grid's corner, at x = z = 0 of its columns
  int width = 0, depth = 0;
  std::vector<WalkPlace> places;
  std::vector<int32_t> column;       // first place of every cell, one above the other: place_after
  std::vector<int32_t> place_after;  // the next place of the same column; -1: none
};

// Holds an obstacle that is in no mesh: somebody who stands there.
struct WalkObstacle {
  vec3 ground{0};
  float radius = 0.3f;
};

inline constexpr float walk_step = 0.4f;          // metres that are climbed without thinking
inline constexpr int most_walk_places = 400'000;  // larger grounds get wider cells

// Makes the map. `seeds`: eyes of people who can stand where they are. Exact against triangles:
// nothing is too thin to count. Uses all cores, for up to a second.
WalkMap make_walk_map(const World& world, const WalkSettings& rules, const std::vector<vec3>& seeds,
                      const std::vector<WalkObstacle>& obstacles);

// Returns the place nearest to a point on the ground whose height is within walk_step, at most
// `reach` away horizontally, with at least `clear` metres around it; -1: none.
int find_place(const WalkMap& map, vec3 ground, float reach, float clear);
// Returns the metres to the nearest obstacle at a point on the ground, at most WalkMap::farthest;
// between places the value of the nearest one less the distance to it. 0: off the map.
float clear_at(const WalkMap& map, vec3 ground);
// Returns the height of the ground near (x, z), from the places around; `near` says which storey.
float ground_at(const WalkMap& map, float x, float z, float near);

// Moves a walking visitor: walls stop, floors carry, stairs are climbed, bounds hold. Rays against
// the world decide; a visitor inside a wall is not trapped there.

// Returns the place after moving from `position` (absolute) with `velocity` (metres a second, world
// axes) for `dt` seconds (0 to 0.25; longer steps are cut). With no rules: free flight.
dvec3 walk(const World& world, const std::optional<WalkSettings>& rules, dvec3 position,
           vec3 velocity, float dt);

// Goes round somebody to whom nobody comes nearer than `distance` on the ground (the innermost
// glass wall of the storyteller and kiosk paper): a step from `from` to `to` ends on the circle
// instead of within it, slid along; a visitor who stands within already may only go outwards.
inline constexpr double nearest_to_storyteller = 0.9;  // metres
dvec3 keep_distance(dvec3 from, dvec3 to, dvec3 centre, double distance = nearest_to_storyteller);

// Notes every viewpoint with no ground under it, from which nobody who walks could take a step.
void check_ground(const Exhibit& exhibit, const World& world, std::vector<Problem>& problems);

// Returns the velocity in world axes of `move` = [right, up, forward] for a visitor looking along
// `yaw`.
vec3 move_direction(vec3 move, float yaw);

}  // namespace wellspring::show
