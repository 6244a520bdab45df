// SPDX-License-Identifier: Apache-2.0
#include "world/surface.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "world/large_texture.h"

namespace wellspring::world {
namespace {

// Holds the triangle of a hit with its weights; interpolates any per-vertex list.
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

// Returns the unit vector, or `otherwise` if there is no direction. Scales first: slivers must not
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

// Returns the interpolated normal on the winding's side, for which its map was painted.
inline vec3 shading_normal(const PlacedMesh& placed, const Corners& at, vec3 winding) {
  vec3 shading = at(placed.mesh->normals);
  if (!placed.in_place) shading = placed.normal_to_world * shading;
  return unit_or(shading, winding);
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

// Holds directions along u and v of the picture, on the winding's side; the mesh must have
// tangents.
struct TangentFrame {
  vec3 tangent, bitangent;  // zero if the mesh gives no direction
};

TangentFrame tangent_frame(const PlacedMesh& placed, const Corners& at, vec3 normal) {
  const Mesh& mesh = *placed.mesh;
  vec4 local = at(mesh.tangents);
  vec3 tangent = placed.moving ? vec3(local) : mat3(placed.to_world) * vec3(local);
  tangent = unit_or(tangent - normal * dot(normal, tangent), vec3(0));
  vec3 bitangent = cross(normal, tangent) * (mesh.tangents[at.index.x].w < 0 ? -1.0f : 1.0f);
  return {tangent, placed.mirrored ? -bitangent : bitangent};
}

// Returns the map's normal in the frame of tangent, bitangent and normal (glTF 2.0 section 3.9.3).
vec3 mapped_normal(const Scene& scene, const PlacedMesh& placed, const Corners& at, vec3 normal,
                   const TextureRef& texture, float scale) {
  const Mesh& mesh = *placed.mesh;
  if (texture.texture < 0 || mesh.tangents.empty()) return normal;
  vec3 map = (vec3(lookup(scene, mesh, at, texture)) * 2.0f - 1.0f) * vec3(scale, scale, 1);
  TangentFrame frame = tangent_frame(placed, at, normal);
  return unit_or(frame.tangent * map.x + frame.bitangent * map.y + normal * map.z, normal);
}

// Turns a normal to the side the ray came from; one beyond the horizon, by interpolation or a map,
// is brought back just above it.
vec3 turned_to_viewer(vec3 normal, vec3 geometric, bool front) {
  if (!front) normal = -normal;
  float height = dot(normal, geometric);
  return height < 1e-3f ? unit_or(normal + geometric * (1e-3f - height), geometric) : normal;
}

// Applies KHR_materials_anisotropy: the picture's direction, turned by the factor's angle.
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

// Returns the base colour's texel where a cone from the eye meets a very large picture.
vec4 read_large_base(const Scene& scene, const PlacedMesh& placed, const Ray& ray, const Hit& hit,
                     vec4 small) {
  const TextureRef& reference = placed.material->base_color_texture;
  const Texture& texture = scene.textures[size_t(reference.texture)];
  const PicturedTriangle t = make_pictured_triangle(placed, hit.triangle, reference, ray.origin);
  return {eval_large_picture(*placed.picture, texture, t, ray, hit), small.w};
}

void resolve_material(const Scene& scene, const PlacedMesh& placed, const Corners& at,
                      const Ray& ray, const Hit& hit, Surface& surface) {
  const Mesh& mesh = *placed.mesh;
  const Material& m = *placed.material;
  vec4 base = lookup(scene, mesh, at, m.base_color_texture);
  if (m.large_picture && ray.spread > 0) base = read_large_base(scene, placed, ray, hit, base);
  base *= m.base_color;
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

// Applies KHR_materials_clearcoat and KHR_materials_sheen. `normal`: as interpolated, before any
// map.
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

// Returns whether the winding's front faces the ray; a triangle without area faces everything.
inline bool faces_ray(vec3 winding, vec3 direction) { return dot(winding, direction) <= 0; }

// Holds the result of locate(), which fills `place`; `winding` is unit, towards the winding's
// front.
struct Side {
  vec3 winding;
  bool front;
};
inline Side locate(const Face& face, vec2 barycentric, const Ray& ray, SurfacePlace& place) {
  place.position = face.corner + face.edge1 * barycentric.x + face.edge2 * barycentric.y;
  place.extent = face.extent;
  vec3 winding = face.normal;
  if (winding == vec3(0)) winding = unit_or(-ray.direction, vec3(0, 1, 0));
  bool front = faces_ray(winding, ray.direction);
  place.geometric_normal = front ? winding : -winding;
  return {winding, front};
}

Face bare_face(const PlacedMesh& placed, uint32_t triangle) {
  const Mesh& mesh = *placed.mesh;
  uvec3 index = mesh.triangles[triangle];
  vec3 corner[3];
  for (int i = 0; i < 3; i++) {
    corner[i] = mesh.positions[index[i]];
    if (placed.apart) corner[i] = mat3(placed.to_world) * corner[i];
    else if (!placed.in_place) corner[i] = vec3(placed.to_world * vec4(corner[i], 1));
  }
  Face face;
  face.corner = corner[0];
  face.edge1 = corner[1] - corner[0];
  face.edge2 = corner[2] - corner[0];
  face.normal = unit_or(cross(face.edge1, face.edge2), vec3(0));
  if (placed.mirrored) face.normal = -face.normal;
  if (placed.apart) {
    vec3 place(placed.to_world[3]);
    for (vec3& c : corner) c += place;
    face.corner = corner[0];
  }
  const vec3 farthest =
      glm::max(glm::max(glm::abs(corner[0]), glm::abs(corner[1])), glm::abs(corner[2]));
  face.extent = max_component(farthest);
  if (placed.steps > 0) {
    // Each coordinate is rounded by its own size, and only the part along the normal counts.
    constexpr float least_step = 0x1p-16f;
    if (face.normal != vec3(0)) face.extent = dot(glm::abs(face.normal), farthest);
    face.extent = -std::max(placed.steps * 0x1p-23f * face.extent, least_step);
  }
  if (placed.stands_in) {
    // Its squares lie across one another: a ray begins beyond the neighbours.
    constexpr float beyond = 0.25f;  // sides
    face.extent = -beyond * std::min(length(face.edge1), length(face.edge2));
  }
  face.flat = 0;  // make_face() finds out
  return face;
}

// Returns the face of a hit, made in `own` if none is kept.
inline const Face& face_of(const PlacedMesh& placed, uint32_t triangle, Face& own) {
  if (placed.faces) return placed.faces[triangle];
  own = bare_face(placed, triangle);
  return own;
}

}  // namespace

Face make_face(const PlacedMesh& placed, uint32_t triangle) {
  Face face = bare_face(placed, triangle);
  face.flat = 1;
  for (int i = 0; i < 3; i++) {
    constexpr float same = 1e-6f;  // rounding of unit vectors
    vec3 weight(0);
    weight[i] = 1;
    Corners corner{placed.mesh->triangles[triangle], weight};
    vec3 off = shading_normal(placed, corner, face.normal) - face.normal;
    if (!(max_component(glm::abs(off)) <= same)) face.flat = 0;
  }
  bool one_color = placed.material->base_color_texture.texture < 0 && placed.mesh->colors.empty();
  face.plain = face.flat == 1 && one_color && face.normal != vec3(0);
  return face;
}

bool is_lambertian(const Material& m) {
  bool gloss = m.ior != 1 && m.specular > 0;
  bool layered = m.clearcoat > 0 || max_component(m.sheen_color) > 0;
  return !m.unlit && !m.repaints && !m.large_picture && !gloss && !layered && m.metallic == 0 &&
         m.transmission == 0 && m.emission == vec3(0) && m.normal_texture.texture < 0;
}

LambertSurface eval_lambert_surface(const World& world, const Ray& ray, const Hit& hit) {
  const PlacedMesh& placed = world.placed(hit.instance);
  const Material& m = *placed.material;
  const Mesh& mesh = *placed.mesh;
  Face own;
  const Face& face = face_of(placed, hit.triangle, own);
  LambertSurface surface;
  Side side = locate(face, hit.barycentric, ray, surface);
  surface.normal = surface.geometric_normal;
  vec4 base = m.base_color;
  bool textured = m.base_color_texture.texture >= 0, colored = !mesh.colors.empty();
  if (face.flat == 0 || textured || colored) {
    Corners at = corners_of(mesh, hit.triangle, hit.barycentric);
    if (face.flat == 0)
      surface.normal = turned_to_viewer(shading_normal(placed, at, side.winding),
                                        surface.geometric_normal, side.front);
    if (textured) base *= read_picture(world.scene(), mesh, at, m.base_color_texture);
    if (colored) base *= at(mesh.colors);
  }
  surface.base_color = glm::max(vec3(base), vec3(0));
  return surface;
}

Surface eval_surface(const World& world, const Ray& ray, const Hit& hit) {
  const Scene& scene = world.scene();
  const PlacedMesh& placed = world.placed(hit.instance);
  const Mesh& mesh = *placed.mesh;
  Corners at = corners_of(mesh, hit.triangle, hit.barycentric);
  Face own;
  const Face& face = face_of(placed, hit.triangle, own);

  Surface surface;
  surface.instance = hit.instance;
  surface.triangle = hit.triangle;
  surface.object = placed.object;
  surface.barycentric = hit.barycentric;
  surface.material = mesh.material;
  Side side = locate(face, hit.barycentric, ray, surface);
  surface.front = side.front;
  vec3 shading = face.flat == 1 ? side.winding : shading_normal(placed, at, side.winding);
  const Material& material = *placed.material;
  vec3 mapped = shading;
  if (material.normal_texture.texture >= 0)
    mapped =
        mapped_normal(scene, placed, at, shading, material.normal_texture, material.normal_scale);
  surface.normal = turned_to_viewer(mapped, surface.geometric_normal, surface.front);
  resolve_material(scene, placed, at, ray, hit, surface);
  if (material.anisotropy > 0) resolve_anisotropy(scene, placed, at, shading, surface);
  resolve_layers(scene, placed, at, shading, surface);
  return surface;
}

vec3 eval_mesh_normal(const World& world, const Ray& ray, const Hit& hit) {
  const PlacedMesh& placed = world.placed(hit.instance);
  Face own;
  const Face& face = face_of(placed, hit.triangle, own);
  Corners at = corners_of(*placed.mesh, hit.triangle, hit.barycentric);
  SurfacePlace place;
  const Side side = locate(face, hit.barycentric, ray, place);
  return turned_to_viewer(shading_normal(placed, at, side.winding), place.geometric_normal,
                          side.front);
}

bool is_behind(const PlacedMesh& placed, uint32_t triangle, vec3 direction) {
  Face own;
  return !faces_ray(face_of(placed, triangle, own).normal, direction);
}

vec3 eval_position(const World& world, uint32_t instance, uint32_t triangle, vec2 barycentric) {
  Face own;
  const Face& face = face_of(world.placed(instance), triangle, own);
  return face.corner + face.edge1 * barycentric.x + face.edge2 * barycentric.y;
}

vec3 eval_face(const World& world, uint32_t instance, uint32_t triangle, float* area) {
  Face own;
  const Face& face = face_of(world.placed(instance), triangle, own);
  if (area) *area = 0.5f * length(cross(face.edge1, face.edge2));
  return face.normal == vec3(0) ? vec3(0, 1, 0) : face.normal;
}

vec3 offset_origin(const SurfacePlace& place, vec3 direction) {
  if (place.extent < 0) {
    bool behind = dot(place.geometric_normal, direction) < 0;
    return place.position + place.geometric_normal * (behind ? place.extent : -place.extent);
  }
  // The paper's constants are for scenes of metres; in a scene of millimetres they would be a gap.
  float unit = place.extent > 0 ? std::min(place.extent, 1.0f) : 1.0f;
  float near_zero = unit / 32, float_scale = unit / 65536;
  constexpr float int_scale = 256;
  vec3 normal = place.geometric_normal;
  if (dot(normal, direction) < 0) normal = -normal;
  vec3 p = place.position, moved;
  float near_step = float_scale * std::min(place.extent, 1.0f);  // tiny scenes, tiny steps
  for (int i = 0; i < 3; i++) {
    int32_t steps = int32_t(int_scale * normal[i]);
    int32_t bits = std::bit_cast<int32_t>(p[i]);
    float stepped = std::bit_cast<float>(bits + (p[i] < 0 ? -steps : steps));
    moved[i] = std::abs(p[i]) < near_zero ? p[i] + near_step * normal[i] : stepped;
  }
  float least = position_error(place);
  float have = dot(moved - p, normal);
  return have < least ? moved + normal * (least - have) : moved;
}

namespace {

static_assert(sizeof(Face) == 2 * sizeof(Lanes), "a face is two rows of eight numbers");

// Takes the lowest lane's number from `bits`.
inline int next_lane(unsigned& bits) {
  int lane = std::countr_zero(bits);
  bits &= bits - 1;
  return lane;
}

}  // namespace

LambertSurfaceLanes eval_lambert_surfaces(const World& world, const Lanes3& direction,
                                          const Hit* hits, unsigned active) {
  static const Face nowhere{};
  LambertSurfaceLanes s;
  const Face* faces[lane_count];
  Face own[lane_count];  // faces of lanes that are not plain, flat at the hit
  float color[3][lane_count] = {};
  for (int i = 0; i < lane_count; i++) faces[i] = &nowhere;
  Lanes u{}, v{};
  for (unsigned bits = active; bits;) {
    int i = next_lane(bits);
    const Hit& hit = hits[i];
    const PlacedMesh& placed = world.placed(hit.instance);
    faces[i] = placed.faces ? placed.faces + hit.triangle : &nowhere;
    vec3 base = vec3(placed.material->base_color);
    if (faces[i]->plain == 1) {
      u[i] = hit.barycentric.x, v[i] = hit.barycentric.y;
    } else {
      Ray ray;
      ray.direction = direction.at(i);
      LambertSurface surface = eval_lambert_surface(world, ray, hit);
      own[i] = nowhere;
      own[i].corner = surface.position;
      own[i].extent = surface.extent;
      own[i].normal = surface.geometric_normal;
      faces[i] = &own[i];
      base = surface.base_color;
      s.normal.set(i, surface.normal);
      s.bent |= 1u << i;
    }
    for (int c = 0; c < 3; c++) color[c][i] = base[c];
  }
  Lanes first[lane_count], second[lane_count];
  for (int i = 0; i < lane_count; i++) {
    first[i] = load_lanes(&faces[i]->corner.x);
    second[i] = load_lanes(&faces[i]->edge2.x);
  }
  transpose_lanes(first);
  transpose_lanes(second);
  Lanes3 corner{first[0], first[1], first[2]}, edge1{first[4], first[5], first[6]},
      edge2{second[0], second[1], second[2]}, winding{second[4], second[5], second[6]};
  s.extent = first[3];
  s.position = corner + edge1 * u + edge2 * v;
  s.geometric_normal = choose(dot(winding, direction) <= 0, winding, -winding);
  s.normal = choose(lanes_of_bits(s.bent), s.normal, s.geometric_normal);
  const Lanes zero{};
  s.base_color = {lanes_max(load_lanes(color[0]), zero), lanes_max(load_lanes(color[1]), zero),
                  lanes_max(load_lanes(color[2]), zero)};
  return s;
}

Lanes3 offset_origins(const LambertSurfaceLanes& s, const Lanes3& direction) {
  // These are offset_origin's constants, for the same reasons.
  const Lanes one = all_lanes(1), zero{};
  Lanes small = lanes_min(s.extent, one), unit = s.extent > zero ? small : one;
  Lanes near_zero = unit / 32, near_step = unit / 65536 * small;
  Lanes3 n =
      choose(dot(s.geometric_normal, direction) < zero, -s.geometric_normal, s.geometric_normal);
  auto move = [&](Lanes p, Lanes normal) {
    LaneMask steps = __builtin_convertvector(256 * normal, LaneMask);
    Lanes stepped = Lanes(LaneMask(p) + (p < zero ? -steps : steps));
    return lanes_abs(p) < near_zero ? p + near_step * normal : stepped;
  };
  const LaneMask known = s.extent < zero;
  const Lanes3 apart = s.position + n * lanes_max(-s.extent, zero);
  if (negative_lanes(~known) == 0) return apart;
  Lanes3 moved{move(s.position.x, n.x), move(s.position.y, n.y), move(s.position.z, n.z)};
  Lanes least = s.extent * 0x1p-20f;
  Lanes short_of = least - dot(moved - s.position, n);
  return choose(known, apart, moved + n * (short_of > zero ? short_of : zero));
}

}  // namespace wellspring::world
