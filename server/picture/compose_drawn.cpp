// SPDX-License-Identifier: Apache-2.0
#include "picture/compose_drawn.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "light/kept/skin/skin_light.h"
#include "light/sample/illumination_map.h"
#include "picture/drawn_planes.h"
#include "picture/drawn_run.h"
#include "picture/laid_view.h"
#include "picture/cells/pixel_light.h"
#include "picture/soften_edges.h"

namespace wellspring::picture {
namespace {

constexpr Lanes lane{0, 1, 2, 3, 4, 5, 6, 7};
// Most points of a moving picture hold one sample or two, and nobody knows whether their rest is a
// shadow's edge or chance.
constexpr float moving_prior_variance = 3;
// Guessed share of the light at which prior variance begins at rest.
constexpr float still_told = 0.4f;
// Prior variances that smooth light counts as prior weight: its chance is larger.
constexpr float smooth_prior_variances = 4;
Lanes under(const Lanes& light, const Lanes& albedo, const Lanes& theirs) {
  return light * rest_ratio(albedo, theirs);
}

struct Drawn {
  Pixels pixels;
  Color albedo;
  Color unit{all_lanes(1), all_lanes(1), all_lanes(1)};  // Sample::known
  LaneMask mapped{};                                     // pixels whose unit a map holds
  Lanes raised{};                                        // Sample::raised
};

// Lights the pixels of these lanes as their map says.
void light_as_mapped(const LaneMask& which, Pixels& p) {
  for (Lanes* channel : {&p.smooth.r, &p.smooth.g, &p.smooth.b})
    *channel = which ? all_lanes(1) : *channel;
}

// Takes the pixels' own light, as far as their light pixel's point lies on the same surface.
void take_own(const View& view, const PixelRays& rays, const OwnLight& own, float light_x,
              float light_y, Drawn& d) {
  Pixels& p = d.pixels;
  LaneBits more = own.plane[plane_more];
  Lanes samples = to_float((more >> 16) & 255u);
  auto along = [&](vec3 axis) { return p.nx * axis.x + p.ny * axis.y + p.nz * axis.z; };
  Lanes depth = lanes_as<Lanes>(own.plane[plane_depth]);
  Lanes lx = light_x + rays.inverse_focal * lane;
  Lanes off = along(view.right) * (p.depth * p.x - depth * lx) +
              along(view.up) * (p.depth * p.y - depth * light_y) +
              along(view.forward) * (p.depth - depth);
  Lanes nx, ny, nz;
  unpack_octahedron(more & 0xffffu, nx, ny, nz);
  Lanes facing = p.nx * nx + p.ny * ny + p.nz * nz;
  LaneMask near = off * off <= plane_tolerance * plane_tolerance * p.depth * p.depth * p.normal2;
  // The point of a mirror (no albedo) lies where the mirror image does.
  near |= d.albedo.r + d.albedo.g + d.albedo.b == 0.0f;
  LaneMask alike =
      (facing > 0.0f) & (facing * facing > 0.5f * p.normal2 * (nx * nx + ny * ny + nz * nz));
  LaneMask same = (p.object == own.plane[plane_object]) & (samples > 0.0f) & near & alike;
  // At infinity there are no planes.
  LaneMask far = p.depth >= 0.5f * infinite_depth;
  same |= far & (samples > 0.0f) & (depth >= 0.5f * infinite_depth);
  p.samples = keep_lanes(same, samples);
  p.deviation = keep_lanes(same, unpack_deviation(more >> 24));
  Color light, theirs;
  unpack_rgb9e5(own.plane[plane_smooth], light.r, light.g, light.b);
  p.smooth = {keep_lanes(same, light.r), keep_lanes(same, light.g), keep_lanes(same, light.b)};
  unpack_rgb9e5(own.plane[plane_rest], light.r, light.g, light.b);
  unpack_albedo(own.plane[plane_albedo], theirs.r, theirs.g, theirs.b);
  p.rest = {keep_lanes(same, under(light.r, d.albedo.r, theirs.r)),
            keep_lanes(same, under(light.g, d.albedo.g, theirs.g)),
            keep_lanes(same, under(light.b, d.albedo.b, theirs.b))};
}

// Blends in the light around, scaled to the pixels' reflectance: the light of a lamp does not end
// where a picture on the wall does.
void light_as(const Surroundings& around, const Lanes& prior_variances, Drawn& d) {
  Surroundings s = around;
  s.rest = {under(s.rest.r, d.albedo.r, s.albedo.r), under(s.rest.g, d.albedo.g, s.albedo.g),
            under(s.rest.b, d.albedo.b, s.albedo.b)};
  blend_light(s, d.pixels, prior_variances);
}

// Lights eight pixels. `asked`: lanes that matter.
template <class FindNearby>
void light_group(const WideCell* const* corners, const LaneMask& flat, const Lanes* weights,
                 float prior_variance, const LaneMask& asked, const FindNearby& find_nearby,
                 Drawn& d) {
  Pixels& p = d.pixels;
  Surroundings around = look_around(corners, flat, weights, p);
  // If no point lies on the surface, and a map knows its light, there is nothing to search for.
  const LaneMask untold = d.mapped & around.lonely & (p.samples <= 0.0f),
                 unsure = asked & (around.known < 1.0f) & ~untold;
  const Lanes known = unsure ? (around.lonely ? Lanes{} : around.known) : all_lanes(1);
  around.lonely = LaneMask{};
  Lanes prior_variances = all_lanes(prior_variance);
  around.prior_weight = lanes_max(around.prior_weight, smooth_prior_variances * prior_variances);
  Drawn thin = d;
  light_as(around, prior_variances, d);
  if (any_lane(unsure)) {
    // Narrow things are lit by points of their own, found around. Between them and others light
    // changes gradually.
    find_nearby(unsure, thin);
    around.lonely = unsure;
    light_as(around, prior_variances, thin);
    const Pixels& q = thin.pixels;
    // The map's light counts as far as no point of the surface says otherwise.
    light_as_mapped(d.mapped & (q.samples <= 0.0f), thin.pixels);
    p.smooth = weighted_sum(p.smooth, known, q.smooth, 1.0f - known);
    p.rest = weighted_sum(p.rest, known, q.rest, 1.0f - known);
    p.samples = known > 0.0f ? p.samples : q.samples;
  }
  light_as_mapped(untold, p);
  for (Lanes* channel : {&p.rest.r, &p.rest.g, &p.rest.b}) *channel = keep_lanes(~untold, *channel);
}

// Holds all that pixels are lit by, and the place in them at which they are seen.
struct Composer {
  const View& view;
  const Cells& cells;
  bool known;
  const Frame& light;
  PixelRays rays;
  vec2 offset{0.5f};
  float prior_variance = moving_prior_variance;
  KeptLight kept = {};
  bool passing = false;  // the picture is soon replaced: maps light what they can alone
  Shade shade = {};

