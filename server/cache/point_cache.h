// SPDX-License-Identifier: Apache-2.0
// The points of a render cache (Walter 1999, section 3 and figure 4) hold what was seen, where, and
// how long ago. The capacity is fixed. Data that is walked every frame lies in arrays of its own;
// data that is looked up only for points that show (PointColor) lies together, one cache line fetch
// a point. A point takes 37 bytes.
#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "cache/point_image.h"
#include "light/sample.h"
#include "world/world.h"

namespace wellspring::cache {

enum PointFlags : uint8_t {
  point_used = 1,
  point_infinite = 2,  // position is a unit direction
  point_specular = 4,
  point_moving = 8,       // has an anchor
  point_visible = 16,     // shows in the current projection
  point_verified = 32,    // was sampled from exactly the current view: surely not hidden
  point_relit = 64,       // the light has changed since it was sampled: see invalidate_light()
  point_reference = 128,  // began with a sample of the reference: see RenderCache::set_reference()
};

struct PointColor {
  uint32_t albedo = 0;  // pack_albedo
  uint32_t smooth = 0;  // pack_rgb9e5, mean over `count` samples
  uint32_t rest = 0;    // pack_rgb9e5, mean likewise; without Sample::glow
  uint32_t object = 0;
  uint16_t normal = 0;  // as PointCache::normal
  // Low 2 bits: successive samples that differ from a well-known mean; the others, as
  // pack_relative: the standard deviation of one sample's `smooth` luminance over its mean.
  uint8_t doubts = 0;
  // pack_deviation: the standard deviation of one sample's `rest` luminance. After a single sample:
  // 0 if unknown, sure_noise if the technique was sure (sample_sure).
  uint8_t noise = 0;
};
inline constexpr uint8_t sure_noise = 1;  // smallest code above 0
// The noise code of a point whose light was forgotten. Its count is 0 while it shows its old light,
// 1 when it is lent that of a newer point; see lend_light().
inline constexpr uint8_t forgotten_noise = 2;
static_assert(sizeof(PointColor) == 20);

// A point on a moving mesh, to be found again in later ticks.
struct Anchor {
  uint32_t point = 0, instance = 0, triangle = 0;
  uint16_t u = 0, v = 0;  // barycentric weights, 65535 = 1
};

// Points that replacement chooses from (paper, section 4.3).
inline constexpr uint32_t group_size = 8;
inline constexpr uint8_t evicted_age = 255;  // age of points that are never shown again
inline constexpr int oldest_age = 254;       // oldest age of points that are shown
inline constexpr int max_capacity = (1 << 24) - 8;

struct PointCache {
  BigVector<float> x, y, z;
  std::vector<uint16_t> normal;  // pack_normal
  std::vector<uint8_t> flags;
  std::vector<uint8_t> age;    // 0 is new; see age_points()
  std::vector<uint8_t> count;  // samples in the means, at most 255
  BigVector<PointColor> color;
  std::vector<Anchor> anchors;
  std::vector<uint64_t> seen;  // scratch of move_anchored_points(): one bit a point
  uint32_t next_group = 0;     // round robin of replacement
  float age_carry = 0;         // fraction of an age step not yet applied
  int capacity() const { return int(x.size()); }
};

// Keeps the points that fit into `capacity` (rounded up to whole groups, at most max_capacity).
void resize_points(PointCache& points, int capacity);
void clear_points(PointCache& points);
// Advances ages by one frame, so that a point reaches about 128 by the time `new_points` a frame
// have replaced all (Walter 2002); specular and moving points age three times as fast, unseen ones
// twice. Unseen points that reach 255 are evicted; seen ones stop at `oldest_age`.
void age_points(PointCache& points, float new_points);
// Forgets the light of a point, as it has changed or seems to: its light does not count if any
// newer light is around, and its next sample replaces it. The point grows older by `ageing`, so
// that it is asked for the sooner the surer the change is; with `oldest_age` among the first.
void invalidate_light_of(PointCache& points, uint32_t i, int ageing);
// Forgets the light of the points for which `forgotten` returns true; it is called on many threads.
// They show `kept` (1 unless changed) times their old light plus the light `added`.
using Forgotten = std::function<bool(uint32_t point, vec3& kept, vec3& added)>;
void invalidate_light(PointCache& points, const Forgotten& forgotten);
// Finds where a place on a mesh is now, and its normal on the side that `normal` faced; both stay
// as they are if the world has no such triangle.
void find_on_mesh(const World& world, uint32_t instance, uint32_t triangle, vec2 barycentric,
                  vec3& place, vec3& normal);
// Moves points with anchors with their triangles; anchors of overwritten points are dropped.
void move_anchored_points(PointCache& points, const World& world);
// Gives points of repainted instances the reflectance that their surface has now, and forgets their
// light. Reaches points with anchors, so call it after move_anchored_points(). `repainted`: one
// value for each of the world's instances. Returns whether any point was found.
bool invalidate_paint(PointCache& points, const World& world, const std::vector<char>& repainted);
// Returns how many anchors a cache of this capacity may hold; moving points beyond are forgotten
// after one frame.
int max_anchors(int capacity);
size_t points_bytes(const PointCache& points);

inline bool is_alive(const PointCache& points, uint32_t i) {
  return (points.flags[i] & point_used) && points.age[i] != evicted_age;
}

}  // namespace wellspring::cache
