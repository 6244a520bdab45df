// SPDX-License-Identifier: Apache-2.0
// Computes the light that is kept on what moves, on a run's pixels: VisibleRun::light().
#include <algorithm>
#include <array>
#include <cmath>

#include "light/kept/skin/skin_light.h"
#include "light/material/bsdf_gloss.h"
#include "light/sample/sample_light.h"
#include "light/visible/visibility_impl.h"
#include "light/walk/walk.h"

namespace wellspring::light {

// The slope of radiance over that of irradiance follows from the bands of a clamped cosine
// (Ramamoorthi and Hanrahan 2001).
static constexpr float sheen_slope = 1.5f;

// Returns the share of light from all around that eight pixels' gloss reflects, of a surface as
// described.
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

// Returns the light from about where eight pixels mirror, as a multiple of the light on the diffuse
// layer, by the light's slope: of spherical harmonics of two bands, of which a rough lobe leaves a
// part.
Lanes VisibleRun::Impl::read_sheen(const RunSurface& surface, const Lanes3& slope, int i,
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

Lanes eval_turn(const Facet& f, Lanes a, Lanes b, const Lanes3& slope, const Lanes3* relief,
                const Lanes* own) {
  const vec3 n = f.normal[0];
  Lanes nx = all_lanes(n.x), ny = all_lanes(n.y), nz = all_lanes(n.z);
  if (!f.one_normal) {
    const vec3 p = f.normal[1] - n, q = f.normal[2] - n;
    nx += p.x * a + q.x * b, ny += p.y * a + q.y * b, nz += p.z * a + q.z * b;
  }
  const Lanes unit = 1.0f / lanes_sqrt(lanes_max(nx * nx + ny * ny + nz * nz, all_lanes(1e-30f)));
  // `up` and `from` are how far the slope goes along the mesh's normal, and along the normal that
  // light is relative to.
  const float side = f.front ? 1.0f : -1.0f;
  const Lanes up = (slope.x * nx + slope.y * ny + slope.z * nz) * unit;
  const Lanes from = own ? *own : side * up;
  if (!relief) return positive_lanes(1.0f + side * up - from);
  const Lanes x = relief->x * 2.0f - 1.0f, y = relief->y * 2.0f - 1.0f, z = relief->z * 2.0f - 1.0f;
  const float scale = f.material->normal_scale;
  // The normal is as steep as the scale says, and as short as the mean over the pixel is.
  const Lanes flat = x * x + y * y,
              shrink = lanes_sqrt((flat + z * z) /
                                  lanes_max(scale * scale * flat + z * z, all_lanes(1e-12f)));
  auto along = [&](vec3 way) { return slope.x * way.x + slope.y * way.y + slope.z * way.z; };
  const Lanes seen =
      scale * shrink * (x * along(f.tangent) + y * along(f.bitangent)) + z * shrink * up;
  return positive_lanes(1.0f + side * seen - from);
}

Lanes3 VisibleRun::Impl::read_relief(const PicturePlaces& places, const Material& m, float texels,
                                     int i, int end) const {
  Lanes rgb[3];
  if (!read_lanes(places, m.normal_texture, texels, i, end, rgb))
    return all_lanes(vec3(0.5f, 0.5f, 1));
  return {rgb[0], rgb[1], rgb[2]};
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
    Facet& f = impl_->facet(begin);
    if (!f.placed->moving) continue;
    place_relief(impl_->visibility.world, f);
    SkinTriangle light = find_skin(skin, r.instance[begin], f.corner, !f.front);
    GlossFactors gloss = gloss_factors(*f.material);
    shines |= impl_->shines(f);
    for (int i = begin; i < r.end[p]; i++) moving |= uint64_t(1) << i;
    for (int i = begin; i < r.end[p]; i += lane_count) {
      Lanes u = load_lanes(r.u + i), v = load_lanes(r.v + i);
      auto mix = [&](const vec3& a, const vec3& b, const vec3& c, int k) {
        return a[k] + b[k] * u + c[k] * v;
      };
      const Lanes3 slopes{mix(light.slope, light.slope1, light.slope2, 0),
                          mix(light.slope, light.slope1, light.slope2, 1),
                          mix(light.slope, light.slope1, light.slope2, 2)};
      Lanes factor = all_lanes(1);
      if (f.relief.known) {
        PicturePlaces places;
        places.put(f.relief, u, v, i);
        const Lanes3 relief = impl_->read_relief(places, *f.material,
                                                 impl_->relief_texels(f, i, r.end[p]), i, r.end[p]);
        factor = eval_turn(f, u, v, slopes, &relief, nullptr);
      }
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

// Computes smooth gloss of what moves, which shows what is around, as the catch lights of eyes:
// VisibleRun::light().

namespace {

constexpr int most_rays = 8;                // rays of a pixel
constexpr size_t most_together = 256;       // rays
constexpr float turn_a_ray = 0.015f;        // radians that normals turn within a pixel, for a ray
constexpr float least_alpha_shown = 0.03f;  // for highlights of lamps that have no size
constexpr float darkest = 1e-3f;            // radiance: no visitor sees a shadow of less
constexpr float beyond = 0.5f;              // triangle's sides that normals are followed beyond it

// Holds a triangle, and the normals on it towards the eye.
struct ShineFacet {
  vec3 corner{0}, edge1{0}, edge2{0}, face{0};
  vec3 normal[3];
  float aa = 0, ab = 0, bb = 0, scale = 0, extent = 0;

  explicit ShineFacet(const Facet& f) {
    const Mesh& mesh = *f.placed->mesh;
    const float side = f.front ? 1.0f : -1.0f;
    corner = mesh.positions[f.corner.x];
    edge1 = mesh.positions[f.corner.y] - corner, edge2 = mesh.positions[f.corner.z] - corner;
    face = f.face * side;
    for (int k = 0; k < 3; k++) normal[k] = f.normal[k] * side;
    aa = dot(edge1, edge1), ab = dot(edge1, edge2), bb = dot(edge2, edge2);
    const float square = aa * bb - ab * ab;
    scale = square > 0 ? 1 / square : 0;
    for (int k = 0; k < 3; k++)
      extent = std::max(extent, max_component(glm::abs(mesh.positions[f.corner[k]])));
  }
  // Holds a place of the plane that is seen along `way`, and the unit normal there.
  struct Seen {
    vec3 place{0}, normal{0};
  };
  Seen see(vec3 eye, vec3 way) const {
    const float along = dot(way, face);
    const vec3 from = corner - eye;
    const float t = along < 0 ? dot(from, face) / along : 0;
    const vec3 to = way * std::max(t, 0.0f) - from;
    const float a = dot(to, edge1), b = dot(to, edge2);
    const float u = std::clamp((bb * a - ab * b) * scale, -beyond, 1 + beyond),
                v = std::clamp((aa * b - ab * a) * scale, -beyond, 1 + beyond);
    const vec3 n = normal[0] * (1 - u - v) + normal[1] * u + normal[2] * v;
    const float length2 = dot(n, n);
    return {corner + edge1 * u + edge2 * v, length2 > 1e-25f ? n / std::sqrt(length2) : face};
  }
};

// Draws a facet of GGX's distribution around the normal (Walter et al. 2007, equation 35).
vec3 sample_facet(vec3 normal, float alpha, vec2 u) {
  const float tangent2 = alpha * alpha * u.x / std::max(1 - u.x, 1e-3f);
  const float cosine = 1 / std::sqrt(1 + tangent2), sine = std::sqrt(tangent2) * cosine;
  const vec3 aside = std::abs(normal.x) < 0.7f ? vec3(1, 0, 0) : vec3(0, 1, 0);
  const vec3 s = normalize(cross(normal, aside)), t = cross(normal, s);
  const float turn = 2 * pi * u.y;
  return normal * cosine + (s * std::cos(turn) + t * std::sin(turn)) * sine;
}

// Returns GGX's distribution times its shadowing, by Smith, over four cosines; `v`, `l`: unit.
float eval_lobe(vec3 n, vec3 v, vec3 l, float alpha) {
  const vec3 h = normalize(v + l);
  const float nh = std::clamp(dot(n, h), 0.0f, 1.0f), nl = dot(n, l),
              nv = std::max(dot(n, v), 1e-3f), alpha2 = alpha * alpha;
  if (!(nl > 0)) return 0;
  const float base = 1 - nh * nh * (1 - alpha2);
  const float shadowing = nl * std::sqrt(nv * nv * (1 - alpha2) + alpha2) +
                          nv * std::sqrt(nl * nl * (1 - alpha2) + alpha2);
  return 0.5f * alpha2 / (pi * base * base * shadowing);
}

struct ShineRay {
  int pixel;
  float weight;
};

}  // namespace

// Sums up the highlights of lamps without size.
static vec3 eval_lamps(const Transport& transport, const SurfacePlace& place, vec3 normal, vec3 eye,
                       float alpha) {
  vec3 sum(0);
  const LightTables& tables = transport.tables;
  for (size_t k = 0; k < tables.punctual.size(); k++) {
    const LightSample lamp = eval_punctual(tables.punctual[k], tables.cones[k], place);
    if (!(lamp.pdf > 0) || !(dot(place.geometric_normal, lamp.direction) > 0)) continue;
    const float cosine = dot(normal, lamp.direction);
    if (!(cosine > 0)) continue;
    const vec3 shown = lamp.radiance * (cosine * eval_lobe(normal, eye, lamp.direction, alpha));
    if (max_component(shown) > darkest) sum += shown * eval_visibility(transport, place, lamp);
  }
  return sum;
}

void VisibleRun::Impl::shine(const Lights& lights, RunSkin& to) const {
  std::vector<Ray> rays;
  std::vector<ShineRay> of;
  const Transport transport{visibility.world, *lights.tables};
  const vec3 eye = view.position;
  for (int p = 0, begin = 0; p < run->pieces; begin = run->end[p++]) {
    if (run->instance[begin] == RasterRun::nothing) continue;
    const Facet& f = facet(begin);
    if (!shines(f)) continue;
    const ShineFacet shape(f);
    const float alpha = clean(f.material->roughness) * clean(f.material->roughness);
    for (int i = begin; i < run->end[p]; i++) {
      const vec3 way = direction(i), right = view.right * pixel_angle, up = view.up * pixel_angle;
      const ShineFacet::Seen middle = shape.see(eye, way);
      const vec3 across = shape.see(eye, way + 0.5f * right).normal -
                          shape.see(eye, way - 0.5f * right).normal,
                 along = shape.see(eye, way + 0.5f * up).normal -
                         shape.see(eye, way - 0.5f * up).normal;
      const float turn2 = dot(across, across) + dot(along, along);
      // A pixel's normals are spread like those of something rougher (Kaplanyan et al. 2016,
      // "Filtering Distributions of Normals for Shading Antialiasing").
      const float spread = std::sqrt(alpha * alpha + turn2 / 6);
      SurfacePlace place;
      place.position = middle.place, place.geometric_normal = shape.face;
      place.extent = shape.extent;
      const vec3 lamps = eval_lamps(transport, place, middle.normal, -normalize(way),
                                    std::clamp(spread, least_alpha_shown, 1.0f));
      to.shine_red[i] = lamps.x, to.shine_green[i] = lamps.y, to.shine_blue[i] = lamps.z;
      const int count = std::clamp(1 + int((std::sqrt(turn2) + alpha) / turn_a_ray), 1, most_rays);
      for (int k = 0; k < count; k++) {
        // The places are the R2 sequence in the pixel and on the lobe (Roberts 2018).
        const float a = float(k) + 0.5f;
        auto part = [&](float step) { return step * a - std::floor(step * a); };
        const vec2 at(part(0.7548777f) - 0.5f, part(0.5698403f) - 0.5f);
        const vec3 there = normalize(way + at.x * right + at.y * up);
        const ShineFacet::Seen s = shape.see(eye, there);
        const vec3 n = sample_facet(s.normal, alpha, {part(0.8191725f), part(0.6710436f)});
        Ray ray;
        place.position = s.place;
        ray.direction = there - 2 * dot(there, n) * n;
        // Such a ray would show something behind the surface: its light is taken as that around.
        if (!(dot(ray.direction, shape.face) > 1e-3f)) {
          to.shine_red[i] += to.red[i] / float(count);
          to.shine_green[i] += to.green[i] / float(count);
          to.shine_blue[i] += to.blue[i] / float(count);
          continue;
        }
        ray.origin = offset_origin(place, shape.face);
        rays.push_back(ray), of.push_back({i, 1 / float(count)});
      }
    }
  }
  std::vector<PrimaryHit> seen(rays.size());
  // They are cast in parts that are not shared out to threads: a thread that waited could begin
  // another run.
  for (size_t first = 0; first < rays.size(); first += most_together) {
    const size_t count = std::min(most_together, rays.size() - first);
    wellspring::light::see(visibility.world, lights, std::span(rays).subspan(first, count),
                           std::span(seen).subspan(first, count));
  }
  for (size_t k = 0; k < rays.size(); k++) {
    const int i = of[k].pixel;
    // The met surface is lit as the place itself is.
    const vec3 shown = seen[k].glow + seen[k].albedo * vec3(to.red[i], to.green[i], to.blue[i]);
    to.shine_red[i] += of[k].weight * shown.x, to.shine_green[i] += of[k].weight * shown.y;
    to.shine_blue[i] += of[k].weight * shown.z;
  }
}

}  // namespace wellspring::light
