// SPDX-License-Identifier: Apache-2.0
// Computes the light of eight places in the picture at a time: their own samples, blended with the
// light of the four cells around on the same surface.
#pragma once
#include <algorithm>
#include <cstring>
#include <vector>

#include "cache/packing.h"
#include "frame/frame.h"
#include "picture/cells/cells.h"
#include "world/raster/raster.h"
#include "world/view.h"

namespace wellspring::picture {

// Share of the depth; a surface farther off is another one.
inline constexpr float plane_tolerance = 0.02f;

struct Color {
  Lanes r{}, g{}, b{};
};
inline Lanes luminance(const Color& c) { return cache::luminance(c.r, c.g, c.b); }
template <class T>
void add(Color& sum, const Lanes& weight, const T& r, const T& g, const T& b) {
  sum.r += weight * r, sum.g += weight * g, sum.b += weight * b;
}
inline Color weighted_sum(const Color& a, const Lanes& kept, const Color& b, const Lanes& other) {
  return {kept * a.r + other * b.r, kept * a.g + other * b.g, kept * a.b + other * b.b};
}

// Rest holds light of lamps with the reflectance in it: this ratio turns the rest that was seen
// under the reflectance `theirs` into that under `own`.
inline constexpr float dark_reflectance = 0.05f, most_brighter = 4;
inline Lanes rest_ratio(const Lanes& own, const Lanes& theirs) {
  return lanes_min((own + dark_reflectance) / (theirs + dark_reflectance),
                   all_lanes(most_brighter));
}
inline vec3 rest_ratio(vec3 own, vec3 theirs) {
  return min((own + dark_reflectance) / (theirs + dark_reflectance), vec3(most_brighter));
}

// Holds eight pixels, or places in them.
struct Pixels {
  LaneBits object;
  Lanes x, y, depth, samples;
  Lanes nx, ny, nz, normal2;  // not normalised; its length squared
  Color smooth, rest;
  Lanes deviation;  // standard deviation of one sample's rest
};

// Holds what pixels need of a cell, in one place: the same cell for all (float, uint32_t), or one
// cell for each (Lanes, LaneBits).
template <class Number, class Id>
struct CellLightOf {
  Number smooth[3], rest[3], prior_weight, detail, noise;
  Number normal[3], plane[3];
  Id object;
};
using CellLight = CellLightOf<float, uint32_t>;

// Returns the index of cell (x, y), or of the nearest one if there is none.
inline size_t nearest_cell(const Cells& cells, int x, int y) {
  return size_t(cells.index(std::clamp(x, 0, cells.width - 1), std::clamp(y, 0, cells.height - 1)));
}
inline void read_cell(const Cells& cells, int x, int y, CellLight& c) {
  size_t i = nearest_cell(cells, x, y);
  for (size_t k = 0; k < 3; k++) {
    c.smooth[k] = cells.smooth[k][i];
    c.rest[k] = cells.rest[k][i];
    c.normal[k] = cells.normal[k][i];
    c.plane[k] = cells.plane[k][i];
  }
  c.prior_weight = cells.prior_weight[i];
  c.detail = cells.rest_sum2[i];
  c.noise = cells.rest_noise[i];
  c.object = cells.object[i];
}

// Finds which of the eight blocks from bx on lie between four cells in one plane: a pixel that
// agrees with one of those agrees with all.
LaneMask find_flat(const PixelRays& rays, const Cells& cells, int bx, int by);

// Holds the light of the four cells at each pixel, as far as they lie on the same surface.
struct Surroundings {
  Color smooth, rest;
  Lanes prior_weight{}, detail{}, noise{};
  Color albedo;       // reflectance, if the cells have it
  LaneMask lonely{};  // no cell lies on this surface
  Lanes known{};      // 0 to 1: how surely some cell lies on this surface
};
// A cell with the reflectance under which its rest was seen.
struct PaintedCell : CellLight {
  float albedo[3];
};
template <class Cell>
[[gnu::always_inline]] inline void add(Surroundings& sum, const Lanes& weight, const Cell& c) {
  add(sum.smooth, weight, c.smooth[0], c.smooth[1], c.smooth[2]);
  add(sum.rest, weight, c.rest[0], c.rest[1], c.rest[2]);
  sum.prior_weight += weight * c.prior_weight;
  sum.detail += weight * c.detail;
  sum.noise += weight * c.noise;
  if constexpr (requires { c.albedo; })
    add(sum.albedo, weight, c.albedo[0], c.albedo[1], c.albedo[2]);
}

// Agreement of the cells around that makes Surroundings::known 1.
inline constexpr float enough_alike = 0.01f;
inline Lanes known_by(const Lanes& alike) {
  return lanes_min(alike * (1 / enough_alike), all_lanes(1));
}

// Returns how much a cell's surface is that of the pixels, 0 to 1.
template <class Cell>
Lanes alike(const Cell& c, const Pixels& p, const Lanes& inverse_normal2) {
  Lanes facing = positive_lanes(c.normal[0] * p.nx + c.normal[1] * p.ny + c.normal[2] * p.nz);
  facing *= facing * inverse_normal2;  // the cosine's second, then its eighth power
  facing *= facing, facing *= facing;
  Lanes off = p.depth * (c.plane[0] * p.x + c.plane[1] * p.y + c.plane[2]);
  off = (off - 1.0f) * (1 / plane_tolerance);
  return keep_lanes(p.object == c.object, facing / (1.0f + off * off));
}

// Sums the corners' light at the pixels. `weights`: the share of each corner at a pixel's place,
// adding up to one. `flat`: all four lie in one plane, and so a pixel that agrees with one agrees
// with all.
template <class Cell>
Surroundings look_around(const Cell* const* corners, bool flat, const Lanes* weights,
                         const Pixels& p) {
  constexpr float least = 1e-4f;
  Surroundings s;
  Lanes inverse_normal2 = 1.0f / p.normal2;
  if (flat) {
    for (int k = 0; k < 4; k++) add(s, weights[k], *corners[k]);
    Lanes common = alike(*corners[0], p, inverse_normal2);
    s.lonely = common <= least, s.known = known_by(common);
    return s;
  }
  Lanes sum{};
  for (int k = 0; k < 4; k++) {
    Lanes weight = weights[k] * alike(*corners[k], p, inverse_normal2);
    add(s, weight, *corners[k]);
    sum += weight;
  }
  s.lonely = sum <= least, s.known = known_by(sum);
  Lanes share = 1.0f / lanes_max(sum, all_lanes(least));
  for (Color* c : {&s.smooth, &s.rest, &s.albedo}) c->r *= share, c->g *= share, c->b *= share;
  s.prior_weight *= share, s.detail *= share, s.noise *= share;
  return s;
}

// Does the same if only some of the pixels lie between cells in one plane.
template <class Cell>
Surroundings look_around(const Cell* const* corners, const LaneMask& flat, const Lanes* weights,
                         const Pixels& p) {
  if (!any_lane(~flat)) return look_around(corners, true, weights, p);
  if (!any_lane(flat)) return look_around(corners, false, weights, p);
  constexpr float least = 1e-4f;
  Surroundings s;
  Lanes inverse_normal2 = 1.0f / p.normal2, sum{};
  for (int k = 0; k < 4; k++) {
    Lanes common = alike(*corners[k], p, inverse_normal2);
    if (k == 0) s.lonely = flat & (common <= least), s.known = known_by(common);
    Lanes weight = flat ? weights[k] : weights[k] * common;
    add(s, weight, *corners[k]);
    sum += weight;
  }
  s.lonely |= ~flat & (sum <= least), s.known = flat ? s.known : known_by(sum);
  Lanes share = 1.0f / lanes_max(flat ? all_lanes(1) : sum, all_lanes(least));
  for (Color* c : {&s.smooth, &s.rest, &s.albedo}) c->r *= share, c->g *= share, c->b *= share;
  s.prior_weight *= share, s.detail *= share, s.noise *= share;
  return s;
}

// Returns the share of `own` light that is left if more than `most` would be too much.
inline Lanes cut_to(const Lanes& own, const Lanes& most) {
  return most / (lanes_max(own, most) + 1e-12f);
}

// Blends the pixels' own light with that of their surroundings. Smooth light: the more samples a
// pixel has, the more its own light counts. Rest: the more of the variation around is detail rather
// than noise, the more its own light counts (Lee 1980, the local Wiener filter); `prior_variance`:
// with as many samples the own rest counts for half of that. A few samples may be alike by chance,
// most of all if only now and then one finds a light: the noise around counts as `prior_samples` of
// them.
inline constexpr float prior_samples = 4;
inline void blend_light(const Surroundings& s, Pixels& p, const Lanes& prior_variance = Lanes{}) {
  const LaneMask& lonely = s.lonely;
  Lanes alone = keep_lanes(lonely, all_lanes(1));
  // A lone bright sample may exceed its surroundings only as far as more samples confirm it.
  Lanes own_light = luminance(p.smooth);
  Lanes most = luminance(s.smooth) * (2.0f + 0.25f * p.samples) + alone * own_light;
  Lanes own = p.samples / (p.samples + s.prior_weight + 1e-6f);
  own = lonely ? all_lanes(1) : own;
  p.smooth = weighted_sum(p.smooth, own * cut_to(own_light, most), s.smooth, 1.0f - own);

  // The same for the rest, unless it is known to repeat itself: then it is a highlight, not a lucky
  // path.
  LaneMask known = p.samples > 1.0f;
  Lanes own_rest = luminance(p.rest);
  Lanes counts = known ? p.samples : Lanes{};
  Lanes noise =
      (p.deviation * p.deviation * counts + s.noise * prior_samples) / (counts + prior_samples);
  Lanes quiet = keep_lanes(known & (noise <= 0.01f * own_rest * own_rest), all_lanes(1));
  Lanes most_rest = luminance(s.rest) * (3.0f + p.samples) + 1e-4f + (quiet + alone) * own_rest;
  Lanes variance = noise / lanes_max(p.samples, all_lanes(1));
  Lanes detail = s.detail + 1e-9f, own_detail = detail / (detail + variance);
  own_detail *= p.samples / (p.samples + prior_variance + 1e-6f);
  own_detail = lonely ? all_lanes(1) : own_detail;
  Lanes kept = own_detail * cut_to(own_rest, most_rest);
  p.rest = weighted_sum(p.rest, kept, s.rest, 1.0f - own_detail);
}

// Reads rows of cells (picture/cells/cells.h) as groups of pixels need them, for
// picture/compose_drawn.cpp.

// Pixels are lit in groups that lie between two columns of cell centres: four pixels, which are
// packed together, and four cells around. Groups begin half a cell before a tile, and two lie side
// by side in the lanes.
constexpr int half_cell = cell_size / 2;
constexpr int cells_together = lane_count / cell_size;
static_assert(cell_size == packed_four && cells_together == 2);

// Holds two cells side by side: the left one in the lanes of the left group of pixels, the right
// one in those of the right group.
struct WideCell : CellLightOf<Lanes, LaneBits> {
  Lanes albedo[3];
};
inline void spread_cells(const PaintedCell& left, const PaintedCell& right, WideCell& to) {
  constexpr size_t count = sizeof(PaintedCell) / sizeof(float);
  static_assert(sizeof(WideCell) == count * sizeof(Lanes));
  float a[count], b[count];
  std::memcpy(a, &left, sizeof a), std::memcpy(b, &right, sizeof b);
  Lanes both[count];
  for (size_t i = 0; i < count; i++)
    both[i] = Lanes{a[i], a[i], a[i], a[i], b[i], b[i], b[i], b[i]};
  std::memcpy(static_cast<void*>(&to), both, sizeof both);
}

// Holds two rows of cells around a tile's blocks, each cell beside the one that the next group
// needs.
struct CellRows {
  static constexpr int most = RasterRun::most / cell_size + 3;
  uint64_t picture = 0;
  int first = 0, row = 0, count = 0;
  int above = 0;  // index of the upper row
  WideCell cell[2][most];
  // Lanes of each group and those beside it that lie between cells in one plane.
  LaneMask flat[most];

