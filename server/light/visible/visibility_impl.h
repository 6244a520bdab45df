// SPDX-License-Identifier: Apache-2.0
// Holds the private state of light/visible/visibility.h, for its own units.
#pragma once
#include <algorithm>
#include <memory>
#include <optional>
#include <vector>

#include "base/simd.h"
#include "light/material/bsdf_gloss.h"
#include "light/sample/illumination_map.h"
#include "light/visible/facet.h"
#include "light/visible/visibility.h"
#include "world/large_texture.h"

namespace wellspring::light {

struct VisibilityPass::Impl {
  const World& world;
  Lights lights;
  Raster raster;
  Pictures pictures;
  std::vector<Reflectance> reflectance;  // one for each material
  std::vector<DemodulationScale> scale;  // one for each material, set for scaled ones
  std::vector<uint8_t> panes;            // one for each material: it is a pane everywhere
  std::vector<uint8_t> polished;         // one for each material: some place of it may be
  std::vector<uint8_t> glossy;           // one for each material: some place of it has highlights
  std::vector<uint8_t> plain;            // one for each material: is_plain()
  bool any_gloss = false;                // some mesh of the scene has highlights
  std::vector<uint8_t> moving_object;    // by object
  std::shared_ptr<PieceStore> pieces;    // the scene's; null: it has no very large pictures
  MetalDemodulation metal_of(int material) const {
    return lights.tables->materials[size_t(material)].metal;
  }
  Impl(const World& w, const Lights& l)
      : world(w), lights(l), raster(w), pictures(make_pictures(w.scene())) {}
};

// Holds pixels side by side of one material, whose pictures are read at one level, maybe of several
// triangles: many small ones each for itself would leave most lanes unused.
struct Stretch {
  int begin, end;
  const Material* material;
  int index;                           // the material's in the scene
  float base_texels, emission_texels;  // a pixel's width
  bool alone;                          // each pixel has to be looked up by itself
  bool goes_on_with(const Stretch& s) const {
    return end == s.begin && material == s.material && index == s.index && alone == s.alone &&
           pyramid_level(base_texels) == pyramid_level(s.base_texels) &&
           pyramid_level(emission_texels) == pyramid_level(s.emission_texels);
  }
};
struct PicturePlaces {
  float u[RunSurface::most], v[RunSurface::most];
  void put(const FacetPicture& place, Lanes a, Lanes b, int i) {
    store_lanes(u + i, place.corner.x + place.edge1.x * a + place.edge2.x * b);
    store_lanes(v + i, place.corner.y + place.edge1.y * a + place.edge2.y * b);
  }
};
struct Stretches {
  int count = 0;
  Stretch of[RasterRun::most];
  PicturePlaces base, shine;
  void add(const Stretch& s) {
    if (count > 0 && of[count - 1].goes_on_with(s)) of[count - 1].end = s.end;
    else of[count++] = s;
  }
};

// Returns the factor from the light that is kept to the light on eight places of a facet, (a, b) on
// its triangle, as light has `slope`. `relief`: texels of a map of normals there, 0 to 1; null:
// they face as the mesh does. `own`: how far the slope goes along the normal that light is kept
// for; null: the mesh's.
Lanes eval_turn(const Facet& f, Lanes a, Lanes b, const Lanes3& slope, const Lanes3* relief,
                const Lanes* own);

inline constexpr float most_shining = 0.25f;  // roughness

struct VisibleRun::Impl {
  const VisibilityPass::Impl& visibility;
  const View& view;
  vec2 offset;
  float pixel_angle, blurred_angle;
  FacetCache& facets;
  const RasterRun* run = nullptr;
  // Made when the run first shows a very large picture:
  mutable std::optional<PictureSampler> sampler{};
  mutable PixelToTexture to_texture{};  // on this triangle
  mutable uint32_t texture_instance = RasterRun::nothing, texture_triangle = 0;
  // Returns the texel of a very large picture, linear, that pixel i of `f` shows.
  vec3 read_large(const Facet& f, int i) const;
  // Returns the direction towards pixel i, at depth 1.
  vec3 direction(int i) const {
    vec2 axis = axis_place(view);
    float x = float(run->x + i) + offset.x - axis.x, y = axis.y - float(run->y) - offset.y;
    return view.forward + view.right * (x * pixel_angle) + view.up * (y * pixel_angle);
  }
  // Returns the distance from the eye of the surface that pixel i shows.
  float distance(int i) const {
    const vec2 axis = axis_place(view);
    const vec2 aside = pixel_angle * (vec2(float(run->x + i), float(run->y)) + offset - axis);
    return run->depth[i] * std::sqrt(1 + dot(aside, aside));
  }
  Facet& facet(int i) const {
    return facets.find(visibility.world, run->instance[i], run->triangle[i], view.position);
  }
  PrimaryHit see(int i) const;
  Lanes read_gloss(const RunSurface& surface, int i, Lanes f0, Lanes roughness, Lanes share) const;
  // Returns the texels of the facet's map of normals across a pixel, for pixels from `i` on and
  // before `end`.
  float relief_texels(const Facet& f, int i, int end) const {
    const int middle = std::min(i + lane_count / 2, end - 1);
    return pixel_width(f, distance(middle), blurred_angle) * f.relief.texels;
  }
  // Reads a map of normals at eight pixels; reads it as if there were none if it is of floats, or
  // read by the nearest texel.
  Lanes3 read_relief(const PicturePlaces& places, const Material& m, float texels, int i,
                     int end) const;
  Lanes read_sheen(const RunSurface& surface, const Lanes3& slope, int i, float roughness) const;
  // Returns whether its gloss is smooth enough to show what is around.
  bool shines(const Facet& f) const {
    const GlossFactors gloss = gloss_factors(*f.material);
    return f.placed->moving && gloss.f0 > 0 && gloss.share > 0 && gloss.roughness < most_shining;
  }
  // Computes the light of such gloss; RunSkin's other light is set.
  void shine(const Lights& lights, RunSkin& to) const;
  void describe_normals(const Facet& f, int begin, int end, RunSurface& to) const;
  vec3 scale_of(const Material& m, int index) const {
    return glm::clamp(vec3(m.base_color), 0.0f, 1.0f) * visibility.scale[size_t(index)].factor;
  }
  bool has_picture(const TextureRef& reference) const {
    const Scene& scene = *visibility.pictures.scene;
    return reference.texture >= 0 && scene.textures[size_t(reference.texture)].image >= 0;
  }
  bool reads_base(const Material& m, int index) const {
    return has_picture(m.base_color_texture) && scale_of(m, index) != vec3(0);
  }
  bool reads_emission(const Material& m, int index) const {
    return visibility.reflectance[size_t(index)] == Reflectance::base &&
           has_picture(m.metallic_roughness_texture);
  }
  bool place(const Facet& f, int begin, int end, Stretches& to) const;
  bool read_lanes(const PicturePlaces& places, const TextureRef& reference, float texels, int i,
                  int end, Lanes (&rgb)[3]) const;
  void describe(const Stretches& stretches, const Stretch& s, RunSurface& to) const;
};

}  // namespace wellspring::light
