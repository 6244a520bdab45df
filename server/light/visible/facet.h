// SPDX-License-Identifier: Apache-2.0
// A triangle as a picture of it needs it: what every pixel of it has in common, looked up once.
#pragma once
#include "world/surface.h"

namespace wellspring::light {

// Where one of the material's pictures lies on a triangle.
struct FacetPicture {
  vec2 corner{0}, edge1{0}, edge2{0};  // texture coordinates: corner + edge1 * u + edge2 * v
  float texels = 0;                    // across a metre of the surface
  bool known = false;                  // the mesh has these coordinates
};

struct Facet {
  uint32_t instance = 0xffffffffu, triangle = 0;
  const PlacedMesh* placed = nullptr;
  const Material* material = nullptr;
  uvec3 corner{0};
  vec3 normal[3];            // of the mesh at the corners, world, not unit, on the winding's side
  vec3 face{0};              // geometric, unit, on the winding's side
  float root_area = 0;       // of the face, metres
  float plane_distance = 0;  // from the eye to the plane it lies in, metres
  bool one_normal = false;
  bool front = false;  // the eye is on the winding's side
  // Base colour; metallic and roughness, of what may be metal, or once place_shine() was called.
  FacetPicture base, shine;
  // The map of normals, and along its u and v on the winding's side, unit; alike all over. Known
  // once place_relief() was called, where there is one.
  FacetPicture relief;
  vec3 tangent{0}, bitangent{0};
  // Its light lies here, once somebody has asked: as IlluminationChart has it, counted in tiles.
  const struct IlluminationCharts* charts = nullptr;
  uint32_t chart = 0xffffffffu;
  vec2 light_corner{0}, light_edge1{0}, light_edge2{0};
};
Facet make_facet(const World& world, uint32_t instance, uint32_t triangle, vec3 eye);
FacetPicture place_picture(const World& world, const Facet& facet, const TextureRef& reference);
void place_shine(const World& world, Facet& facet);
void place_relief(const World& world, Facet& facet);

// Facets of late: rows of a picture meet the same triangles one after the other.
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

}  // namespace wellspring::light
