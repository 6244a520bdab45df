// SPDX-License-Identifier: Apache-2.0
// Light that is kept on what moves, on a run's pixels: VisibleRun::light().
#include "light/known/skin_light.h"
#include "light/material/gloss_albedo.h"
#include "light/visible/visibility_impl.h"

namespace wellspring::light {

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
  // How far the slope goes along the mesh's normal, and along that which light is relative to.
  const float side = f.front ? 1.0f : -1.0f;
  const Lanes up = (slope.x * nx + slope.y * ny + slope.z * nz) * unit;
  const Lanes from = own ? *own : side * up;
  if (!relief) return positive_lanes(1.0f + side * up - from);
  const Lanes x = relief->x * 2.0f - 1.0f, y = relief->y * 2.0f - 1.0f, z = relief->z * 2.0f - 1.0f;
  const float scale = f.material->normal_scale;
  // As steep as the scale says, and as short as the mean over the pixel is.
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

}  // namespace wellspring::light
