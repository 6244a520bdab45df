// SPDX-License-Identifier: Apache-2.0
#include "lawn/response.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "base/parallel.h"

namespace wellspring::lawn {
namespace {

constexpr float never = -std::numeric_limits<float>::infinity();
constexpr int spring_iterations = 2;
constexpr double longest_count = 64;  // seconds after which `since` moves on, for precision

size_t padded(const LawnTile& tile) {
  return size_t(tile.count + lane_count - 1) / lane_count * lane_count;
}

// Returns the lanes in which a walker may reach a strip.
LaneMask find_near(const Collider& collider, const BladeShapes& shapes) {
  Lanes3 low = shapes.joint[1], high = low;
  for (int k = 2; k < joints; k++) {
    const Lanes3& p = shapes.joint[k];
    low = {lanes_min(low.x, p.x), lanes_min(low.y, p.y), lanes_min(low.z, p.z)};
    high = {lanes_max(high.x, p.x), lanes_max(high.y, p.y), lanes_max(high.z, p.z)};
  }
  return (high.x > collider.low.x) & (low.x < collider.high.x) & (high.y > collider.low.y) &
         (low.y < collider.high.y) & (high.z > collider.low.z) & (low.z < collider.high.z);
}

LaneMask push_joints(const Collider& collider, const LaneMask& lanes, BladeShapes& shapes) {
  LaneMask moved{};
  const LaneMask near = lanes & find_near(collider, shapes);
  if (!any_lane(near)) return moved;
  for (int k = 1; k < joints; k++) moved |= push_out(collider, near, shapes.joint[k]);
  return moved;
}

// Moves a place that several walkers enclose along a level line until it is in none of them. Each
// is left for good when it is convex; steps grow, so that the way ends in any case.
vec3 way_out(std::span<const Collider> colliders, vec3 v, vec3 way) {
  float least = 1e-4f;
  for (bool inside = true; inside; least *= 1.1f) {
    inside = false;
    for (const Collider& collider : colliders) {
      const float distance = distance_to(collider, v);
      if (!(distance < 0)) continue;
      v += way * (std::max(-distance, least) + collider.margin);
      inside = true;
    }
  }
  return v;
}

void push_all(std::span<const Collider> colliders, const LaneMask& lanes, BladeShapes& shapes) {
  constexpr int passes = 6;
  LaneMask moved = lanes;
  for (int i = 0; i < passes && any_lane(moved); i++) {
    LaneMask again{};
    for (const Collider& collider : colliders) again |= push_joints(collider, moved, shapes);
    moved = again;
  }
  for (unsigned left = negative_lanes(moved); left != 0; left &= left - 1) {
    const int lane = __builtin_ctz(left);
    for (int k = 1; k < joints; k++) {
      vec3 way = shapes.joint[k].at(lane) - shapes.joint[0].at(lane);
      way.y = 0;
      way = dot(way, way) > 1e-12f ? normalize(way) : vec3(1, 0, 0);
      shapes.joint[k].set(lane, way_out(colliders, shapes.joint[k].at(lane), way));
    }
  }
}

// Lifts joints to the ground, which around a root is about the tile's plane.
void lift(const LawnTile& tile, const LaneMask& lanes, BladeShapes& shapes) {
  const Lanes3& root = shapes.joint[0];
  for (int k = 1; k < joints; k++) {
    Lanes3& p = shapes.joint[k];
    const Lanes ground = root.y + (p.x - root.x) * tile.slope.x + (p.z - root.z) * tile.slope.y;
    p.y = lanes ? lanes_max(p.y, ground) : p.y;
  }
}

void store_shapes(BentTile& bent, size_t size, size_t at, const LaneMask& lanes,
                  const BladeShapes& shapes) {
  for (int k = 1; k < joints; k++) {
    const Lanes values[3] = {shapes.joint[k].x, shapes.joint[k].y, shapes.joint[k].z};
    for (int axis = 0; axis < 3; axis++) {
      float* const to = &bent.joint[size_t(3 * (k - 1) + axis) * size + at];
      store_lanes(to, lanes ? values[axis] : load_lanes(to));
      for (unsigned left = negative_lanes(lanes); left != 0; left &= left - 1) {
        const float value = values[axis][__builtin_ctz(left)];
        bent.low[axis] = std::min(bent.low[axis], value);
        bent.high[axis] = std::max(bent.high[axis], value);
      }
    }
  }
}

// `near` meet the tile's box; blades may be pushed beyond it, to any of `all`.
void simulate(LawnState& state, const Lawn& lawn, const WindNow& wind, int index,
              std::span<const Collider> near, std::span<const Collider> all) {
  const LawnTile& tile = lawn.tile[size_t(index)];
  BentTile& bent = state.bent[size_t(index)];
  const size_t size = padded(tile);
  constexpr LaneMask lane{0, 1, 2, 3, 4, 5, 6, 7};
  for (size_t at = 0; at < size; at += lane_count) {
    const int first = tile.begin + int(at);
    BladeShapes shapes = eval_shapes(lawn, state, wind, index, first);
    const LaneMask blades = (lane < tile.count - int(at)) & (shapes.length > 0.0f);
    LaneMask touched{};
    for (const Collider& collider : near) touched |= push_joints(collider, blades, shapes);
    if (!any_lane(touched)) continue;
    const BladeShapes rest = eval_wind_shapes(lawn, first, wind);
    for (int i = 0; i < spring_iterations; i++)
      relax_springs(shapes, rest, touched, state.settings.stiffness);
    lift(tile, touched, shapes);
    push_all(all, touched, shapes);
    if (bent.touched.empty()) {
      bent.since = state.time;
      bent.touched.assign(size, never);
      bent.joint.assign(size * 3 * segments, 0);
      bent.low = tile.low, bent.high = tile.high;
    }
    bent.last_touch = state.time;
    float* const when = &bent.touched[at];
    store_lanes(when, touched ? all_lanes(float(state.time - bent.since)) : load_lanes(when));
    store_shapes(bent, size, at, touched, shapes);
  }
}

// Pairs a tile with a collider whose box meets it.
struct Meeting {
  int tile, collider;
  auto operator<=>(const Meeting&) const = default;
};
std::vector<Meeting> find_meetings(const Lawn& lawn, std::span<const Collider> colliders,
                                   const LawnState& state) {
  std::vector<Meeting> found;
  if (lawn.tile.empty()) return found;
  const auto meets = [](const Collider& c, vec3 low, vec3 high) {
    return all(lessThanEqual(c.low, high)) && all(lessThanEqual(low, c.high));
  };
  for (int i = 0; i < int(colliders.size()); i++) {
    const Collider& c = colliders[size_t(i)];
    const auto tile_of = [&](vec3 p) {
      const vec2 place = (vec2(p.x, p.z) - lawn.low) / lawn.tile_side;
      return ivec2(clamp(floor(place), vec2(0), vec2(lawn.tiles - 1)));
    };
    const ivec2 first = tile_of(c.low - lawn.tallest), last = tile_of(c.high + lawn.tallest);
    for (int row = first.y; row <= last.y; row++)
      for (int column = first.x; column <= last.x; column++) {
        const int index = row * lawn.tiles.x + column;
        const LawnTile& tile = lawn.tile[size_t(index)];
        if (tile.count > 0 && meets(c, tile.low, tile.high)) found.push_back({index, i});
      }
    // Bent blades may lie beyond their tile.
    for (int index : state.active) {
      const BentTile& bent = state.bent[size_t(index)];
      if (!bent.touched.empty() && meets(c, bent.low, bent.high)) found.push_back({index, i});
    }
  }
  std::ranges::sort(found);
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

// Lets go of tiles whose blades have risen; moves the beginning of counts that become long.
void age_tile(BentTile& bent, const LawnState& state) {
  if (bent.touched.empty()) return;
  const double gone = state.time - bent.last_touch;
  if (gone >= double(state.settings.lie) + double(state.settings.rise)) {
    bent = {};
    return;
  }
  const double count = state.time - bent.since;
  if (count < longest_count) return;
  for (float& t : bent.touched) t = float(double(t) - count);
  bent.since = state.time;
}

}  // namespace

LawnState make_lawn_state(const Lawn& lawn, const ResponseSettings& settings) {
  LawnState state;
  const auto at_least = [](float x, float least) { return x > least ? x : least; };
  state.settings.lie = at_least(settings.lie, 0);
  state.settings.rise = at_least(settings.rise, 1e-3f);
  state.settings.settle = at_least(settings.settle, 1e-3f);
  state.settings.stiffness = std::min(at_least(settings.stiffness, 0), 1.0f);
  state.state.resize(lawn.tile.size());
  state.bent.resize(lawn.tile.size());
  return state;
}

BladeShapes eval_shapes(const Lawn& lawn, const LawnState& state, const WindNow& wind, int tile,
                        int first) {
  BladeShapes shapes = eval_wind_shapes(lawn, first, wind);
  const BentTile& bent = state.bent[size_t(tile)];
  if (bent.touched.empty()) return shapes;
  const ResponseSettings& s = state.settings;
  const size_t size = bent.touched.size(), at = size_t(first - lawn.tile[size_t(tile)].begin);
  const Lanes age = float(state.time - bent.since) - load_lanes(&bent.touched[at]);
  const LaneMask is_bent = age < s.lie + s.rise;
  if (!any_lane(is_bent)) return shapes;
  const Lanes left = lanes_max(lanes_min(1.0f - (age - s.lie) / s.rise, all_lanes(1)), Lanes{});
  const Lanes ease = left * left * left;
  shapes.free = is_bent ? 1.0f - ease : shapes.free;
  const Lanes stretched = positive_lanes(1.0f - age / s.settle);
  Lanes3 before = shapes.joint[0], joint = before;  // as they are mixed, and with their length
  for (int k = 1; k < joints; k++) {
    const float* const from = &bent.joint[size_t(3 * (k - 1)) * size + at];
    const Lanes3 lying = {load_lanes(from), load_lanes(from + size), load_lanes(from + 2 * size)};
    const Lanes3 mixed = shapes.joint[k] + (lying - shapes.joint[k]) * ease;
    const Lanes3 line = mixed - before;
    const Lanes length = lanes_sqrt(dot(line, line));
    const LaneMask has = length > 1e-9f;
    const Lanes wanted = shapes.length + (length - shapes.length) * stretched;
    joint = joint + line * (has ? wanted / (has ? length : all_lanes(1)) : all_lanes(1));
    before = mixed;
    shapes.joint[k] = choose(is_bent, joint, shapes.joint[k]);
  }
  return shapes;
}

void step_lawn(LawnState& state, const Lawn& lawn, const Wind& wind, const Walkers& walkers,
               double time) {
  if (!std::isfinite(time)) return;
  if (time < state.time)
    for (int index : state.active) state.bent[size_t(index)] = {};
  state.time = time;
  for (int index : state.active) age_tile(state.bent[size_t(index)], state);

  const std::vector<Collider> colliders = find_colliders(walkers);
  const std::vector<Meeting> meetings = find_meetings(lawn, colliders, state);
  std::vector<size_t> begin;  // a tile's first meeting each, and the end
  for (size_t i = 0; i < meetings.size(); i++)
    if (i == 0 || meetings[i].tile != meetings[i - 1].tile) begin.push_back(i);
  begin.push_back(meetings.size());
  const WindNow now(wind, time);
  parallel_ranges(int(begin.size()) - 1, 4, [&](int first, int last) {
    std::vector<Collider> near;
    for (int i = first; i < last; i++) {
      near.clear();
      for (size_t m = begin[size_t(i)]; m < begin[size_t(i) + 1]; m++)
        near.push_back(colliders[size_t(meetings[m].collider)]);
      simulate(state, lawn, now, meetings[begin[size_t(i)]].tile, near, colliders);
    }
  });

  std::vector<int> active = std::exchange(state.active, {});
  for (int index : active) state.state[size_t(index)] = TileState::idle;
  for (size_t i = 0; i + 1 < begin.size(); i++) {
    const int index = meetings[begin[i]].tile;
    state.state[size_t(index)] = TileState::colliding;
    active.push_back(index);
  }
  std::ranges::sort(active);
  active.erase(std::unique(active.begin(), active.end()), active.end());
  for (int index : active) {
    TileState& tile = state.state[size_t(index)];
    if (tile == TileState::idle && !state.bent[size_t(index)].touched.empty())
      tile = TileState::recovering;
    if (tile != TileState::idle) state.active.push_back(index);
  }
}

}  // namespace wellspring::lawn
