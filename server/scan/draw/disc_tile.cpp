// SPDX-License-Identifier: Apache-2.0
#include "scan/draw/disc_tile.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "image/srgb.h"
#include "scan/draw/disc_bins.h"
#include "scan/draw/normal_lanes.h"

namespace wellspring::scan {
namespace {

constexpr uint32_t nobody = 0xffffffffu;
constexpr float infinite = std::numeric_limits<float>::infinity();
// Rims of discs lie so many radii behind their middles when discs are compared.
constexpr float rim_behind = 0.5f;
// Discs are of one surface if they are no farther apart than so many radii.
constexpr float band_radii = 1;
// A tile's discs cover it at most so many times.
constexpr double most_layers = 64;

constexpr int stride = TilePlanes::stride;
constexpr Lanes steps{0, 1, 2, 3, 4, 5, 6, 7};

// Says where the tile is and how its discs are changed.
struct Place {
  int left = 0, top = 0;  // pixels
  float shrink = 1;       // discs' radii are times this
  float pixel = 1;        // metres of a pixel at a depth of 1
  float near = 0;         // metres
};

// A disc in pixels of its tile.
struct PlacedDisc {
  float x, y, depth, lean_x, lean_y, radius, slope;
  int low_x, high_x, low_y, high_y;

  PlacedDisc(const Disc& d, const Place& place)
      : depth(d.depth), lean_x(d.lean_x), lean_y(d.lean_y), radius(d.radius), slope(d.slope) {
    const int fixed_x = (d.x >> 8) - place.left * 256, fixed_y = (d.y >> 8) - place.top * 256;
    x = float(fixed_x) * (1 / 256.0f), y = float(fixed_y) * (1 / 256.0f);
    int extent_x = (d.x & 255) * 64, extent_y = (d.y & 255) * 64;
    if (place.shrink < 1) {
      const float factor = std::min(1.0f, std::max(place.shrink, 0.75f / radius));
      extent_x = int(float(extent_x) * factor) + 1, extent_y = int(float(extent_y) * factor) + 1;
      lean_x /= factor, lean_y /= factor, slope *= factor, radius *= factor;
    }
    low_x = std::max((fixed_x - extent_x + 255) >> 8, 0);
    high_x = std::min((fixed_x + extent_x) >> 8, tile_side - 1);
    low_y = std::max((fixed_y - extent_y + 255) >> 8, 0);
    high_y = std::min((fixed_y + extent_y) >> 8, tile_side - 1);
  }
};

// Eight pixels of a tile's planes: neighbours in a row, or four of a row and four below.
struct EightInRow {
  size_t at;
  size_t lane(int i) const { return at + size_t(i); }
  template <class V, class T>
  V load(const T* plane) const {
    return load_lanes<V>(plane + at);
  }
  template <class T, class V>
  void store(T* plane, const V& v) const {
    store_lanes(plane + at, v);
  }
};
struct FourInTwoRows {
  size_t at;
  size_t lane(int i) const { return at + size_t(i & 3) + size_t(i >> 2) * stride; }
  template <class V, class T>
  V load(const T* plane) const {
    return lanes_as<V>(join_halves(load_lanes<HalfLaneBits>(plane + at),
                                   load_lanes<HalfLaneBits>(plane + at + stride)));
  }
  template <class T, class V>
  void store(T* plane, const V& v) const {
    store_lanes(plane + at, low_half(lanes_as<LaneBits>(v)));
    store_lanes(plane + at + stride, high_half(lanes_as<LaneBits>(v)));
  }
};

// Calls body(pixels, q, how much deeper than the middle) for the box, eight pixels at a time;
// pixels outside the disc have q above 1, those beyond the tile lie in the planes' padding.
template <class Body>
[[gnu::always_inline]] inline void for_disc(const PlacedDisc& d, const Body& body) {
  if (d.high_x < d.low_x) return;  // it has shrunk out of the tile
  const float a = 1 / (d.radius * d.radius);
  if (d.high_x - d.low_x < 4) {
    constexpr Lanes across{0, 1, 2, 3, 0, 1, 2, 3}, down{0, 0, 0, 0, 1, 1, 1, 1};
    const Lanes dx = across + (float(d.low_x) - d.x), far = a * dx * dx, lean = d.lean_x * dx;
    for (int y = d.low_y; y <= d.high_y; y += 2) {
      const Lanes dy = down + (float(y) - d.y);
      const Lanes e = lean + d.lean_y * dy;
      body(FourInTwoRows{size_t(y * stride + d.low_x)}, far + a * dy * dy + e * e, d.slope * e);
    }
    return;
  }
  for (int y = d.low_y; y <= d.high_y; y++) {
    const float dy = float(y) - d.y, lean = d.lean_y * dy, far = a * dy * dy;
    for (int x = d.low_x; x <= d.high_x; x += lane_count) {
      const Lanes dx = steps + (float(x) - d.x);
      const Lanes e = d.lean_x * dx + lean;
      body(EightInRow{size_t(y * stride + x)}, a * dx * dx + far + e * e, d.slope * e);
    }
  }
}

// Leads from pixels to directions of rays, one metre along the axis.
struct Rays {
  vec3 first, x, y;
  explicit Rays(const ScanCamera& view) {
    const vec2 from = view.offset - view.axis_place();
    x = view.right / view.focal(), y = -view.up / view.focal();
    first = view.forward + x * from.x + y * from.y;
  }
  vec3 at(float column, float row) const { return first + x * column + y * row; }
  Lanes3 eight(float column, float row) const {
    return all_lanes(at(column, row)) + all_lanes(x) * steps;
  }
};

// Returns a point's normal, which it must have.
vec3 unpacked_normal(uint16_t word) {
  const vec2 n = vec2(float(int8_t(word & 255)), float(int8_t(word >> 8))) / 127.0f;
  const float z = 1 - std::abs(n.x) - std::abs(n.y), fold = std::max(-z, 0.0f);
  return normalize(vec3(n.x + (n.x < 0 ? fold : -fold), n.y + (n.y < 0 ? fold : -fold), z));
}
uint32_t normal_word(vec3 n) {
  n /= std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
  vec2 u(n.x, n.y);
  if (n.z < 0) u = {std::copysign(1 - std::abs(n.y), n.x), std::copysign(1 - std::abs(n.x), n.y)};
  const auto half = [](float a) { return uint32_t(uint16_t(int16_t(std::lrint(a * 32767)))); };
  return half(u.x) | half(u.y) << 16;
}

// Turns normals of points to the eye, as words of PointBuffer::normal.
LaneBits normals_towards_eye(const LaneMask& words, const Lanes3& rays) {
  const auto [u, v] = unpack_normals(words);
  const Lanes3 n = fold_normals({u, v});
  const LaneMask away = dot(n, rays) > 0;
  // The opposite direction lies mirrored at the fold.
  const Lanes rest_u = 1 - lanes_abs(v), rest_v = 1 - lanes_abs(u);
  const Lanes own_u = away ? (u < 0 ? rest_u : -rest_u) : u,
              own_v = away ? (v < 0 ? rest_v : -rest_v) : v;
  const LaneMask word = (round_lanes(own_u * 32767) & 0xffff) | round_lanes(own_v * 32767) << 16;
  return LaneBits(words == no_point_normal ? LaneMask{} + int(PointBuffer::no_normal) : word);
}

// Encodes linear values, right to a code.
class SrgbCodes {
 public:
  SrgbCodes() {
    int code = 0;
    for (size_t i = 0; i < codes_.size(); i++) {
      const float x = float(i) / float(codes_.size() - 1);
      while (code < 255 && x > 0.5f * (decode_srgb(uint8_t(code)) + decode_srgb(uint8_t(code + 1))))
        code++;
      codes_[i] = uint8_t(code);
    }
  }
  uint32_t operator()(float x) const {
    return codes_[size_t(std::clamp(x, 0.0f, 1.0f) * float(codes_.size() - 1) + 0.5f)];
  }

