// SPDX-License-Identifier: Apache-2.0
#include "store/picture/sample_picture.h"

#include <algorithm>
#include <cmath>

#include "image/srgb.h"

namespace wellspring::store {
namespace {

constexpr float most_taps = 16;

vec3 texel_of(const Piece& piece, int x, int y) {
  const uint8_t* p = &piece.bytes[(size_t(y) * size_t(piece.width) + size_t(x)) * 4];
  return {decode_srgb(p[0]), decode_srgb(p[1]), decode_srgb(p[2])};
}

}  // namespace

LargePicture::LargePicture(std::shared_ptr<PieceStore> of,
                           std::shared_ptr<const PicturePyramid> picture)
    : store(std::move(of)), pyramid(std::move(picture)) {
  const std::vector<PyramidLevel>& levels = pyramid->levels();
  coarsest = read_level(*pyramid, int(levels.size()) - 1);
  for (const PyramidLevel& level : levels) {
    const double wide = double(levels[0].width) / double(level.width);
    const double high = double(levels[0].height) / double(level.height);
    scale.push_back(float(std::log2(std::max(wide, high))));
    sizes.push_back({level.columns(), level.rows()});
  }
  source = store->add(pyramid);
}

LargePicture::LargePicture(const LargePicture& other, std::shared_ptr<const PicturePyramid> picture)
    : store(other.store),
      pyramid(std::move(picture)),
      coarsest(other.coarsest),
      scale(other.scale),
      sizes(other.sizes) {
  source = store->add(pyramid);
}

LargePicture::~LargePicture() { store->remove(source); }

PictureSampler::PictureSampler(const PieceStore& store) : reader_(store), store_(store) {}

PictureSampler::~PictureSampler() {
  if (looked_ > 0) store_.count_looks(looked_, looked_coarse_);
  for (const Noted& noted : noted_)
    if (noted.picture) noted.picture->seen.add(noted.piece.key, noted.piece.pixels);
}

const Piece* PictureSampler::find(PieceKey key) {
  Found& found = found_[(key.bits ^ key.bits >> 24 ^ key.bits >> 48) % found_.size()];
  if (found.key != key.bits) found = {key.bits, reader_.find(key)};
  return found.piece;
}

// Notes what a pixel looks for; neighbours mostly look for the same two.
void PictureSampler::see(const LargePicture& picture, PieceKey key) {
  Noted& noted = noted_[key.level() & 1];
  if (noted.piece.key != key) {
    if (noted.picture) noted.picture->seen.add(noted.piece.key, noted.piece.pixels);
    noted = {&picture, {key, 0}};
  }
  noted.piece.pixels++;
}

// Finds the tile of a texel. Neighbours mostly lie in the same one, which takes no division.
const PictureSampler::Tile& PictureSampler::tile_at(const LargePicture& picture, int level, int x,
                                                    int y) {
  Tile& tile = tiles_[size_t(picture.source + level) % tiles_.size()];
  if (tile.picture == &picture && tile.level == level && x >= tile.left && x < tile.right &&
      y >= tile.top && y < tile.bottom)
    return tile;
  const std::vector<PyramidLevel>& levels = picture.pyramid->levels();
  const PyramidLevel& l = levels[size_t(level)];
  const int column = x / l.tile_width, row = y / l.tile_height;
  tile = {&picture, level, column * l.tile_width, row * l.tile_height};
  tile.right = tile.left + l.width_at(column), tile.bottom = tile.top + l.height_at(row);
  tile.key = {picture.source, level, uint32_t(column), uint32_t(row)};
  if (level + 1 == int(levels.size()))
    tile.piece = &picture.coarsest, tile.right = int(l.width), tile.bottom = int(l.height);
  else tile.piece = find(tile.key);
  return tile;
}

// Reads four texels of a level. False: one of them is not there.
bool PictureSampler::read(const LargePicture& picture, int level, dvec2 at, vec3& color) {
  const PyramidLevel& l = picture.pyramid->levels()[size_t(level)];
  const double x = glm::clamp(at.x, 0.0, 1.0) * double(l.width) - 0.5;
  const double y = glm::clamp(at.y, 0.0, 1.0) * double(l.height) - 0.5;
  const int left = int(std::floor(x)), top = int(std::floor(y));
  const float wx = float(x - double(left)), wy = float(y - double(top));
  const int columns[2] = {std::max(left, 0), std::min(left + 1, int(l.width) - 1)};
  const int rows[2] = {std::max(top, 0), std::min(top + 1, int(l.height) - 1)};
  vec3 texels[4];
  for (int i = 0; i < 4; i++) {
    const int column = columns[i & 1], row = rows[i >> 1];
    const Tile& tile = tile_at(picture, level, column, row);
    if (!tile.piece) {
      see(picture, tile.key);
      return false;
    }
    texels[i] = texel_of(*tile.piece, column - tile.left, row - tile.top);
  }
  const vec3 above = texels[0] + (texels[1] - texels[0]) * wx;
  const vec3 below = texels[2] + (texels[3] - texels[2]) * wx;
  color = above + (below - above) * wy;
  return true;
}

// Reads the finest level from `level` on that is there, which `got` tells.
vec3 PictureSampler::read_finest(const LargePicture& picture, int level, dvec2 at, int& got) {
  vec3 color(0);
  for (got = level; !read(picture, got, at, color); got++) {}
  return color;
}

vec3 PictureSampler::look(const LargePicture& picture, const PictureFootprint& f) {
  const std::vector<PyramidLevel>& levels = picture.pyramid->levels();
  const dvec2 size(double(levels[0].width), double(levels[0].height));
  // These are the axes of the ellipse that a pixel covers (Heckbert 1989, section 3.5.8), in texels
  // of the finest level: the singular values of the two steps.
  const dvec2 across = f.across * size, down = f.down * size;
  const double a = dot(across, across), b = dot(across, down), c = dot(down, down);
  const double mean = 0.5 * (a + c), off = std::sqrt(0.25 * (a - c) * (a - c) + b * b);
  const double longer = std::sqrt(std::max(mean + off, 0.0));
  const double shorter = std::sqrt(std::max(mean - off, 0.0));
  dvec2 at = f.at;
  if (!std::isfinite(at.x) || !std::isfinite(at.y)) at = dvec2(0);
  if (!std::isfinite(longer)) return texel_of(picture.coarsest, 0, 0);
  const double width = std::max({shorter, longer / most_taps, 1e-9});
  int taps = glm::clamp(int(std::ceil(longer / std::max(width, 1.0) - 0.01)), 1, int(most_taps));
  const float wanted = float(std::log2(width)), detail = wanted + store_.coarser();
  int fine = 0;
  const int last = int(levels.size()) - 1;
  while (fine < last && picture.scale[size_t(fine) + 1] <= detail) fine++;
  const int coarse = std::min(fine + 1, last);
  float blend = 0;
  if (coarse > fine) {
    const float from = picture.scale[size_t(fine)], to = picture.scale[size_t(coarse)];
    blend = glm::clamp((detail - from) / std::max(to - from, 1e-6f), 0.0f, 1.0f);
  }
  // The longer axis' direction: the eigenvector of the larger eigenvalue.
  dvec2 way = std::abs(b) > 1e-12 * mean ? dvec2(mean + off - c, b) : dvec2(a >= c, a < c);
  way = across * way.x + down * way.y;
  const double way_length = length(way);
  way = way_length > 0 ? way * (longer / way_length) / size : dvec2(0);

  vec3 sum(0);
  int got = fine;
  for (int i = 0; i < taps; i++) {
    const dvec2 place = at + way * ((i + 0.5) / taps - 0.5);
    vec3 color = read_finest(picture, fine, place, got);
    if (got == fine && blend > 0) {
      int other;
      color += (read_finest(picture, coarse, place, other) - color) * blend;
    }
    sum += color;
  }
  auto note = [&](int level) {
    if (level == last) return;
    const PyramidLevel& l = levels[size_t(level)];
    const int x = int(glm::clamp(at.x, 0.0, 1.0) * double(l.width));
    const int y = int(glm::clamp(at.y, 0.0, 1.0) * double(l.height));
    see(picture,
        tile_at(picture, level, std::min(x, int(l.width) - 1), std::min(y, int(l.height) - 1)).key);
  };
  looked_++;
  // The finer one of a pixel's two levels has at least the texels that are wanted.
  if (picture.scale[size_t(got)] > std::max(wanted, 0.0f) + 1) looked_coarse_++;
  note(fine);
  if (blend > 0) note(coarse);
  return sum / float(taps);
}

std::optional<glm::dmat3> square_to_corners(const std::array<dvec2, 4>& c) {
  auto turn = [](dvec2 a, dvec2 b) { return a.x * b.y - a.y * b.x; };
  for (int i = 0; i < 4; i++) {
    const dvec2 a = c[(i + 1) % 4] - c[i], b = c[(i + 2) % 4] - c[i];
    if (!(std::abs(turn(a, b)) > 1e-12 * length(a) * length(b))) return std::nullopt;
  }
  const dvec2 sum = c[0] - c[1] + c[2] - c[3], right = c[1] - c[2], down = c[3] - c[2];
  const double area = turn(right, down);
  const double g = turn(sum, down) / area, h = turn(right, sum) / area;
  return glm::dmat3(dvec3(c[1] - c[0] + g * c[1], g), dvec3(c[3] - c[0] + h * c[3], h),
                    dvec3(c[0], 1));
}

PictureFootprint placed_footprint(const PictureFootprint& f, const glm::dmat3& placing) {
  const dvec3 p = placing * dvec3(f.at, 1);
  const dvec2 at = dvec2(p) / p.z;
  auto step = [&](dvec2 way) {
    const dvec3 moved = placing * dvec3(way, 0);
    return (dvec2(moved) - at * moved.z) / p.z;
  };
  return {at, step(f.across), step(f.down)};
}

vec3 PictureSampler::look(const PictureLayer& layer, const PictureFootprint& footprint) {
  const bool registered = layer.placing == glm::dmat3(1);
  return look(*layer.picture, registered ? footprint : placed_footprint(footprint, layer.placing));
}

vec3 PictureSampler::look(const ShownPicture& shown, const PictureFootprint& footprint) {
  const float share = shown.share;
  switch (shown.over.picture ? shown.blend : Blend::none) {
    case Blend::none: break;
    case Blend::curtain:
      return look(footprint.at.x < double(share) ? shown.base : shown.over, footprint);
    case Blend::fade:
      return (1 - share) * look(shown.base, footprint) + share * look(shown.over, footprint);
    case Blend::difference:
      return glm::abs(look(shown.base, footprint) - look(shown.over, footprint));
  }
  return look(shown.base, footprint);
}

}  // namespace wellspring::store
