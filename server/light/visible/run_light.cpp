// SPDX-License-Identifier: Apache-2.0
// Light that is kept, on a run's pixels: VisibleRun::light(), VisibleRun::known().
#include <algorithm>

#include "light/known/skin_light.h"
#include "light/material/gloss_albedo.h"
#include "light/visible/visibility_impl.h"

namespace wellspring {

// The slope of radiance over that of irradiance follows from the bands of a clamped cosine
// (Ramamoorthi and Hanrahan 2001).
static constexpr float sheen_slope = 1.5f;

// What part of light from all around eight pixels' gloss reflects, of a surface as described.
Lanes VisibleRun::Impl::read_gloss(const RunSurface& surface, int i, Lanes f0, Lanes roughness,
                                   Lanes share) const {
  constexpr Lanes lane{0, 1, 2, 3, 4, 5, 6, 7};
  const vec3 way = -direction(i), step = view.right * pixel_angle;
  const Lanes x = way.x - step.x * lane, y = way.y - step.y * lane, z = way.z - step.z * lane;
  const Lanes nx = load_lanes(surface.nx + i), ny = load_lanes(surface.ny + i),
              nz = load_lanes(surface.nz + i);
  const Lanes lengths = (nx * nx + ny * ny + nz * nz) * (x * x + y * y + z * z);
  const Lanes cosine =
      (nx * x + ny * y + nz * z) / lanes_sqrt(lanes_max(lengths, all_lanes(1e-30f)));
  return gloss_albedo(f0, roughness, share,
                      lanes_min(lanes_max(cosine, all_lanes(0)), all_lanes(1)));
}

// Times as much light as the diffuse layer is lit by comes from about where eight pixels mirror, by
// the light's slope: of spherical harmonics of two bands, of which a rough lobe leaves a part.
Lanes VisibleRun::Impl::read_sheen(const RunSurface& surface, const IlluminationLanes& slope, int i,
                                   float roughness) const {
  constexpr Lanes lane{0, 1, 2, 3, 4, 5, 6, 7};
  const vec3 way = direction(i), step = view.right * pixel_angle;
  const Lanes x = way.x + step.x * lane, y = way.y + step.y * lane, z = way.z + step.z * lane;
  const Lanes nx = load_lanes(surface.nx + i), ny = load_lanes(surface.ny + i),
              nz = load_lanes(surface.nz + i);
  const Lanes unit = 1.0f / lanes_sqrt(lanes_max(nx * nx + ny * ny + nz * nz, all_lanes(1e-30f))),
              length = 1.0f / lanes_sqrt(x * x + y * y + z * z);
  const Lanes along = (slope.x * nx + slope.y * ny + slope.z * nz) * unit,
              back = 2.0f * (x * nx + y * ny + z * nz) * unit * unit;
  const Lanes mirrored =
      (slope.x * (x - back * nx) + slope.y * (y - back * ny) + slope.z * (z - back * nz)) * length;
  return positive_lanes(1.0f - along + sheen_slope * (1 - roughness * roughness) * mirrored);
}

uint64_t VisibleRun::light(const SkinLight& skin, const Lights& lights, const RunSurface& surface,
                           RunSkin& to) const {
  if (seen_) return 0;
  const RasterRun& r = *impl_->run;
  float f0[RunSurface::most], roughness[RunSurface::most], share[RunSurface::most];
  uint64_t moving = 0;
  bool shines = false;
  for (int p = 0, begin = 0; p < r.pieces; begin = r.end[p++]) {
    if (r.instance[begin] == RasterRun::nothing) continue;
    const Facet& f = impl_->facet(begin);
    if (!f.placed->moving) continue;
    SkinTriangle light = find_skin(skin, r.instance[begin], f.corner, !f.front);
    GlossFactors gloss = gloss_factors(*f.material);
    shines |= impl_->shines(f);
    for (int i = begin; i < r.end[p]; i++) moving |= uint64_t(1) << i;
    for (int i = begin; i < r.end[p]; i += lane_count) {
      Lanes u = load_lanes(r.u + i), v = load_lanes(r.v + i);
      auto mix = [&](const vec3& a, const vec3& b, const vec3& c, int k) {
        return a[k] + b[k] * u + c[k] * v;
      };
      IlluminationLanes slopes{};
      slopes.x = mix(light.slope, light.slope1, light.slope2, 0);
      slopes.y = mix(light.slope, light.slope1, light.slope2, 1);
      slopes.z = mix(light.slope, light.slope1, light.slope2, 2);
      const Lanes factor =
          f.relief.known ? impl_->read_turn(f, slopes, true, false, i, r.end[p]) : all_lanes(1);
      const Lanes sheen = impl_->read_sheen(surface, slopes, i, gloss.roughness);
      auto put = [&](int k, float* diffuse, float* shine) {
        const Lanes kept = mix(light.corner, light.edge1, light.edge2, k);
        store_lanes(diffuse + i, factor * kept);
        store_lanes(shine + i, sheen * kept);
      };
      put(0, to.red, to.shine_red), put(1, to.green, to.shine_green);
      put(2, to.blue, to.shine_blue);
      store_lanes(f0 + i, all_lanes(gloss.f0));
      store_lanes(roughness + i, all_lanes(gloss.roughness));
      store_lanes(share + i, all_lanes(gloss.share));
    }
  }
  for (int i = 0; i < count; i += lane_count)
    if (moving >> i & 0xff)
      store_lanes(to.gloss + i,
                  impl_->read_gloss(surface, i, load_lanes(f0 + i), load_lanes(roughness + i),
                                    load_lanes(share + i)));
  if (shines) impl_->shine(lights, to);
  return moving;
}

namespace {

// The nodes around a place differ by at most that share of its light, or their light has an edge
// between them.
constexpr float most_even_spread = 0.4f;

// Where the light of a triangle lies; false: the charts do not have it.
bool place_light(const IlluminationCharts& charts, Facet& f) {
  if (f.charts == &charts) return f.chart != no_chart;
  f.charts = &charts;
  f.chart = charts.find(f.instance, f.triangle, f.front);
  if (f.chart == no_chart) return false;
  const IlluminationChart& chart = charts.charts[f.chart];
  const Face face = make_face(*f.placed, f.triangle);
  auto along = [&](vec3 way) { return vec2(dot(way, chart.along_u), dot(way, chart.along_v)); };
  f.light_corner = along(face.corner - chart.origin);
  f.light_edge1 = along(face.edge1), f.light_edge2 = along(face.edge2);
  return true;
}

}  // namespace

// Times as much light as the nodes have falls on eight pixels: on their mapped normals where the
// facet has `relief`, else on the mesh's.
Lanes VisibleRun::Impl::read_turn(const Facet& f, const IlluminationLanes& light, bool relief,
                                  bool bent, int i, int end) const {
  const Material& m = *f.material;
  const Lanes a = load_lanes(run->u + i), b = load_lanes(run->v + i);
  vec3 n = f.normal[0];
  Lanes nx = all_lanes(n.x), ny = all_lanes(n.y), nz = all_lanes(n.z);
  if (!f.one_normal) {
    const vec3 p = f.normal[1] - n, q = f.normal[2] - n;
    nx += p.x * a + q.x * b, ny += p.y * a + q.y * b, nz += p.z * a + q.z * b;
  }
  const Lanes unit = 1.0f / lanes_sqrt(lanes_max(nx * nx + ny * ny + nz * nz, all_lanes(1e-30f)));
  // How far the slope goes along the mesh's normal, and along that which light is relative to.
  const float side = f.front ? 1.0f : -1.0f;
  const Lanes up = (light.x * nx + light.y * ny + light.z * nz) * unit;
  const Lanes own =
      bent ? light.x * light.own_x + light.y * light.own_y + light.z * light.own_z : side * up;
  if (!relief) return positive_lanes(1.0f + side * up - own);
  PicturePlaces places;
  places.put(f.relief, a, b, i);
  const int middle = std::min(i + lane_count / 2, end - 1);
  const float texels =
      pixel_width(f, run->depth[middle], direction(middle), blurred_angle) * f.relief.texels;
  Lanes map[3];
  if (!read_lanes(places, m.normal_texture, texels, i, end, map))
    return positive_lanes(1.0f + side * up - own);  // floats, or read by the nearest texel
  const Lanes x = map[0] * 2.0f - 1.0f, y = map[1] * 2.0f - 1.0f, z = map[2] * 2.0f - 1.0f;
  const float scale = m.normal_scale;
  // As steep as the scale says, and as short as the mean over the pixel is.
  const Lanes flat = x * x + y * y,
              shrink = lanes_sqrt((flat + z * z) /
                                  lanes_max(scale * scale * flat + z * z, all_lanes(1e-12f)));
  auto along = [&](vec3 way) { return light.x * way.x + light.y * way.y + light.z * way.z; };
  const Lanes seen =
      scale * shrink * (x * along(f.tangent) + y * along(f.bitangent)) + z * shrink * up;
  return positive_lanes(1.0f + side * seen - own);
}

uint64_t VisibleRun::known(const IlluminationMap& map, const RunSurface& surface,
                           RunKnown& to) const {
  to.plain = 0;
  if (seen_) return 0;
  const RasterRun& r = *impl_->run;
  uint64_t known = 0;
  for (int p = 0, begin = 0; p < r.pieces; begin = r.end[p++]) {
    if (r.instance[begin] == RasterRun::nothing) continue;
    Facet& f = impl_->facet(begin);
    if (f.placed->moving || !place_light(*map.places, f)) continue;
    const IlluminationChart& chart = map.places->charts[f.chart];
    const Lanes more = all_lanes(map.least_known());
    const bool relief = f.relief.known && !map.nodes.slope.empty(),
               bent = chart.bent && map.normals;
    const bool plain = impl_->visibility.plain[size_t(f.placed->mesh->material)] != 0;
    const GlossFactors gloss = gloss_factors(*f.material);
    for (int i = begin; i < r.end[p]; i += lane_count) {
      constexpr Lanes lane{0, 1, 2, 3, 4, 5, 6, 7};
      const LaneMask here = lane < float(r.end[p] - i);
      const Lanes a = load_lanes(r.u + i), b = load_lanes(r.v + i);
      IlluminationLanes light = eval_illumination(
          map, chart, f.light_corner.x + f.light_edge1.x * a + f.light_edge2.x * b,
          f.light_corner.y + f.light_edge1.y * a + f.light_edge2.y * b, here, relief || bent);
      const Lanes factor =
          relief || bent ? impl_->read_turn(f, light, relief, bent, i, r.end[p]) : all_lanes(1);
      store_lanes(to.red + i, light.red * factor + more);
      store_lanes(to.green + i, light.green * factor + more);
      store_lanes(to.blue + i, light.blue * factor + more);
      known |= uint64_t(negative_lanes(here)) << i;
      if (!plain) continue;
      const Lanes all = light.red + light.green + light.blue;
      to.plain |= uint64_t(negative_lanes(here & (light.spread <= most_even_spread * all))) << i;
      store_lanes(to.gloss + i,
                  impl_->read_gloss(surface, i, all_lanes(gloss.f0), all_lanes(gloss.roughness),
                                    all_lanes(gloss.share)));
    }
  }
  return known;
}

}  // namespace wellspring
