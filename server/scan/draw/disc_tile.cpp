// SPDX-License-Identifier: Apache-2.0
#include "scan/draw/disc_tile.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "image/srgb.h"
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
  const float behind = rim_behind * d.radius * d.depth * place.pixel;
  for_disc(d, [&](const auto& pixels, const Lanes& q, const Lanes& deeper) {
    const Lanes key = pixels.template load<Lanes>(planes.key.data());
    const Lanes depth = lanes_max(d.depth + deeper, all_lanes(place.near));
    const Lanes own = depth + behind * q;
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
          continue;
        }
        const Piece& piece = scene.pieces[point >> piece_bits];
        const NodePoints& node = scene.nodes[piece.node];
        const size_t number = piece.first + (point & (piece_points - 1));
        buffer.color[to] = node.color[number];
        buffer.classification[to] = node.classification ? node.classification[number] : 0;
        buffer.node[to] = piece.node;
        words[i] = node.normal[number];
      }
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
                    int tile_y, std::span<const std::span<const Disc>> runs, uint64_t area) {
  const ScanCamera& view = *scene.view;
  const double most = most_layers * tile_side * tile_side;
  const Place place{.left = tile_x * tile_side,
                    .top = tile_y * tile_side,
                    .shrink = double(area) > most ? float(std::sqrt(most / double(area))) : 1,
                    .pixel = 1 / view.focal(),
                    .near = view.near};
  planes.key.assign(TilePlanes::size, infinite);
  planes.depth.assign(TilePlanes::size, infinite);
  planes.point.assign(TilePlanes::size, nobody);
  for (const std::span<const Disc>& run : runs)
    for (const Disc& disc : run) place_disc(planes, disc, place);
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
        const vec3 ray = rays.at(float(disc.x >> 8) / 256, float(disc.y >> 8) / 256);
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
