// SPDX-License-Identifier: Apache-2.0
#include "light/visible/facet.h"

#include <algorithm>
#include <cmath>

namespace wellspring::light {

FacetPicture place_picture(const World& world, const Facet& facet, const TextureRef& reference) {
  const Scene& scene = world.scene();
  const Mesh& mesh = *facet.placed->mesh;
  FacetPicture p;
  if (reference.texture < 0) return p;
  const std::vector<vec2>& uv = mesh.uv[reference.uv_set];
  int image = scene.textures[size_t(reference.texture)].image;
  if (uv.empty() || image < 0) return p;
  auto at = [&](int k) { return vec2(reference.uv_transform * vec3(uv[facet.corner[k]], 1)); };
  p.corner = at(0), p.edge1 = at(1) - p.corner, p.edge2 = at(2) - p.corner;
  const Image& of = scene.images[size_t(image)];
  float area = 0.5f * std::abs(p.edge1.x * p.edge2.y - p.edge1.y * p.edge2.x);
  p.texels =
      std::sqrt(area * float(of.width) * float(of.height)) / std::max(facet.root_area, 1e-20f);
  p.known = true;
  return p;
}

void place_shine(const World& world, Facet& f) {
  if (!f.shine.known) f.shine = place_picture(world, f, f.material->metallic_roughness_texture);
}

void place_relief(const World& world, Facet& f) {
  const PlacedMesh& placed = *f.placed;
  const std::vector<vec4>& tangents = placed.mesh->tangents;
  if (f.relief.known || f.material->normal_texture.texture < 0 || tangents.empty()) return;
  vec3 normal = f.normal[0] + f.normal[1] + f.normal[2], tangent(0);
  for (int k = 0; k < 3; k++) tangent += vec3(tangents[f.corner[k]]);
  if (!placed.moving) tangent = mat3(placed.to_world) * tangent;
  tangent -= normal * (dot(normal, tangent) / std::max(dot(normal, normal), 1e-30f));
  const float length2 = dot(tangent, tangent);
  if (!(length2 > 1e-25f)) return;
  f.tangent = tangent / std::sqrt(length2);
  const float turn = (tangents[f.corner.x].w < 0) != placed.mirrored ? -1.0f : 1.0f;
  f.bitangent =
      cross(normal, f.tangent) * (turn / std::sqrt(std::max(dot(normal, normal), 1e-30f)));
  f.relief = place_picture(world, f, f.material->normal_texture);
}

Facet make_facet(const World& world, uint32_t instance, uint32_t triangle, vec3 eye) {
  Facet f;
  f.instance = instance;
  f.triangle = triangle;
  f.placed = &world.placed(instance);
  f.material = f.placed->material;
  const PlacedMesh& placed = *f.placed;
  const Mesh& mesh = *placed.mesh;
  f.corner = mesh.triangles[triangle];
  float area = 0;
  f.face = eval_face(world, instance, triangle, &area);
  vec3 place = mesh.positions[f.corner.x];
  if (placed.apart) place = mat3(placed.to_world) * place + (vec3(placed.to_world[3]) - eye);
  else if (placed.in_place) place -= eye;
  else place = vec3(placed.to_world * vec4(place, 1)) - eye;
  const float beyond = dot(f.face, place);
  f.front = beyond <= 0, f.plane_distance = std::abs(beyond);
  for (int k = 0; k < 3; k++) {
    vec3 n = mesh.normals[f.corner[k]];
    f.normal[k] = placed.in_place ? n : placed.normal_to_world * n;
  }
  f.one_normal = f.normal[0] == f.normal[1] && f.normal[0] == f.normal[2];
  f.root_area = std::sqrt(area);
  f.base = place_picture(world, f, f.material->base_color_texture);
  if (f.material->metallic > 0) place_shine(world, f);
  return f;
}

}  // namespace wellspring::light
