// SPDX-License-Identifier: Apache-2.0
#include "world/surface.h"

#include <algorithm>
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
    face.corner[i] = placed.in_place ? p : vec3(placed.to_world * vec4(p, 1));
  }
  face.cross_product = cross(face.corner[1] - face.corner[0], face.corner[2] - face.corner[0]);
  if (placed.mirrored) face.cross_product = -face.cross_product;
  return face;
}

// Unit vector, or `otherwise` where there is no direction. Scaled first: slivers must not
// underflow.
vec3 rare_unit_or(vec3 v, vec3 otherwise) {
  float largest = max_component(glm::abs(v));
  if (!(largest > 1e-30f) || !std::isfinite(largest)) return otherwise;
  v /= largest;
  return v / std::sqrt(dot(v, v));
}
inline vec3 unit_or(vec3 v, vec3 otherwise) {
  float length2 = dot(v, v);
  bool usual = length2 > 1e-25f && length2 < 1e25f;
  return usual ? v / std::sqrt(length2) : rare_unit_or(v, otherwise);
}

vec4 read_picture(const Scene& scene, const Mesh& mesh, const Corners& at,
                  const TextureRef& reference) {
  const Texture& texture = scene.textures[size_t(reference.texture)];
  if (texture.image < 0) return vec4(1);
  const std::vector<vec2>& set = mesh.uv[reference.uv_set];
  vec2 uv = set.empty() ? vec2(0) : at(set);
  return eval_texture(scene.images[size_t(texture.image)], texture,
                      vec2(reference.uv_transform * vec3(uv, 1)));
}
inline vec4 lookup(const Scene& scene, const Mesh& mesh, const Corners& at,
                   const TextureRef& reference) {
  return reference.texture < 0 ? vec4(1) : read_picture(scene, mesh, at, reference);
}

// Along u and v of the picture, on the winding's side; the mesh must have tangents.
struct TangentFrame {
  vec3 tangent, bitangent;  // zero where the mesh gives no direction
};

TangentFrame tangent_frame(const PlacedMesh& placed, const Corners& at, vec3 normal) {
  const Mesh& mesh = *placed.mesh;
  vec4 local = at(mesh.tangents);
  vec3 tangent = placed.moving ? vec3(local) : mat3(placed.to_world) * vec3(local);
  tangent = unit_or(tangent - normal * dot(normal, tangent), vec3(0));
  vec3 bitangent = cross(normal, tangent) * (mesh.tangents[at.index.x].w < 0 ? -1.0f : 1.0f);
  return {tangent, placed.mirrored ? -bitangent : bitangent};
}

// glTF 2.0 section 3.9.3: the map's normal in the frame of tangent, bitangent and normal.
vec3 mapped_normal(const Scene& scene, const PlacedMesh& placed, const Corners& at, vec3 normal,
                   const TextureRef& texture, float scale) {
  const Mesh& mesh = *placed.mesh;
  if (texture.texture < 0 || mesh.tangents.empty()) return normal;
  vec3 map = (vec3(lookup(scene, mesh, at, texture)) * 2.0f - 1.0f) * vec3(scale, scale, 1);
  TangentFrame frame = tangent_frame(placed, at, normal);
  return unit_or(frame.tangent * map.x + frame.bitangent * map.y + normal * map.z, normal);
}

// The side the ray came from; interpolated or mapped beyond the horizon: brought back, just above.
vec3 turned_to_viewer(vec3 normal, vec3 geometric, bool front) {
  if (!front) normal = -normal;
  float height = dot(normal, geometric);
  return height < 1e-3f ? unit_or(normal + geometric * (1e-3f - height), geometric) : normal;
}

// KHR_materials_anisotropy: the picture's direction, turned by the factor's angle.
void resolve_anisotropy(const Scene& scene, const PlacedMesh& placed, const Corners& at,
                        vec3 normal, Surface& surface) {
  const Mesh& mesh = *placed.mesh;
  const Material& m = *placed.material;
  if (mesh.tangents.empty()) return;
  vec2 along(std::cos(m.anisotropy_rotation), std::sin(m.anisotropy_rotation));
  float strength = m.anisotropy;
  if (m.anisotropy_texture.texture >= 0) {
    vec4 t = lookup(scene, mesh, at, m.anisotropy_texture);
    vec2 map = vec2(t) * 2.0f - 1.0f;
    along = {along.x * map.x - along.y * map.y, along.y * map.x + along.x * map.y};
    strength *= t.z;
  }
  TangentFrame frame = tangent_frame(placed, at, normal);
  surface.tangent = unit_or(frame.tangent * along.x + frame.bitangent * along.y, vec3(0));
  if (surface.tangent != vec3(0)) surface.anisotropy = strength;
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
  if ((surface.front || m.double_sided) && m.emission != vec3(0))
    surface.emission = m.emission * vec3(lookup(scene, mesh, at, m.emission_texture));
  surface.transmission = m.transmission;
  if (m.transmission > 0 && m.transmission_texture.texture >= 0)
    surface.transmission *= lookup(scene, mesh, at, m.transmission_texture).x;
  surface.thickness = m.thickness;
  if (m.thickness > 0 && m.thickness_texture.texture >= 0)
    surface.thickness *= lookup(scene, mesh, at, m.thickness_texture).y;
  surface.specular = m.specular;
  if (m.specular_texture.texture >= 0)
    surface.specular *= lookup(scene, mesh, at, m.specular_texture).w;
  surface.specular_color = m.specular_color;
  if (m.specular_color_texture.texture >= 0)
    surface.specular_color *= vec3(lookup(scene, mesh, at, m.specular_color_texture));
}