 private:
  std::array<uint8_t, 16384> codes_;
};

// Puts a sphere or a disc where it is nearest.
template <bool spheres>
[[gnu::always_inline]] inline void place_disc(TilePlanes& planes, const Disc& disc,
                                              const Place& place) {
  if ((disc.x & 255) == 0) {
    const int x = (((disc.x >> 8) + 128) >> 8) - place.left,
              y = (((disc.y >> 8) + 128) >> 8) - place.top;
    const size_t at = size_t(y * stride + x);
    if (disc.depth < planes.key[at]) {
      planes.key[at] = planes.depth[at] = disc.depth;
      planes.point[at] = disc.point;
    }
    return;
  }
  const PlacedDisc d(disc, place);
  const float metres = d.radius * d.depth * place.pixel;
  for_disc(d, [&](const auto& pixels, const Lanes& q, const Lanes& deeper) {
    const Lanes key = pixels.template load<Lanes>(planes.key.data());
    const Lanes raised =
        spheres ? d.depth - metres * lanes_sqrt(positive_lanes(1 - q)) : d.depth + deeper;
    const Lanes depth = lanes_max(raised, all_lanes(place.near));
    const Lanes own = spheres ? depth : depth + rim_behind * metres * q;
    const LaneMask wins = (q <= 1) & (own < key);
    if (!any_lane(wins)) return;
    pixels.store(planes.key.data(), wins ? own : key);
    pixels.store(planes.depth.data(),
                 wins ? depth : pixels.template load<Lanes>(planes.depth.data()));
    const LaneBits point = pixels.template load<LaneBits>(planes.point.data());
    pixels.store(planes.point.data(), wins ? all_lane_bits(disc.point) : point);
  });
}

[[gnu::always_inline]] inline void blend_disc(TilePlanes& planes, const Disc& disc,
                                              const Place& place, const Lanes& value) {
  if ((disc.x & 255) == 0) {
    const int x = (((disc.x >> 8) + 128) >> 8) - place.left,
              y = (((disc.y >> 8) + 128) >> 8) - place.top;
    const size_t at = size_t(y * stride + x);
    const float band = band_radii * disc.depth * place.pixel;
    if (std::abs(disc.depth - planes.depth[at]) <= band) planes.sum[at] += value;
    return;
  }
  const PlacedDisc d(disc, place);
  const float band = band_radii * d.radius * d.depth * place.pixel;
  for_disc(d, [&](const auto& pixels, const Lanes& q, const Lanes& deeper) {
    const Lanes depth = lanes_max(d.depth + deeper, all_lanes(place.near));
    const Lanes seen = pixels.template load<Lanes>(planes.depth.data());
    const LaneMask near = lanes_abs(depth - seen) <= all_lanes(band);
    const Lanes inside = 1.001f - q;  // above 0 at the rim, so that each disc seen has weight
    const Lanes weight = inside * inside;
    for (unsigned lanes = negative_lanes((q <= 1) & near); lanes != 0; lanes &= lanes - 1) {
      const int lane = std::countr_zero(lanes);
      planes.sum[pixels.lane(lane)] += value * weight[lane];
    }
  });
}

// Knows how far blocks of a tile are covered: a sphere that lies wholly behind is not drawn.
class Covered {
 public:
  // Pixels beyond the picture's right and lower edge hide nothing.
  Covered(TilePlanes& planes, int width, int height) : planes_(planes) {
    far_.fill(infinite);
    for (int y = 0; y < tile_side; y++) {
      const int from = y < height ? std::clamp(width, 0, tile_side) : 0;
      std::fill_n(&planes.key[size_t(y * stride + from)], tile_side - from, -infinite);
    }
  }
  // Returns whether all that is nearer than `front` metres of these pixels of the tile is covered.
  bool hides(float front, int low_x, int high_x, int low_y, int high_y) {
    if (++asked_ % update_every == 0) update();
    for (int y = low_y / side; y <= high_y / side; y++)
      for (int x = low_x / side; x <= high_x / side; x++)
        if (front <= far_[size_t(y * across + x)]) return false;
    return true;
  }