  const WideCell& at(int r, int k) const { return cell[above ^ r][k]; }
  void read(const PixelRays& rays, const Cells& cells, uint64_t of, int x, int y, int columns);

 private:
  void read_row(const Cells& cells, int y, WideCell* to) const;
};

inline void CellRows::read_row(const Cells& cells, int y, WideCell* to) const {
  PaintedCell before{}, here;
  for (int k = 0; k < count; k++, before = here) {
    read_cell(cells, first + k, y, here);
    size_t i = nearest_cell(cells, first + k, y);
    for (size_t n = 0; n < 3; n++) here.albedo[n] = cells.albedo[n][i];
    if (k > 0) spread_cells(before, here, to[k - 1]);
  }
}

inline void CellRows::read(const PixelRays& rays, const Cells& cells, uint64_t of, int x, int y,
                           int columns) {
  bool below = picture == of && first == x && row + 1 == y && count == columns;
  picture = of, first = x, row = y, count = columns;
  above = below ? above ^ 1 : 0;
  if (!below) read_row(cells, y, cell[above]);
  read_row(cells, y + 1, cell[above ^ 1]);
  int32_t one_plane[most + 2 * lane_count] = {};  // one value a group
  for (int g = 0; g < count; g += lane_count)
    store_lanes(one_plane + g, find_flat(rays, cells, first + 1 + g, row + 1));
  for (int g = 0; g < count; g++)
    for (int k = 0; k < lane_count; k++) flat[g][k] = one_plane[g + k / cell_size];
}

// Finds the light of a place on a surface so narrow that no cell stands for it, from the points
// around that lie on the same surface.

// A place that a picture shows.
struct SeenPlace {
  int x = 0, y = 0;           // pixel of the light that it falls in
  vec2 ray{0};                // ray to it, in view coordinates (right, up; forward is 1)
  float depth = 0;            // metres along the viewing axis
  vec3 normal{0}, albedo{0};  // the normal need not be unit
  uint32_t object = 0;
};
struct NearbyLight {
  vec3 smooth{0}, rest{0};  // rest for the place's own reflectance
  // Samples behind that mean (Kish: as many as if they weighed alike), the fewer the farther off
  // they are or the less their surface is the place's; 0: none.
  float samples = 0;
  float deviation = 0;
};

// Looks at the pixels around the place's own in rings, until enough of them know its light.
// `light`: the packed planes of a picture with these `rays`.
NearbyLight find_light_nearby(const View& view, const PixelRays& rays, const Frame& light,
                              const SeenPlace& place);
// Returns the light of the nearest cells in eight directions that know the place's object,
// whichever way their surfaces face, within 64 pixels: for places whose light no pixel around
// knows. `samples`: those of the cells.
NearbyLight find_light_far(const Cells& cells, const SeenPlace& place);

}  // namespace wellspring::picture