// KHR_materials_clearcoat and KHR_materials_sheen. `normal`: as interpolated, before any map.
void resolve_layers(const Scene& scene, const PlacedMesh& placed, const Corners& at, vec3 normal,
                    Surface& surface) {
  const Mesh& mesh = *placed.mesh;
  const Material& m = *placed.material;
  if (m.clearcoat > 0) {
    surface.clearcoat = m.clearcoat;
    if (m.clearcoat_texture.texture >= 0)
      surface.clearcoat *= lookup(scene, mesh, at, m.clearcoat_texture).x;
    surface.clearcoat_roughness = m.clearcoat_roughness;
    if (m.clearcoat_roughness_texture.texture >= 0)
      surface.clearcoat_roughness *= lookup(scene, mesh, at, m.clearcoat_roughness_texture).y;
    vec3 mapped = mapped_normal(scene, placed, at, normal, m.clearcoat_normal_texture,
                                m.clearcoat_normal_scale);
    surface.clearcoat_normal = turned_to_viewer(mapped, surface.geometric_normal, surface.front);
  }
  if (max_component(m.sheen_color) > 0) {
    surface.sheen_color = m.sheen_color;
    if (m.sheen_color_texture.texture >= 0)
      surface.sheen_color *= vec3(lookup(scene, mesh, at, m.sheen_color_texture));
    surface.sheen_roughness = m.sheen_roughness;
    if (m.sheen_roughness_texture.texture >= 0)
      surface.sheen_roughness *= lookup(scene, mesh, at, m.sheen_roughness_texture).w;
  }
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

  vec3 geometric = unit_or(face.cross_product, vec3(0));
  if (geometric == vec3(0)) geometric = unit_or(-ray.direction, vec3(0, 1, 0));
  surface.front = dot(geometric, ray.direction) <= 0;
  // The shading normal is made on the winding's side, where its map was painted, then turned.
  vec3 shading = at(mesh.normals);
  if (!placed.in_place) shading = placed.normal_to_world * shading;
  shading = unit_or(shading, geometric);
  const Material& material = *placed.material;
  vec3 mapped = shading;
  if (material.normal_texture.texture >= 0)
    mapped = mapped_normal(scene, placed, at, shading, material.normal_texture,
                           material.normal_scale);
  if (!surface.front) geometric = -geometric;
  surface.geometric_normal = geometric;
  surface.normal = turned_to_viewer(mapped, geometric, surface.front);
  resolve_material(scene, placed, at, surface);
  if (material.anisotropy > 0) resolve_anisotropy(scene, placed, at, shading, surface);
  resolve_layers(scene, placed, at, shading, surface);
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
  // Their constants are for scenes of metres; in a scene of millimetres they would be a gap.
  float unit = surface.extent > 0 ? std::min(surface.extent, 1.0f) : 1.0f;
  float near_zero = unit / 32, float_scale = unit / 65536;
  constexpr float int_scale = 256;
  constexpr float relative_error = 0x1p-20f;  // eight units in the last place of the corners
  vec3 normal = surface.geometric_normal;
  if (dot(normal, direction) < 0) normal = -normal;
  vec3 p = surface.position, moved;
  float near_step = float_scale * std::min(surface.extent, 1.0f);  // tiny scenes, tiny steps
  for (int i = 0; i < 3; i++) {
    int32_t steps = int32_t(int_scale * normal[i]);
    int32_t bits = std::bit_cast<int32_t>(p[i]);
    float stepped = std::bit_cast<float>(bits + (p[i] < 0 ? -steps : steps));
    moved[i] = std::abs(p[i]) < near_zero ? p[i] + near_step * normal[i] : stepped;
  }
  float least = surface.extent * relative_error;
  float have = dot(moved - p, normal);
  return have < least ? moved + normal * (least - have) : moved;
}

}  // namespace wellspring
