// SPDX-License-Identifier: Apache-2.0
// Finds what a pixel sees of a very large picture on a triangle: the place and how it changes from
// pixel to pixel (ray differentials, Igehy 1999), in doubles.
#pragma once
#include "store/picture/sample_picture.h"
#include "world/view.h"
#include "world/world.h"

namespace wellspring::world {

// Holds how a picture lies on a triangle.
struct PicturedTriangle {
  dvec3 corner{0}, edge1{0}, edge2{0};  // metres, relative to the eye or the ray's origin
  dvec2 uv{0}, uv_edge1{0}, uv_edge2{0};
};
// `from`: origin of the places, in scene coordinates.
PicturedTriangle make_pictured_triangle(const PlacedMesh& placed, uint32_t triangle,
                                        const TextureRef& reference, vec3 from);

// Maps places of a picture of a view to texture coordinates on a triangle's plane: a ratio of
// linear functions, so derivatives are exact.
class PixelToTexture {
 public:
  PixelToTexture() = default;
  // `t` is relative to the eye.
  PixelToTexture(const PicturedTriangle& t, const View& view);
  // `x`, `y`: in pixels; `blur`: pixels over which the picture is averaged.
  PictureFootprint at(double x, double y, double blur, const Texture& texture) const;

 private:
  dvec3 u_{0}, v_{0}, w_{0};  // factors of x, y and 1
};

// Returns what the pieces of the scene's very large pictures are needed for that were looked for
// since it was last asked: see make_wishes(). While nothing looks for any.
std::vector<Wish> take_wishes(const World& world, std::vector<PieceMotion>& motions);

// Returns linear RGB of a large picture at a hit, as wide as the ray's cone is there. `t` is
// relative to the ray's origin.
vec3 eval_large_picture(const ShownPicture& shown, const Texture& texture,
                        const PicturedTriangle& t, const Ray& ray, const Hit& hit);

}  // namespace wellspring::world
