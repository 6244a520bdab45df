// SPDX-License-Identifier: Apache-2.0
// Smooth gloss of what moves shows what is around, as the catch lights of eyes:
// VisibleRun::light().
#include <algorithm>
#include <array>
#include <cmath>

#include "light/sample/sample_light.h"
#include "light/visible/visibility_impl.h"
#include "light/walk/walk.h"

namespace wellspring::light {
namespace {

constexpr int most_rays = 8;                // of a pixel
constexpr size_t most_together = 256;       // rays
constexpr float turn_a_ray = 0.015f;        // radians that normals turn within a pixel, for a ray
constexpr float least_alpha_shown = 0.03f;  // of highlights of lamps that have no size
constexpr float darkest = 1e-3f;            // radiance: of less nobody sees a shadow
constexpr float beyond = 0.5f;              // triangles' sides that normals are followed beyond it

// A triangle, and the normals on it towards the eye.
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
  // A place of the plane that is seen along `way`, and the unit normal there.
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

// A facet of GGX's distribution around the normal (Walter et al. 2007, equation 35).
vec3 sample_facet(vec3 normal, float alpha, vec2 u) {
  const float tangent2 = alpha * alpha * u.x / std::max(1 - u.x, 1e-3f);
  const float cosine = 1 / std::sqrt(1 + tangent2), sine = std::sqrt(tangent2) * cosine;
  const vec3 aside = std::abs(normal.x) < 0.7f ? vec3(1, 0, 0) : vec3(0, 1, 0);
  const vec3 s = normalize(cross(normal, aside)), t = cross(normal, s);
  const float turn = 2 * pi * u.y;
  return normal * cosine + (s * std::cos(turn) + t * std::sin(turn)) * sine;
}

// GGX's distribution times its shadowing, by Smith, over four cosines; `v`, `l`: unit.
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
        // Places of the R2 sequence in the pixel and on the lobe (Roberts 2018).
        const float a = float(k) + 0.5f;
        auto part = [&](float step) { return step * a - std::floor(step * a); };
        const vec2 at(part(0.7548777f) - 0.5f, part(0.5698403f) - 0.5f);
        const vec3 there = normalize(way + at.x * right + at.y * up);
        const ShineFacet::Seen s = shape.see(eye, there);
        const vec3 n = sample_facet(s.normal, alpha, {part(0.8191725f), part(0.6710436f)});
        Ray ray;
        place.position = s.place;
        ray.direction = there - 2 * dot(there, n) * n;
        // It would show something behind the surface: it is as light as what is around.
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
  // In parts that are not shared out to threads: a thread that waited could begin another run.
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