 private:
  static constexpr int side = 16, across = tile_side / side;  // pixels; blocks
  static constexpr int update_every = 256;                    // spheres
  void update() {
    for (int block = 0; block < across * across; block++) {
      Lanes most = all_lanes(-infinite);
      for (int y = block / across * side; y < (block / across + 1) * side; y++)
        for (int x = block % across * side; x < (block % across + 1) * side; x += lane_count)
          most = lanes_max(most, load_lanes(&planes_.key[size_t(y * stride + x)]));
      float far = most[0];
      for (int k = 1; k < lane_count; k++) far = std::max(far, most[k]);
      far_[size_t(block)] = far;
    }
  }
  TilePlanes& planes_;
  std::array<float, size_t(across) * across> far_;
  int asked_ = 0;
};

void place_sphere(TilePlanes& planes, Covered& covered, const Disc& disc, const Place& place) {
  if ((disc.x & 255) != 0) {
    const PlacedDisc d(disc, place);
    const float radius = d.radius * d.depth * place.pixel;
    if (d.high_x < d.low_x || d.high_y < d.low_y ||
        covered.hides(d.depth - radius, d.low_x, d.high_x, d.low_y, d.high_y))
      return;
  }
  place_disc<true>(planes, disc, place);
}

// Puts a sphere that is large in the picture where rays meet it. It touches the tile at most at the
// pixels to which its front, seen at its nearest depth, may reach.
void place_large(TilePlanes& planes, Covered& covered, const Disc& disc, const Place& place,
                 const ScanCamera& view) {
  const float radius = disc.radius * disc.depth * place.pixel;
  const vec2 at = place_of(disc);
  const vec2 middle = at - vec2(float(place.left), float(place.top));
  // In the eye's frame rays are (x, y, 1), and the middle is its own ray times its depth.
  const vec2 axis = view.axis_place() - view.offset;
  const vec2 own = (at - axis) * place.pixel;
  const float slant2 = 1 + dot(own, own), front = disc.depth - radius;
  const float reach = large_reach(disc, view);
  const auto least = [](float a) { return int(std::clamp(std::floor(a), -1.0f, 64.0f)); };
  const int low_x = std::max(least(middle.x - reach), 0),
            low_y = std::max(least(middle.y - reach), 0);
  const int high_x = std::min(least(middle.x + reach) + 1, tile_side - 1),
            high_y = std::min(least(middle.y + reach) + 1, tile_side - 1);
  if (high_x < low_x || high_y < low_y || covered.hides(front, low_x, high_x, low_y, high_y))
    return;
  const float far2 = disc.depth * disc.depth * slant2 - radius * radius;
  for (int y = low_y; y <= high_y; y++) {
    const float ray_y = (float(place.top + y) - axis.y) * place.pixel;
    for (int x = low_x; x <= high_x; x += lane_count) {
      const size_t from = size_t(y * stride + x);
      const Lanes ray_x = (steps + (float(place.left + x) - axis.x)) * place.pixel;
      const Lanes square = ray_x * ray_x + (ray_y * ray_y + 1);
      const Lanes along = disc.depth * (ray_x * own.x + (ray_y * own.y + 1));
      const Lanes root = along * along - square * far2;
      const Lanes depth = (along - lanes_sqrt(positive_lanes(root))) / square;
      const Lanes key = load_lanes<Lanes>(&planes.key[from]);
      const LaneMask wins = (root > 0) & (depth > all_lanes(place.near)) & (depth < key);
      if (!any_lane(wins)) continue;
      store_lanes(&planes.key[from], wins ? depth : key);
      store_lanes(&planes.depth[from], wins ? depth : load_lanes<Lanes>(&planes.depth[from]));
      const LaneBits point = load_lanes<LaneBits>(&planes.point[from]);
      store_lanes(&planes.point[from], wins ? all_lane_bits(disc.point) : point);
    }
  }
}

// Returns the normal of a sphere around a point where a ray meets it at this depth.
vec3 sphere_normal(const NodePoints& node, size_t number, const ScanCamera& view, vec3 ray,
                   float depth) {
  const dvec3 at(node.x[number], node.y[number], node.z[number]);
  const vec3 middle(node.corner - view.eye + (at + 0.5) * (double(node.size) / 65536));
  const vec3 normal = depth * ray - middle;
  const float length = glm::length(normal);
  return length > 0 ? normal / length : -normalize(ray);
}

void write_nearest(PointBuffer& buffer, const TilePlanes& planes, const DiscScene& scene,
                   const Place& place) {
  const ScanCamera& view = *scene.view;
  const Rays rays(view);
  const int width = std::min(tile_side, view.width - place.left);
  const int height = std::min(tile_side, view.height - place.top);
  for (int y = 0; y < height; y++) {
    const size_t row = size_t(place.top + y) * size_t(view.width) + size_t(place.left);
    for (int x = 0; x < width; x += lane_count) {
      LaneMask words = LaneMask{} + no_point_normal;
      const int count = std::min(lane_count, width - x);
      for (int i = 0; i < count; i++) {
        const size_t from = size_t(y * stride + x + i), to = row + size_t(x + i);
        const uint32_t point = planes.point[from];
        buffer.depth[to] = planes.depth[from];
        if (point == nobody) {
          buffer.color[to] = 0;
          buffer.classification[to] = 0;
          buffer.node[to] = PointBuffer::no_node;
          buffer.normal[to] = PointBuffer::no_normal;
          continue;
        }
        const Piece& piece = scene.pieces[point >> piece_bits];
        const NodePoints& node = scene.nodes[piece.node];
        const size_t number = piece.first + (point & (piece_points - 1));
        buffer.color[to] = node.color[number];
        buffer.classification[to] = node.classification ? node.classification[number] : 0;
        buffer.node[to] = piece.node;
        words[i] = node.normal[number];
        if (scene.spheres)
          buffer.normal[to] = normal_word(sphere_normal(
              node, number, view, rays.at(float(place.left + x + i), float(place.top + y)),
              planes.depth[from]));
      }
      if (scene.spheres) continue;
      const LaneBits normals =
          normals_towards_eye(words, rays.eight(float(place.left + x), float(place.top + y)));
      std::memcpy(&buffer.normal[row + size_t(x)], &normals, size_t(count) * sizeof(uint32_t));
    }
  }
}

void write_mean(PointBuffer& buffer, const TilePlanes& planes, const DiscScene& scene,
                const Place& place) {
  static const SrgbCodes encode;
  const ScanCamera& view = *scene.view;
  const int width = std::min(tile_side, view.width - place.left);
  const int height = std::min(tile_side, view.height - place.top);
  for (int y = 0; y < height; y++) {
    const size_t row = size_t(place.top + y) * size_t(view.width) + size_t(place.left);
    for (int x = 0; x < width; x++) {
      const Lanes& sum = planes.sum[size_t(y * stride + x)];
      if (sum[7] <= 0) continue;
      const Lanes mean = sum / sum[7];
      buffer.color[row + size_t(x)] = encode(mean[0]) | encode(mean[1]) << 8 |
                                      encode(mean[2]) << 16 | uint32_t(mean[3] + 0.5f) << 24;
      const vec3 n(mean[4], mean[5], mean[6]);
      if (dot(n, n) > 1e-4f) buffer.normal[row + size_t(x)] = normal_word(n);
    }
  }
}

}  // namespace

void draw_disc_tile(PointBuffer& buffer, TilePlanes& planes, const DiscScene& scene, int tile_x,
                    int tile_y, std::span<const std::span<const Disc>> runs, uint64_t area,
                    std::span<const Disc> large) {
  const ScanCamera& view = *scene.view;
  const double most = most_layers * tile_side * tile_side;
  const Place place{
      .left = tile_x * tile_side,
      .top = tile_y * tile_side,
      .shrink = double(area) > most && !scene.spheres ? float(std::sqrt(most / double(area))) : 1,
      .pixel = 1 / view.focal(),
      .near = view.near};
  planes.key.assign(TilePlanes::size, infinite);
  planes.depth.assign(TilePlanes::size, infinite);
  planes.point.assign(TilePlanes::size, nobody);
  if (scene.spheres) {
    Covered covered(planes, view.width - place.left, view.height - place.top);
    for (const Disc& disc : large) place_large(planes, covered, disc, place, view);
    for (const std::span<const Disc>& run : runs)
      for (const Disc& disc : run) place_sphere(planes, covered, disc, place);
  } else {
    for (const std::span<const Disc>& run : runs)
      for (const Disc& disc : run) place_disc<false>(planes, disc, place);
  }
  write_nearest(buffer, planes, scene, place);
  if (!scene.blended) return;
  const Rays rays(view);
  planes.sum.assign(TilePlanes::size, Lanes{});
  for (const std::span<const Disc>& run : runs) {
    const Piece& piece = scene.pieces[run[0].point >> piece_bits];
    const NodePoints& node = scene.nodes[piece.node];
    for (const Disc& disc : run) {
      const uint32_t i = piece.first + (disc.point & (piece_points - 1));
      const uint32_t color = node.color[i];
      const uint16_t word = node.normal[i];
      vec3 n(0);
      if (word != no_point_normal) {
        n = unpacked_normal(word);
        const vec2 at = place_of(disc);
        const vec3 ray = rays.at(at.x, at.y);
        if (dot(n, ray) > 0) n = -n;
      }
      blend_disc(planes, disc, place,
                 Lanes{decode_srgb(uint8_t(color)), decode_srgb(uint8_t(color >> 8)),
                       decode_srgb(uint8_t(color >> 16)), float(color >> 24), n.x, n.y, n.z, 1});
    }
  }
  write_mean(buffer, planes, scene, place);
}

}  // namespace wellspring::scan
