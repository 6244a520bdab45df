// SPDX-License-Identifier: Apache-2.0
#include "picture/cells/pixel_light.h"

#include <bit>
#include <utility>

#include "cache/packing.h"

namespace wellspring::picture {

LaneMask find_flat(const PixelRays& rays, const Cells& cells, int bx, int by) {
  constexpr float same_direction = 0.998f, same_depth = 0.1f * plane_tolerance;
  auto at = [&](const auto& plane, size_t i) { return load_lanes(plane.data() + i); };
  size_t a = size_t(cells.index(bx - 1, by - 1));
  LaneBits object = load_lanes<LaneBits>(&cells.object[a]);
  Lanes nx = at(cells.normal[0], a), ny = at(cells.normal[1], a), nz = at(cells.normal[2], a),
        px = at(cells.plane[0], a), py = at(cells.plane[1], a), pz = at(cells.plane[2], a);
  Lanes left = rays.x((float(bx) - 0.5f) * cell_size) +
               float(cell_size) * rays.inverse_focal * Lanes{0, 1, 2, 3, 4, 5, 6, 7};
  LaneMask flat = object != no_object;
  for (int k = 1; k < 4; k++) {
    size_t c = a + size_t(k & 1) + size_t(k >> 1) * size_t(cells.stride);
    Lanes x = left + float(k & 1) * float(cell_size) * rays.inverse_focal;
    float y = rays.y((float(by + (k >> 1)) - 0.5f) * cell_size);
    Lanes cosine =
        nx * at(cells.normal[0], c) + ny * at(cells.normal[1], c) + nz * at(cells.normal[2], c);
    Lanes off = at(cells.depth, c) * (px * x + py * y + pz) - 1.0f;
    flat &= (object == load_lanes<LaneBits>(&cells.object[c])) & (cosine >= same_direction) &
            (lanes_abs(off) < same_depth);
  }
  return flat;
}

namespace {

constexpr int rings = 5;
constexpr int cell_rings = 16;
constexpr int enough_points = 6;  // points found by a ring after which no other is needed
// Squared cosines: below the first a surface is another one, from the second on it certainly is the
// same.
constexpr float turned_away = 0.49f, same_direction = 0.75f;
constexpr float reach2 = (rings + 0.5f) * (rings + 0.5f);
constexpr float least_fade = 1e-3f;  // weight that is left, should no nearer point know the light

// Returns a weight for squared distances in pixels. Without it each point would light a square as
// large as the rings.
Lanes fade_out(const Lanes& distance2) {
  Lanes left = positive_lanes(1.0f - distance2 * (1 / reach2));
  return lanes_max(left * left, all_lanes(least_fade));
}

struct Sum {
  Lanes samples{}, squares{}, deviation{};
  Lanes reached{};  // samples as if none of them were far off
  Color smooth, rest;
};

// Holds points around that show the place's object; eight of them are weighed at a time.
struct Points {
  int count = 0;
  uint32_t words[surface_planes][lane_count] = {};  // lanes that were never filled are read, too
  float x[lane_count] = {}, y[lane_count] = {};
};

// Returns how much the points' surfaces are the place's; 0: other ones. The weight ends gradually,
// as places side by side differ a little.
Lanes alike(const View& view, const PixelRays& rays, const SeenPlace& place, const Points& points) {
  Lanes nx, ny, nz;
  unpack_octahedron(load_lanes<LaneBits>(points.words[plane_more]) & 0xffffu, nx, ny, nz);
  vec3 n = place.normal;
  Lanes facing = nx * n.x + ny * n.y + nz * n.z;
  float length2 = dot(n, n);
  Lanes cosine2 = facing * facing / (length2 * (nx * nx + ny * ny + nz * nz));
  Lanes same = positive_lanes(cosine2 - turned_away) * (1 / (same_direction - turned_away));
  same = keep_lanes(facing > 0.0f, lanes_min(same, all_lanes(1)));
  Lanes depth = lanes_as<Lanes>(load_lanes<LaneBits>(points.words[plane_depth]));
  Lanes across = (load_lanes(points.x) + 0.5f - rays.axis.x) * rays.inverse_focal,
        up = (rays.axis.y - load_lanes(points.y) - 0.5f) * rays.inverse_focal;
  Lanes off = (place.depth * place.ray.x - depth * across) * dot(view.right, n) +
              (place.depth * place.ray.y - depth * up) * dot(view.up, n) +
              (place.depth - depth) * dot(view.forward, n);
  off *= 1 / (plane_tolerance * place.depth);
  off *= off * (1 / length2);
  return same * positive_lanes(1.0f - off);
}

// Adds the points to the sum and drops them. Returns how many of them count.
int add_points(const View& view, const PixelRays& rays, const SeenPlace& place, Points& points,
               Sum& sum) {
  constexpr Lanes lane{0, 1, 2, 3, 4, 5, 6, 7};
  LaneMask there = lane < float(std::exchange(points.count, 0));
  LaneBits more = load_lanes<LaneBits>(points.words[plane_more]);
  Lanes dx = load_lanes(points.x) - float(place.x), dy = load_lanes(points.y) - float(place.y);
  Lanes distance2 = dx * dx + dy * dy, near = 1.0f / (0.5f + distance2);
  Lanes weight = near * fade_out(distance2);
  // A mirror image has neither the place nor the normal of its mirror.
  if (place.albedo != vec3(0)) weight *= alike(view, rays, place, points);
  weight = keep_lanes(there, weight);
  Lanes samples = keep_lanes(there, to_float((more >> 16) & 255u)), share = weight * samples;
  sum.reached += keep_lanes(weight > 0.0f, near * samples);
  sum.samples += share, sum.squares += share * weight;
  sum.deviation += share * keep_lanes(there, unpack_deviation(more >> 24));
  Color light, theirs;
  unpack_rgb9e5(load_lanes<LaneBits>(points.words[plane_smooth]), light.r, light.g, light.b);
  add(sum.smooth, share, light.r, light.g, light.b);
  unpack_rgb9e5(load_lanes<LaneBits>(points.words[plane_rest]), light.r, light.g, light.b);
  unpack_albedo(load_lanes<LaneBits>(points.words[plane_albedo]), theirs.r, theirs.g, theirs.b);
  add(sum.rest, share, light.r * rest_ratio(all_lanes(place.albedo.x), theirs.r),
      light.g * rest_ratio(all_lanes(place.albedo.y), theirs.g),
      light.b * rest_ratio(all_lanes(place.albedo.z), theirs.b));
  return std::popcount(negative_lanes(weight > 0.0f));
}

// Returns a bit k for each column x + k of row y, within the picture, that has samples of the
// object.
constexpr int window = 2 * rings + 1;
static_assert(window <= 2 * lane_count);
unsigned find_known(const Frame& light, uint32_t object, int x, int y) {
  if (y < 0 || y >= light.height) return 0;
  size_t row = size_t(y) * size_t(light.width);
  unsigned known = 0;
  if (x >= 0 && row + size_t(x + 2 * lane_count) <= light.object.size()) {
    for (int half = 0; half < 2; half++) {
      size_t at = row + size_t(x + half * lane_count);
      LaneBits more = load_lanes<LaneBits>(&light.confidence[at]);
      known |= negative_lanes((load_lanes<LaneBits>(&light.object[at]) == object) &
                              ((more & 0xff0000u) != 0u))
               << half * lane_count;
    }
    return known & ((1u << std::min(window, light.width - x)) - 1);
  }
  for (int k = std::max(-x, 0); k < std::min(window, light.width - x); k++) {
    size_t at = row + size_t(x + k);
    uint32_t more = std::bit_cast<uint32_t>(light.confidence[at]);
    known |= unsigned(light.object[at] == object && (more & 0xff0000u) != 0) << k;
  }
  return known;
}

}  // namespace

NearbyLight find_light_nearby(const View& view, const PixelRays& rays, const Frame& light,
                              const SeenPlace& place) {
  Sum sum;
  Points points;
  unsigned known[window];
  int found_points = 0;
  for (int ring = 0; ring <= rings && found_points < enough_points; ring++) {
    for (int dy = -ring; dy <= ring; dy++) {
      unsigned& row = known[rings + dy];
      bool whole = dy == -ring || dy == ring;
      if (whole) row = find_known(light, place.object, place.x - rings, place.y + dy);
      unsigned first = 1u << (rings - ring), last = 1u << (rings + ring),
               here = row & (whole ? 2 * last - first : first | last);
      for (; here != 0; here &= here - 1) {
        int x = place.x - rings + std::countr_zero(here), y = place.y + dy, k = points.count++;
        uint32_t words[surface_planes];
        read_packed(light, x, y, words);
        for (int p = 0; p < surface_planes; p++) points.words[p][k] = words[p];
        points.x[k] = float(x), points.y[k] = float(y);
        if (points.count == lane_count) found_points += add_points(view, rays, place, points, sum);
      }
    }
    if (points.count > 0) found_points += add_points(view, rays, place, points, sum);
  }
  NearbyLight found;
  float samples = lanes_sum(sum.samples);
  if (samples <= 0) return found;
  auto mean = [&](const Color& c) {
    return vec3(lanes_sum(c.r), lanes_sum(c.g), lanes_sum(c.b)) / samples;
  };
  found.smooth = mean(sum.smooth);
  found.rest = mean(sum.rest);
  found.deviation = lanes_sum(sum.deviation) / samples;
  found.samples = samples * samples / lanes_sum(sum.squares) * (samples / lanes_sum(sum.reached));
  return found;
}

NearbyLight find_light_far(const Cells& cells, const SeenPlace& place) {
  const int cx = std::min(place.x / cell_size, cells.width - 1),
            cy = std::min(place.y / cell_size, cells.height - 1);
  NearbyLight found;
  auto add = [&](int x, int y) {
    const size_t i = size_t(cells.index(x, y));
    if (cells.object[i] != place.object || !(cells.samples[i] > 0)) return;
    auto at = [i](const std::array<std::span<float>, 3>& of) {
      return vec3(of[0][i], of[1][i], of[2][i]);
    };
    const float samples = cells.samples[i];
    found.smooth += samples * at(cells.smooth);
    found.rest += samples * at(cells.rest) * rest_ratio(place.albedo, at(cells.albedo));
    found.samples += samples;
  };
  add(cx, cy);
  for (int ring = 1; ring <= cell_rings && found.samples == 0; ring++)
    for (int y : {cy - ring, cy, cy + ring})
      for (int x : {cx - ring, cx, cx + ring})
        if (x >= 0 && x < cells.width && y >= 0 && y < cells.height && (x != cx || y != cy))
          add(x, y);
  if (found.samples == 0) return found;
  found.smooth /= found.samples, found.rest /= found.samples;
  return found;
}

}  // namespace wellspring::picture
