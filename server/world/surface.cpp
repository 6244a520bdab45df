// SPDX-License-Identifier: Apache-2.0
#include "world/surface.h"

#include <bit>
#include <cmath>

namespace wellspring {
namespace {

// The triangle of a hit with its weights; interpolates any per-vertex list.
struct Corners {
  uvec3 index;
  vec3 weight;
  template <class T>
  T operator()(const std::vector<T>& values) const {
    return values[index.x] * weight.x + values[index.y] * weight.y + values[index.z] * weight.z;
  }
};

Corners corners_of(const Mesh& mesh, uint32_t triangle, vec2 barycentric) {
  return {mesh.triangles[triangle],
          {1 - barycentric.x - barycentric.y, barycentric.x, barycentric.y}};
}

struct Face {
  vec3 corner[3];
  vec3 cross_product;  // towards the winding's front, twice the area long
};

Face face_of(const PlacedMesh& placed, uvec3 index) {
  Face face;
  for (int i = 0; i < 3; i++) {
    vec3 p = placed.mesh->positions[index[i]];
    face.corner[i] = placed.moving ? p : vec3(placed.to_world * vec4(p, 1));
  }
  face.cross_product = cross(face.corner[1] - face.corner[0], face.corner[2] - face.corner[0]);
  if (placed.mirrored) face.cross_product = -face.cross_product;
  return face;
}

// Unit vector, or `otherwise` where there is no direction. Scaled first: slivers must not
// underflow.
vec3 unit_or(vec3 v, vec3 otherwise) {
  float largest = max_component(glm::abs(v));
  if (!(largest > 1e-30f) || !std::isfinite(largest)) return otherwise;
  v /= largest;
  return v / std::sqrt(dot(v, v));
}

vec4 lookup(const Scene& scene, const Mesh& mesh, const Corners& at, const TextureRef& reference) {
  if (reference.texture < 0) return vec4(1);
  const Texture& texture = scene.textures[size_t(reference.texture)];
  if (texture.image < 0) return vec4(1);
  const std::vector<vec2>& set = mesh.uv[reference.uv_set];
  vec2 uv = set.empty() ? vec2(0) : at(set);
  return eval_texture(scene.images[size_t(texture.image)], texture,
                      vec2(reference.uv_transform * vec3(uv, 1)));
}

// glTF 2.0 section 3.9.3: the map's normal in the frame of tangent, bitangent and normal.
vec3 mapped_normal(const Scene& scene, const PlacedMesh& placed, const Corners& at, vec3 normal) {
  const Mesh& mesh = *placed.mesh;
  const Material& material = *placed.material;
  if (material.normal_texture.texture < 0 || mesh.tangents.empty()) return normal;
  vec3 map = vec3(lookup(scene, mesh, at, material.normal_texture)) * 2.0f - 1.0f;
  map *= vec3(material.normal_scale, material.normal_scale, 1);
  vec4 local = at(mesh.tangents);
  vec3 tangent = placed.moving ? vec3(local) : mat3(placed.to_world) * vec3(local);
  tangent = unit_or(tangent - normal * dot(normal, tangent), vec3(0));
  vec3 bitangent = cross(normal, tangent) * (mesh.tangents[at.index.x].w < 0 ? -1.0f : 1.0f);
  if (placed.mirrored) bitangent = -bitangent;
  return unit_or(tangent * map.x + bitangent * map.y + normal * map.z, normal);
}

void resolve_material(const Scene& scene, const PlacedMesh& placed, const Corners& at,
                      Surface& surface) {
  const Mesh& mesh = *placed.mesh;
  const Material& m = *placed.material;
  vec4 base = m.base_color * lookup(scene, mesh, at, m.base_color_texture);
  if (!mesh.colors.empty()) base *= at(mesh.colors);
  surface.base_color = glm::max(vec3(base), vec3(0));
  surface.alpha = glm::clamp(base.w, 0.0f, 1.0f);
  surface.metallic = m.metallic;
  surface.roughness = m.roughness;
  if (m.metallic_roughness_texture.texture >= 0) {
    vec4 t = lookup(scene, mesh, at, m.metallic_roughness_texture);
    surface.roughness *= t.y;
    surface.metallic *= t.z;
  }
  surface.emission = vec3(0);
  if (surface.front || m.double_sided)
    surface.emission = m.emission * vec3(lookup(scene, mesh, at, m.emission_texture));
  surface.transmission = m.transmission;
  if (m.transmission > 0 && m.transmission_texture.texture >= 0)
    surface.transmission *= lookup(scene, mesh, at, m.transmission_texture).x;
  surface.thickness = m.thickness;
  if (m.thickness > 0 && m.thickness_texture.texture >= 0)
    surface.thickness *= lookup(scene, mesh, at, m.thickness_texture).y;
}

}  // namespace

Surface eval_surface(const World& world, const Ray& ray, const Hit& hit) {
  const Scene& scene = world.scene();
  const PlacedMesh& placed = world.placed(hit.instance);
  const Mesh& mesh = *placed.mesh;
  Corners at = corners_of(mesh, hit.triangle, hit.barycentric);
  Face face = face_of(placed, at.index);

  Surface surface;
  surface.instance = hit.instance;
  surface.triangle = hit.triangle;
  surface.object = placed.object;
  surface.barycentric = hit.barycentric;
  surface.material = mesh.material;
  surface.position =
      face.corner[0] * at.weight.x + face.corner[1] * at.weight.y + face.corner[2] * at.weight.z;
  surface.extent = max_component(glm::max(
      glm::max(glm::abs(face.corner[0]), glm::abs(face.corner[1])), glm::abs(face.corner[2])));

  vec3 geometric = unit_or(face.cross_product, unit_or(-ray.direction, vec3(0, 1, 0)));
  surface.front = dot(geometric, ray.direction) <= 0;
  // The shading normal is made on the winding's side, where its map was painted, then turned.
  vec3 shading = at(mesh.normals);
  if (!placed.moving) shading = placed.normal_to_world * shading;
  shading = unit_or(shading, geometric);
  shading = mapped_normal(scene, placed, at, shading);
  if (!surface.front) {
    geometric = -geometric;
    shading = -shading;
  }
  // Interpolated or mapped beyond the horizon: brought back onto it, just above.
  float height = dot(shading, geometric);
  if (height < 1e-3f) shading = unit_or(shading + geometric * (1e-3f - height), geometric);
  surface.geometric_normal = geometric;
  surface.normal = shading;
  if (!mesh.uv[0].empty()) surface.uv = at(mesh.uv[0]);
  resolve_material(scene, placed, at, surface);
  return surface;
}

vec3 eval_position(const World& world, uint32_t instance, uint32_t triangle, vec2 barycentric) {
  const PlacedMesh& placed = world.placed(instance);
  Corners at = corners_of(*placed.mesh, triangle, barycentric);
  Face face = face_of(placed, at.index);
  return face.corner[0] * at.weight.x + face.corner[1] * at.weight.y + face.corner[2] * at.weight.z;
}

vec3 eval_face(const World& world, uint32_t instance, uint32_t triangle, float* area) {
  const PlacedMesh& placed = world.placed(instance);
  Face face = face_of(placed, placed.mesh->triangles[triangle]);
  if (area) *area = 0.5f * length(face.cross_product);
  return unit_or(face.cross_product, vec3(0, 1, 0));
}

vec3 offset_origin(const Surface& surface, vec3 direction) {
  constexpr float near_zero = 1.0f / 32, float_scale = 1.0f / 65536, int_scale = 256;
  constexpr float relative_error = 0x1p-20f;  // eight units in the last place of the corners
  vec3 normal = surface.geometric_normal;
  if (dot(normal, direction) < 0) normal = -normal;
  vec3 p = surface.position, moved;
  for (int i = 0; i < 3; i++) {
    int32_t steps = int32_t(int_scale * normal[i]);
    int32_t bits = std::bit_cast<int32_t>(p[i]);
    float stepped = std::bit_cast<float>(bits + (p[i] < 0 ? -steps : steps));
    moved[i] = std::abs(p[i]) < near_zero ? p[i] + float_scale * normal[i] : stepped;
  }
  float least = surface.extent * relative_error;
  float have = dot(moved - p, normal);
  return have < least ? moved + normal * (least - have) : moved;
}

}  // namespace wellspring
