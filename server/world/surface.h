// SPDX-License-Identifier: Apache-2.0
// Turns a hit into a place with a material: interpolated, textured, ready for a BSDF. No
// randomness.
#pragma once
#include "base/simd.h"
#include "world/world.h"

namespace wellspring::world {

// Holds where a ray ended, as far as the next ray that leaves there needs it.
struct SurfacePlace {
  vec3 position{0};
  vec3 geometric_normal{0, 1, 0};  // unit, on the side the ray came from
  // Bounds the error of `position`: the largest coordinate of the triangle's corners; below 0, in
  // scenes with something small far away and on stand-ins: minus the metres by which the next ray
  // starts off the surface.
  float extent = 0;
};
// Returns how far off `position` may be, in metres.
inline float position_error(const SurfacePlace& place) {
  return place.extent < 0 ? -place.extent : place.extent * 0x1p-20f;  // eight units of the corners
}

struct Surface : SurfacePlace {
  vec3 normal{0, 1, 0};  // shading normal after normal map, same hemisphere as geometric_normal
  bool front = true;     // the ray came from the side the triangle's winding faces
  uint32_t instance = 0, triangle = 0, object = 0;
  vec2 barycentric{0};
  int material = 0;
  // Resolved material values at this place (textures and vertex colours applied).
  vec3 base_color{1};
  float alpha = 1;
  float metallic = 0, roughness = 1;
  vec3 emission{0};  // 0 when seen from the back of a single-sided material
  float transmission = 0, thickness = 0;
  float specular = 1;
  vec3 specular_color{1};
  float anisotropy = 0;
  vec3 tangent{0};  // unit, direction in which it is rougher; only if anisotropy > 0
  float clearcoat = 0, clearcoat_roughness = 0;
  vec3 clearcoat_normal{0, 1, 0};  // only if clearcoat > 0
  vec3 sheen_color{0};
  float sheen_roughness = 0;
};

// Holds all there is to a surface of which only `base_color` shows: see is_lambertian.
struct LambertSurface : SurfacePlace {
  vec3 normal{0, 1, 0};  // as in Surface
  vec3 base_color{1};
};
// Returns whether only Lambert's law can apply to the material: opaque except for its alpha, no
// gloss, no light of its own, no map of normals.
bool is_lambertian(const Material& material);

// Evaluates the surface at a hit. `hit` must be valid().
Surface eval_surface(const World& world, const Ray& ray, const Hit& hit);
// Returns Surface::normal of that hit as it would be without a map of normals.
vec3 eval_mesh_normal(const World& world, const Ray& ray, const Hit& hit);
// Returns the same values in less time, if the material is_lambertian.
LambertSurface eval_lambert_surface(const World& world, const Ray& ray, const Hit& hit);
// Returns whether a ray of that direction meets the triangle from the side that its winding does
// not face.
bool is_behind(const PlacedMesh& placed, uint32_t triangle, vec3 direction);
// Returns the position on a triangle at barycentric weights of its second and third corner, world
// space.
vec3 eval_position(const World& world, uint32_t instance, uint32_t triangle, vec2 barycentric);
// Returns the unit geometric normal towards the side the winding faces (0, 1, 0 for a triangle
// without area), and the triangle's area through `area` if given, both in world space.
vec3 eval_face(const World& world, uint32_t instance, uint32_t triangle, float* area = nullptr);
// Returns all of that at once, from the mesh's own lists.
Face make_face(const PlacedMesh& placed, uint32_t triangle);
// Returns an origin for a ray leaving `place` along `direction` that does not hit the same surface
// again (Waechter and Binder, Ray Tracing Gems chapter 6), farther off if a large triangle's
// corners make its places less exact than their own coordinates.
vec3 offset_origin(const SurfacePlace& place, vec3 direction);

// Does what surface.h does for Lambertian surfaces, for eight hits side by side. Each lane's answer
// is its own, whatever the other lanes hold.

struct LambertSurfaceLanes {
  Lanes3 position, geometric_normal, normal, base_color;
  Lanes extent{};
  unsigned bent = 0;  // bit i: the normal of lane i may differ from the geometric one
  SurfacePlace place(int lane) const {
    SurfacePlace one;
    one.position = position.at(lane);
    one.geometric_normal = geometric_normal.at(lane);
    one.extent = extent[lane];
    return one;
  }
};
// Returns eval_lambert_surface() of hits[i] for the bits of `active`, met by rays of those unit
// directions.
LambertSurfaceLanes eval_lambert_surfaces(const World& world, const Lanes3& direction,
                                          const Hit* hits, unsigned active);
Lanes3 offset_origins(const LambertSurfaceLanes& surface, const Lanes3& direction);

}  // namespace wellspring::world
