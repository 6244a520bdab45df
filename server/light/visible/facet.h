// SPDX-License-Identifier: Apache-2.0
// Holds a triangle as a picture of it needs it: what all its pixels have in common, looked up once.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "base/simd.h"
#include "base/vec.h"
#include "light/material/material_use.h"
#include "light/visible/guides.h"
#include "light/walk/first_surface.h"
#include "world/surface.h"
#include "world/texture.h"

namespace wellspring::light {

// Describes how a place reflects small lights as highlights: by GGX (glTF 2.0, appendix B), no
// clearcoat.

// Highlights of rougher surfaces without metal look like their diffuse light.
inline constexpr float least_rough = 0.6f, least_metal = 0.05f;

struct Gloss {
  vec3 f0{0};  // reflectance towards the normal
  float roughness = 1, metallic = 0;
};

// Holds the same packed for two planes of a picture. `code`: roots of f0 in the low bytes, red
// first, then roughness, each times 255; 0: no highlights.
struct GlossCode {
  uint32_t code = 0;
  uint8_t metallic = 0;  // times 255
};
inline GlossCode pack_gloss(const Gloss& gloss) {
  if (gloss.roughness >= least_rough && gloss.metallic < least_metal) return {};
  auto byte = [](float x) { return uint32_t(255 * std::clamp(x, 0.0f, 1.0f) + 0.5f); };
  GlossCode packed{byte(gloss.roughness) << 24, uint8_t(byte(gloss.metallic))};
  for (int c = 0; c < 3; c++) packed.code |= byte(std::sqrt(gloss.f0[c])) << (8 * c);
  return packed;
}

// Holds the gloss of eight pixels.
struct GlossLanes {
  Lanes f0[3], roughness, metallic;
};
inline GlossLanes unpack_gloss(const uint32_t* codes, const uint8_t* metallic) {
  GlossLanes gloss;
  for (int i = 0; i < lane_count; i++) {
    for (int c = 0; c < 3; c++) {
      const float root = float(codes[i] >> (8 * c) & 255) * (1 / 255.0f);
      gloss.f0[c][i] = root * root;
    }
    gloss.roughness[i] = float(codes[i] >> 24) * (1 / 255.0f);
    gloss.metallic[i] = float(metallic[i]) * (1 / 255.0f);
  }
  return gloss;
}

// Finds what the visibility pass (light/visible/visibility.h) needs of materials before it begins.

// Says how the reflectance of a material is found.
enum class Reflectance : uint8_t {
  scaled,  // a factor times base colour, and no less than a floor
  base,    // base colour and metallic of each place determine it
  traced,  // ask a ray
};

// Describes how demodulated_albedo() changes base colour.
struct DemodulationScale {
  float factor = 1, floor = 0;
};
inline Reflectance find_reflectance(const Material& m, MetalDemodulation metal,
                                    DemodulationScale& scale) {
  if (m.transmission > 0 || m.anisotropy > 0) return Reflectance::traced;
  if (m.metallic > 0 && m.metallic_roughness_texture.texture >= 0) return Reflectance::base;
  bool kept = metal != MetalDemodulation::none;
  scale = {kept ? 1 : 1 - clean(m.metallic),
           kept ? least_demodulated_metal * clean(m.metallic) : 0};
  return Reflectance::scaled;
}

// Returns RasterSettings::see_through of a material: not 0 if it is a clear pane everywhere.
inline uint8_t pane_kind(const Material& m) {
  bool clear = m.transmission == 1 && m.transmission_texture.texture < 0 && m.thickness == 0 &&
               m.metallic == 0 && m.roughness == 0 && m.alpha_mode == AlphaMode::opaque && !m.unlit;
  if (!clear || m.anisotropy > 0 || m.clearcoat > 0 || m.sheen_color != vec3(0)) return 0;
  bool alike = m.base_color_texture.texture < 0 && m.specular_texture.texture < 0 &&
               m.specular_color_texture.texture < 0 && m.normal_texture.texture < 0 &&
               m.emission_texture.texture < 0;
  return alike ? 1 : 2;
}

// Returns whether some place of it may be polished: it shows a picture of others
// (light/visible/guides.h).
inline bool may_be_polished(const Material& m, TextureRanges& ranges) {
  if (m.unlit) return false;
  if (m.transmission > 0) return true;
  float roughness = m.roughness * ranges.of(m.metallic_roughness_texture).low.y;
  return roughness * roughness < polished_alpha;
}

// Returns whether some place of it has highlights (light/visible/facet.h), which are seen without
// rays.
inline bool may_gloss(const Material& m, TextureRanges& ranges) {
  if (m.unlit || m.transmission > 0) return false;
  const TexelRange& range = ranges.of(m.metallic_roughness_texture);
  return m.roughness * range.low.y < least_rough || m.metallic * range.high.z >= least_metal;
}

// may_shine() returns whether some place of it reflects light that depends on the view more than
// rough paint's.
inline constexpr float least_matte = 0.5f;  // roughness, from which nothing shines
inline bool may_shine(const Material& m, TextureRanges& ranges) {
  if (m.unlit) return false;
  const TexelRange& range = ranges.of(m.metallic_roughness_texture);
  return m.metallic * range.high.z > 0 || m.roughness * range.low.y < least_matte ||
         m.transmission > 0 || m.clearcoat > 0;
}

// is_plain() returns whether all of it is diffuse but for a gloss so rough that it shows the light
// around as the diffuse layer does: an illumination map then gives all of its light.
inline constexpr float least_plain_roughness = 0.45f, most_plain_metal = 0.02f;
inline bool is_plain(const Material& m, TextureRanges& ranges) {
  if (m.unlit || m.transmission > 0 || m.alpha_mode == AlphaMode::blend || m.emission != vec3(0))
    return false;
  if (m.clearcoat > 0 || m.sheen_color != vec3(0)) return false;
  const TexelRange& range = ranges.of(m.metallic_roughness_texture);
  return m.roughness * range.low.y >= least_plain_roughness &&
         m.metallic * range.high.z <= most_plain_metal;
}

// Holds where one of the material's pictures lies on a triangle.
struct FacetPicture {
  vec2 corner{0}, edge1{0}, edge2{0};  // texture coordinates: corner + edge1 * u + edge2 * v
  float texels = 0;                    // texels across a metre of the surface
  bool known = false;                  // the mesh has these coordinates
};

struct Facet {
  uint32_t instance = 0xffffffffu, triangle = 0;
  const PlacedMesh* placed = nullptr;
  const Material* material = nullptr;
  uvec3 corner{0};
  vec3 normal[3];            // the mesh's at the corners, world, not unit, on the winding's side
  vec3 face{0};              // geometric, unit, on the winding's side
  float root_area = 0;       // root of the face's area, metres
  float plane_distance = 0;  // from the eye to the plane it lies in, metres
  bool one_normal = false;
  bool front = false;  // the eye is on the winding's side
  // Base colour; metallic and roughness, of a material that may be metal, or once place_shine() was
  // called.
  FacetPicture base, shine;
  // Map of normals, and unit vectors along its u and v on the winding's side; the same all over.
  // They are set once place_relief() was called, if there is a map.
  FacetPicture relief;
  vec3 tangent{0}, bitangent{0};
  // Place of its light, set by the first look-up: as IlluminationChart has it, counted in tiles.
  const struct IlluminationCharts* charts = nullptr;
  uint32_t chart = 0xffffffffu;
  vec2 light_corner{0}, light_edge1{0}, light_edge2{0};
};
Facet make_facet(const World& world, uint32_t instance, uint32_t triangle, vec3 eye);
FacetPicture place_picture(const World& world, const Facet& facet, const TextureRef& reference);
void place_shine(const World& world, Facet& facet);
void place_relief(const World& world, Facet& facet);

// Keeps recent facets: rows of a picture meet the same triangles one after the other.
class FacetCache {
 public:
  // Forgets everything when `picture` is another number than before.
  void start(uint64_t picture) {
    if (picture == picture_) return;
    picture_ = picture;
    for (Facet& f : facets_) f.instance = 0xffffffffu;
  }
  Facet& find(const World& world, uint32_t instance, uint32_t triangle, vec3 eye) {
    Facet& f = facets_[(triangle * 0x9e3779b1u ^ instance * 0x85ebca6bu) >> (32 - bits)];
    if (f.triangle != triangle || f.instance != instance)
      f = make_facet(world, instance, triangle, eye);
    return f;
  }