  // Returns the light of surfaces of which nothing is known.
  vec3 usual_light() const { return vec3(kept.maps ? kept.maps->usual : 0); }
  // Returns the number of parts of eight lanes each.
  static int parts_of(const VisibleRun& run) {
    return (run.count + half_cell + lane_count - 1) / lane_count;
  }
  const CellRows& rows_around(const VisibleRun& run) const;
  void light_thin(const LaneMask& lonely, int lx, int ly, Drawn& d) const;
  void light_run(const RunPixels& p, const VisibleRun& run, const CellRows* read,
                 const RunGlow& emitting, int n, LanePart part, Drawn& d) const;
  Shown light_part(const VisibleRun& run, const RunPixels& p, const RunGlow& emitting,
                   const RunMoving& moving, const RunMapped& mapped, const RunDynamic& dynamic,
                   const CellRows* rows, int n, LanePart part) const;
};

const CellRows& Composer::rows_around(const VisibleRun& run) const {
  thread_local CellRows rows;
  int by = (run.y + half_cell) / cell_size, bx = run.x / cell_size;  // the lower right cell
  int count = parts_of(run) * cells_together + 1;
  if (rows.picture != run.picture || rows.first != bx - 1 || rows.row != by - 1 ||
      rows.count < count)
    rows.read(rays, cells, run.picture, bx - 1, by - 1, count);
  return rows;
}

// Lights pixels whose surface no cell knows by the points around that lie on it. Should there be no
// such point and no map, they take the object's light from elsewhere, or the usual light of the
// scene: nothing is black because it has just come into view.
void Composer::light_thin(const LaneMask& lonely, int lx, int ly, Drawn& d) const {
  Pixels& p = d.pixels;
  NearbyLight far;  // light of the object looked up last
  uint32_t far_object = no_object;
  for (unsigned bits = negative_lanes(lonely); bits != 0; bits &= bits - 1) {
    int k = std::countr_zero(bits);
    if (!(p.depth[k] < 0.5f * infinite_depth)) continue;
    vec3 albedo(d.albedo.r[k], d.albedo.g[k], d.albedo.b[k]);
    if (albedo == vec3(0) && p.samples[k] > 0) continue;  // mirrors are sharp
    SeenPlace place{
        lx + k, ly,         vec2(p.x[k], p.y[k]), p.depth[k], vec3(p.nx[k], p.ny[k], p.nz[k]),
        albedo, p.object[k]};
    NearbyLight found = find_light_nearby(view, rays, light, place);
    if (found.samples > 0) {
      p.samples[k] = found.samples;
      p.deviation[k] = found.deviation;
    } else {
      if (d.mapped[k]) continue;
      if (std::exchange(far_object, place.object) != place.object) {
        far = find_light_far(cells, place);
        if (far.samples == 0) far.smooth = usual_light();
      }
      found = far;
    }
    p.smooth.r[k] = found.smooth.x, p.smooth.g[k] = found.smooth.y, p.smooth.b[k] = found.smooth.z;
    p.rest.r[k] = found.rest.x, p.rest.g[k] = found.rest.y, p.rest.b[k] = found.rest.z;
  }
}

// Lights the `n`-th eight of the run's pixels by points. Only `part` of them lies in the run:
// beyond it arrays hold anything.
void Composer::light_run(const RunPixels& p, const VisibleRun& run, const CellRows* read,
                         const RunGlow& emitting, int n, LanePart part, Drawn& d) const {
  int i = n * lane_count - half_cell, x = run.x + i;  // the first lane's pixel
  Pixels& q = d.pixels;
  if (!known) {  // there is no point
    d.albedo = {lanes_at(p.surface.red, i), lanes_at(p.surface.green, i),
                lanes_at(p.surface.blue, i)};
    q.samples = Lanes{};
    const vec3 usual = usual_light();
    q.smooth = {all_lanes(usual.x), all_lanes(usual.y), all_lanes(usual.z)};
    return light_as_mapped(d.mapped, q);
  }
  q.nx = lanes_at(p.surface.nx, i), q.ny = lanes_at(p.surface.ny, i);
  q.nz = lanes_at(p.surface.nz, i);
  d.albedo = {lanes_at(p.surface.red, i), lanes_at(p.surface.green, i),
              lanes_at(p.surface.blue, i)};
  q.normal2 = lanes_max(q.nx * q.nx + q.ny * q.ny + q.nz * q.nz, all_lanes(1e-30f));
  q.x = rays.x(float(x) + offset.x) + rays.inverse_focal * lane;
  q.y = all_lanes(rays.y(float(run.y) + offset.y));
  take_own(view, rays, read_own(light, x, run.y), rays.x(float(x) + 0.5f),
           rays.y(float(run.y) + 0.5f), d);
  const CellRows& rows = *read;
  constexpr Lanes across{0, 1, 2, 3, 0, 1, 2, 3};
  const Lanes fx = (across + 0.5f) * (1.0f / cell_size);
  float fy = (float(run.y - (rows.row + 1) * cell_size + half_cell) + 0.5f) / cell_size;
  Lanes weights[4] = {(1.0f - fx) * (1 - fy), fx * (1 - fy), (1.0f - fx) * fy, fx * fy};
  const int g = n * cells_together;
  const WideCell* corners[4] = {&rows.at(0, g), &rows.at(0, g + 1), &rows.at(1, g),
                                &rows.at(1, g + 1)};
  auto find_nearby = [&](const LaneMask& lonely, Drawn& of) { light_thin(lonely, x, run.y, of); };
  light_group(corners, rows.flat[g], weights, prior_variance,
              lanes_of_bits(part.bits() & ~bits_at(emitting.only, i)), find_nearby, d);
}

Shown Composer::light_part(const VisibleRun& run, const RunPixels& p, const RunGlow& emitting,
                           const RunMoving& moving, const RunMapped& mapped,
                           const RunDynamic& dynamic, const CellRows* rows, int n,
                           LanePart part) const {
  const int i = n * lane_count - half_cell;
  const unsigned here = part.bits(), moves = bits_at(moving.pixels, i) & here,
                 plain = bits_at(mapped.plain, i) & here;
  Drawn d;
  Pixels& q = d.pixels;
  q.depth = lanes_min(lanes_at(run.depth, i), all_lanes(infinite_depth));
  q.object = lanes_as<LaneBits>(lanes_at(reinterpret_cast<const float*>(run.object), i));
  Shown shown{{},
              all_lanes(skin_samples),
              q.depth < 0.5f * infinite_depth ? q.depth : all_lanes(INFINITY),
              q.object};
  if ((moves | plain) != here) {
    if (unsigned maps = bits_at(mapped.pixels, i)) {
      d.mapped = lanes_of_bits(maps);
      d.raised = keep_lanes(d.mapped, all_lanes(kept.maps->least_known()));
      d.unit = {d.mapped ? lanes_at(mapped.unit.red, i) : d.unit.r,
                d.mapped ? lanes_at(mapped.unit.green, i) : d.unit.g,
                d.mapped ? lanes_at(mapped.unit.blue, i) : d.unit.b};
    }
    light_run(p, run, rows, emitting, n, part, d);
    shown.color = {positive_lanes(d.albedo.r * (q.smooth.r * d.unit.r - d.raised) + q.rest.r),
                   positive_lanes(d.albedo.g * (q.smooth.g * d.unit.g - d.raised) + q.rest.g),
                   positive_lanes(d.albedo.b * (q.smooth.b * d.unit.b - d.raised) + q.rest.b)};
    shown.samples = q.samples;
  }
  if (plain) put_plain(p, mapped.unit, kept.maps->least_known(), i, lanes_of_bits(plain), shown);
  if (moves) put_moving(p, moving.light, i, lanes_of_bits(moves), shown);
  if (dynamic.any) add_dynamic(p, dynamic, i, shown);
  add_glow(p, emitting, i, here, shown);
  return shown;
}

// Returns a function that lights runs of the picture and puts them into `planes`.
template <class Planes>
auto taker(const Composer& composer, const Planes& planes) {
  return [&composer, &planes](const VisibleRun& run) {
    RunPixels p;
    RunMoving moving;
    RunGlow emitting = describe_run(run, p);
    const KeptLight& kept = composer.kept;
    if (kept.skin) moving.pixels = run.light(*kept.skin, *kept.lights, p.surface, moving.light);
    RunMapped mapped;
    if (kept.maps) mapped.pixels = run.known(*kept.maps, p.surface, mapped.unit);
    if (kept.maps && composer.passing && kept.maps->error < most_sure_error)
      mapped.plain = mapped.unit.plain & ~emitting.some &
                     ~composer.shade.pixels(run, composer.rays, composer.offset);
    const RunDynamic dynamic = find_dynamic(kept.dynamic, composer.view, run, p);
    const uint64_t all = run.count < 64 ? (uint64_t(1) << run.count) - 1 : ~uint64_t(0);
    const CellRows* rows = !composer.known || (moving.pixels | mapped.plain) == all
                               ? nullptr
                               : &composer.rows_around(run);
    size_t row = size_t(run.y) * size_t(composer.view.width) + size_t(run.x);
    for (int n = 0, parts = composer.parts_of(run); n < parts; n++) {
      int i = n * lane_count - half_cell;
      LanePart part{std::max(-i, 0), std::min(run.count - i, lane_count)};
      Shown shown = composer.light_part(run, p, emitting, moving, mapped, dynamic, rows, n, part);
      const LaidView* laid = composer.passing ? composer.kept.laid : nullptr;
      if (laid && laid->shows(run.x + i, run.y, lane_count))
        laid->lay_over(run.x + i, run.y, shown);
      planes.put(row + size_t(i + part.begin), part, shown);
    }
  };
}

constexpr float still_blur = 0.5f;  // the mean over places in the pixel blurs enough

float still_prior_variance(float guessed) {
  return moving_prior_variance * std::clamp((guessed - still_told) / still_told, 0.0f, 1.0f);
}
// Draws a picture that is shown by itself. Returns its edges.
template <class Planes>
std::span<const std::vector<EdgeShare>> compose_moment(const View& view,
                                                       const VisibilityPass& visibility,
                                                       const Cells& cells, bool known,
                                                       const Frame& light, const KeptLight& kept,
                                                       const Planes& planes) {
  Composer composer{view, cells, known, light, PixelRays(view)};
  composer.kept = kept;
  composer.passing = true;
  composer.shade = Shade(view, visibility.moving_bounds());
  auto differ = [&planes](uint32_t pixel, uint32_t step, int count) {
    return planes.differ(pixel, step, count);
  };
  return visibility.see_edges(view, composer.offset, taker(composer, planes), RasterShows::all,
                              differ);
}

// Shows moving meshes, in runs within the window that show any of them. Returns their edges.
template <class Take>
std::span<const std::vector<EdgeShare>> see_moving(const View& view,
                                                   const VisibilityPass& visibility,
                                                   const PictureWindow& window, const Take& take) {
  auto take_what_is_there = [&](const VisibleRun& run) {
    bool inside = run.x >= window.left && run.x + run.count <= window.left + window.width &&
                  run.y >= window.top && run.y < window.top + window.height;
    for (int i = 0; inside && i < run.count; i++)
      if (run.object[i] != 0) return take(run);
  };
  return visibility.see_edges(view, vec2(0.5f), take_what_is_there, RasterShows::moving);
}

}  // namespace

void compose_drawn(const View& view, const VisibilityPass& visibility, const Cells& cells,
                   bool known, const Frame& light, const KeptLight& kept, Frame& frame) {
  FramePlanes planes{frame};
  soften_edges(compose_moment(view, visibility, cells, known, light, kept, planes), frame.color);
}

void compose_drawn(const View& view, const VisibilityPass& visibility, const Cells& cells,
                   bool known, const Frame& light, const KeptLight& kept, const Tonemap& tonemap,
                   std::vector<uint8_t>& peaks, Image8& image, std::vector<float>* depth) {
  size_t pixels = size_t(view.width) * size_t(view.height);
  image.width = view.width, image.height = view.height;
  image.rgb.resize(3 * pixels);
  peaks.resize(pixels);
  if (depth) depth->resize(pixels);
  EyePlanes planes{tonemap.exposure, image.rgb.data(), peaks.data(),
                   depth ? depth->data() : nullptr};
  soften_edges(compose_moment(view, visibility, cells, known, light, kept, planes), image, peaks);
}

void compose_still(const View& view, const VisibilityPass& visibility, vec2 offset,
                   const Cells& cells, bool known, const Frame& light, const KeptLight& kept,
                   float guessed, Frame& frame) {
  Composer composer{
      view, cells, known, light, PixelRays(view), offset, still_prior_variance(guessed)};
  composer.kept = kept;
  FramePlanes planes{frame};
  visibility.see(view, offset, taker(composer, planes), RasterShows::still, still_blur);
}

std::span<const std::vector<EdgeShare>> compose_moving(const View& view,
                                                       const VisibilityPass& visibility,
                                                       const Cells& cells, bool known,
                                                       const Frame& light, const KeptLight& kept,
                                                       float guessed, Frame& frame) {
  Composer composer{
      view, cells, known, light, PixelRays(view), vec2(0.5f), still_prior_variance(guessed)};
  composer.kept = kept;
  return see_moving(view, visibility, {0, 0, view.width, view.height},
                    taker(composer, NearerPlanes{frame}));
}

// Draws what moves in the light that is kept on its skin (light/kept/skin/skin_light.h).

namespace {

Shown light_part(const VisibleRun& run, const RunPixels& p, const RunMoving& moving,
                 const RunDynamic& dynamic, const RunGlow& emitting, int i) {
  Shown shown{{}, Lanes{}, load_lanes(run.depth + i), load_lanes<LaneBits>(run.object + i)};
  put_moving(p, moving.light, i, LaneMask{} - 1, shown);
  if (dynamic.any) add_dynamic(p, dynamic, i, shown);
  add_glow(p, emitting, i, 0xff, shown);
  return shown;
}

bool shows_any(const VisibleRun& run) {
  return std::any_of(run.object, run.object + run.count, [](uint32_t o) { return o != 0; });
}

}  // namespace

void compose_moving(const View& view, const VisibilityPass& visibility, const PictureWindow& window,
                    const Tonemap& tonemap, std::span<const float> disparity,
                    std::span<uint8_t> covered, const KeptLight& kept, MovingLight& light) {
  NearerEyePlanes planes{
      tonemap.exposure,         disparity.data(),
      covered.data(),           light.disparity.empty() ? nullptr : light.disparity.data(),
      light.picture.rgb.data(), light.peaks.data()};
  auto take = [&](const VisibleRun& run) {
    if (run.x < window.left || run.x + run.count > window.left + window.width) return;
    if (run.y < window.top || run.y >= window.top + window.height || !shows_any(run)) return;
    RunPixels p;
    RunMoving moving;
    RunGlow emitting = describe_run(run, p);
    moving.pixels = run.light(*kept.skin, *kept.lights, p.surface, moving.light);
    const RunDynamic dynamic = find_dynamic(kept.dynamic, view, run, p);
    size_t row = size_t(run.y) * size_t(view.width) + size_t(run.x);
    for (int i = 0; i < run.count; i += lane_count)
      planes.put(row + size_t(i), LanePart{0, std::min(run.count - i, lane_count)},
                 light_part(run, p, moving, dynamic, emitting, i));
  };
  soften_edges(visibility.see_edges(view, vec2(0.5f), take, RasterShows::moving), light.picture,
               light.peaks);
}

}  // namespace wellspring::picture
