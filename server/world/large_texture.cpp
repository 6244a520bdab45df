// SPDX-License-Identifier: Apache-2.0
#include "world/large_texture.h"

#include <algorithm>
#include <cmath>

namespace wellspring::world {
namespace {

// Brings a coordinate of a picture that repeats into 0 to 1.
double wrapped_once(double coordinate, Wrap wrap) {
  if (wrap == Wrap::repeat) return coordinate - std::floor(coordinate);
  if (wrap == Wrap::mirror) {
    coordinate -= 2 * std::floor(0.5 * coordinate);
    return coordinate > 1 ? 2 - coordinate : coordinate;
  }
  return coordinate;
}

dvec2 wrapped_once(dvec2 at, const Texture& texture) {
  return {wrapped_once(at.x, texture.wrap_u), wrapped_once(at.y, texture.wrap_v)};
}

}  // namespace

PicturedTriangle make_pictured_triangle(const PlacedMesh& placed, uint32_t triangle,
                                        const TextureRef& reference, vec3 from) {
  const Mesh& mesh = *placed.mesh;
  const uvec3 index = mesh.triangles[triangle];
  const std::vector<vec2>& set = mesh.uv[reference.uv_set];
  const dmat4 to_world(placed.to_world);
  dvec3 place[3];
  dvec2 uv[3];
  for (int i = 0; i < 3; i++) {
    const dvec3 p(mesh.positions[index[i]]);
    place[i] = (placed.in_place ? p : dvec3(to_world * dvec4(p, 1))) - dvec3(from);
    uv[i] = dvec2(glm::dmat3(reference.uv_transform) *
                  dvec3(set.empty() ? dvec2(0) : dvec2(set[index[i]]), 1));
  }
  return {place[0], place[1] - place[0], place[2] - place[0], uv[0], uv[1] - uv[0], uv[2] - uv[0]};
}

PixelToTexture::PixelToTexture(const PicturedTriangle& t, const View& view) {
  // A ray of direction d meets the plane where its weights are d . first / d . normal and
  // d . second / d . normal (Cramer's rule).
  const dvec3 normal = cross(t.edge1, t.edge2);
  const dvec3 first = cross(t.edge2, t.corner), second = cross(t.corner, t.edge1);
  const dvec3 u = normal * t.uv.x + first * t.uv_edge1.x + second * t.uv_edge2.x;
  const dvec3 v = normal * t.uv.y + first * t.uv_edge1.y + second * t.uv_edge2.y;
  const double scale = 2 * double(view.tan_half_fov) / double(view.height);
  const dvec2 axis(axis_place(view));
  const dvec3 x = dvec3(view.right) * scale, y = dvec3(view.up) * -scale;
  const dvec3 one = dvec3(view.forward) - x * axis.x - y * axis.y;
  auto factors = [&](dvec3 of) { return dvec3(dot(x, of), dot(y, of), dot(one, of)); };
  u_ = factors(u), v_ = factors(v), w_ = factors(normal);
}

PictureFootprint PixelToTexture::at(double x, double y, double blur, const Texture& texture) const {
  const dvec3 place(x, y, 1);
  const double w = dot(w_, place);
  const dvec2 uv(dot(u_, place) / w, dot(v_, place) / w);
  PictureFootprint f;
  f.at = wrapped_once(uv, texture);
  f.across = (dvec2(u_.x, v_.x) - uv * w_.x) * (blur / w);
  f.down = (dvec2(u_.y, v_.y) - uv * w_.y) * (blur / w);
  return f;
}

std::vector<Wish> take_wishes(const World& world, std::vector<PieceMotion>& motions) {
  std::vector<const LargePicture*> pictures;
  for (const ShownPicture& shown : world.pictures())
    for (const PictureLayer* layer : {&shown.base, &shown.over})
      if (layer->picture) pictures.push_back(layer->picture.get());
  std::vector<SeenPiece> seen;
  for (const LargePicture* picture : pictures) {
    const std::vector<SeenPiece> of = picture->seen.take();
    seen.insert(seen.end(), of.begin(), of.end());
  }
  auto sizes_of = [&](int source) -> const LevelSizes* {
    const auto found = std::ranges::find(pictures, source, &LargePicture::source);
    return found == pictures.end() ? nullptr : &(*found)->sizes;
  };
  return make_wishes(seen, sizes_of, motions);
}

vec3 eval_large_picture(const ShownPicture& shown, const Texture& texture,
                        const PicturedTriangle& t, const Ray& ray, const Hit& hit) {
  const dvec3 normal = cross(t.edge1, t.edge2), way(ray.direction);
  const double square = dot(normal, normal), slope = dot(normal, way);
  auto to_uv = [&](dvec3 step) {
    return t.uv_edge1 * (dot(cross(step, t.edge2), normal) / square) +
           t.uv_edge2 * (dot(cross(t.edge1, step), normal) / square);
  };
  PictureFootprint f;
  f.at = wrapped_once(
      t.uv + t.uv_edge1 * double(hit.barycentric.x) + t.uv_edge2 * double(hit.barycentric.y),
      texture);
  const dvec3 aside = std::abs(way.y) < 0.9 ? dvec3(0, 1, 0) : dvec3(1, 0, 0);
  const double width = double(ray.width) + double(ray.spread) * double(hit.t);
  for (dvec2* step : {&f.across, &f.down}) {
    const dvec3 turned = normalize(cross(way, aside));
    const dvec3 across = (step == &f.across ? turned : cross(turned, way)) * width;
    *step = to_uv(across - way * (dot(normal, across) / slope));
  }
  PictureSampler sampler(*shown.base.picture->store);
  return sampler.look(shown, f);
}

}  // namespace wellspring::world