 private:
  static constexpr int bits = 9;
  uint64_t picture_ = ~uint64_t(0);
  Facet facets_[1 << bits];
};

// Shades what one pixel sees of the triangle it shows (light/visible/facet.h), pictures averaged
// over the pixel.

// Holds pictures with their smaller versions, all that a scene's reflectance is made of.
struct Pictures {
  const Scene* scene = nullptr;
  std::vector<TexturePyramid> pyramids;  // one for each image; empty if none is needed
};

// Makes them on all cores.
Pictures make_pictures(const Scene& scene);

// Returns a pixel's width in metres on the surface it sees: the root of its area there.
inline float pixel_width(const Facet& f, float distance, float pixel_angle) {
  const float cosine = f.plane_distance / distance;
  return distance * pixel_angle / std::sqrt(std::max(cosine, 0.02f));
}

inline bool emits(const Facet& f) {
  return (f.front || f.material->double_sided) && f.material->emission != vec3(0);
}

// Returns what a pixel sees. `metal`: its material's; `pixel`: its width on the surface, metres.
// `large`: the texel of its base colour, if that is a very large picture (world/large_texture.h).
PrimaryHit see_facet(const Pictures& pictures, const World& world, const Facet& f,
                     MetalDemodulation metal, const Hit& hit, float pixel, const vec3* large);

Gloss see_gloss(const Pictures& pictures, const Facet& f, vec2 barycentric, float pixel);

}  // namespace wellspring::light
