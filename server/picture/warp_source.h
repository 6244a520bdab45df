// SPDX-License-Identifier: Apache-2.0
// Reads a keyframe for pixels of a warped picture, eight neighbours at a time: their places in it,
// the surface that is to be seen there, and its colour. See picture/warp_picture.h.
#pragma once
#include <algorithm>
#include <cstring>

#include "base/simd.h"
#include "picture/keyframe.h"

namespace wellspring::picture::warping {

// Least depth over that of the other view: nothing is nearer to a camera.
inline constexpr float least_depth = 1e-6f;
// Gap, in pixels, that disparities within a bilinear sample may open.
inline constexpr float half_step = 0.5f;
// Pixels of a keyframe that are this many times as large as the picture's count as larger: margins
// are rounded to whole pixels, and a field of view may change a little between two keyframes.
inline constexpr float larger_pixel = 1.1f;
// Places of a bilinear sample between two pixels, as a power of 2.
inline constexpr int fractions = 16, fraction_bits = 4;

// Maps a pixel (x, y) and its disparity w in one view to another: one + x * across + y * down + w *
// baseline is the place there times its depth over the depth here, and that ratio.
struct Mapping {
  vec3 one, across, down, baseline;
};
inline Mapping make_mapping(const View& from, const View& to) {
  float scale = 2 * from.tan_half_fov / float(from.height);
  float focal = float(to.height) * 0.5f / to.tan_half_fov;
  dvec2 axis = axis_place(to);
  auto seen = [&](vec3 d) {
    double x = dot(dvec3(d), dvec3(to.right)), y = dot(dvec3(d), dvec3(to.up)),
           z = dot(dvec3(d), dvec3(to.forward));
    return vec3(float(focal * x + axis.x * z), float(axis.y * z - focal * y), float(z));
  };
  vec3 right = from.right * scale, down = from.up * -scale;
  vec2 from_axis = axis_place(from);
  vec3 corner = from.forward - right * from_axis.x - down * from_axis.y;
  return {seen(corner), seen(right), seen(down), seen(from.position - to.position)};
}

struct Place {
  Lanes x, y, ratio;  // ratio: depth there over depth here
};
inline Place carry(const Mapping& m, const Place& base, const Lanes& w) {
  Lanes z = lanes_max(base.ratio + w * m.baseline.z, all_lanes(least_depth));
  Lanes inverse = 1.0f / z;
  return {(base.x + w * m.baseline.x) * inverse, (base.y + w * m.baseline.y) * inverse, z};
}

template <class T>
inline LaneBits gather(const T* from, const LaneMask& index) {
  static_assert(sizeof(T) == 4);
#ifdef __AVX2__
  return LaneBits(_mm256_i32gather_epi32(reinterpret_cast<const int*>(from), __m256i(index), 4));
#else
  LaneBits v;
  for (int i = 0; i < lane_count; i++)
    std::memcpy(reinterpret_cast<uint32_t*>(&v) + i, from + index[i], 4);
  return v;
#endif
}
// Reads the words at the places and those after them.
inline void gather_pairs(const uint32_t* from, const LaneMask& index, LaneBits& a, LaneBits& b) {
#ifdef __AVX2__
  auto pairs = [&](const __m128i& i) {
    return LaneBits(_mm256_i32gather_epi64(reinterpret_cast<const long long*>(from), i, 4));
  };
  LaneBits low = pairs(__m128i(low_half(lanes_as<LaneBits>(index)))),
           high = pairs(__m128i(high_half(lanes_as<LaneBits>(index))));
  a = __builtin_shufflevector(low, high, 0, 2, 4, 6, 8, 10, 12, 14);
  b = __builtin_shufflevector(low, high, 1, 3, 5, 7, 9, 11, 13, 15);
#else
  a = gather(from, index), b = gather(from, index + 1);
#endif
}
#ifdef __AVX2__
// Holds sixteen words in a row: eight of them are picked much faster than gathered.
struct Window {
  LaneBits low, high;
  explicit Window(const void* from)
      : low(load_lanes<LaneBits>(from)),
        high(load_lanes<LaneBits>(static_cast<const uint32_t*>(from) + lane_count)) {}
  LaneBits pick(const LaneMask& at) const {  // `at`: 0 to 15
    auto permute = [&](const LaneBits& v) {
      return LaneMask(_mm256_permutevar8x32_epi32(__m256i(v), __m256i(at)));
    };
    return lanes_as<LaneBits>(at < lane_count ? permute(low) : permute(high));
  }
};
#endif
inline constexpr int window = 2 * lane_count;
// Returns whether neighbours lie in a window that begins with the first of them.
inline bool lie_close(const LaneMask& index, int width_of_pick) {
  return !any_lane(
      lanes_as<LaneMask>(lanes_as<LaneBits>(index - index[0]) > uint32_t(window - width_of_pick)));
}
inline LaneMask to_int(const Lanes& v) { return __builtin_convertvector(v, LaneMask); }
inline float least(const Lanes& v) {
  Lanes a = lanes_min(v, __builtin_shufflevector(v, v, 4, 5, 6, 7, 0, 1, 2, 3));
  a = lanes_min(a, __builtin_shufflevector(a, a, 2, 3, 0, 1, 6, 7, 4, 5));
  return std::min(a[0], a[1]);
}
inline float most(const Lanes& v) { return -least(-v); }
// Clamps to 0 and `high`; NaN becomes 0.
inline Lanes clamped(const Lanes& v, float high) {
  return lanes_min(lanes_max(v, Lanes{}), all_lanes(high));
}

// Holds what every pixel needs of the keyframe.
struct Source {
  const Keyframe& k;
  Mapping to, back;  // mappings from the new view to the keyframe's, and back
  float last_x, last_y;
  float seam = 0;  // pixels at its border over which the keyframe passes into the next
  // The keyframe's pixels are larger: colours are bilinear across silhouettes, too, which would
  // have steps otherwise.
  bool coarse;

  Source(const Keyframe& k, const View& view)
      : k(k),
        to(make_mapping(view, k.view)),
        back(make_mapping(k.view, view)),
        last_x(float(k.view.width - 1)),
        last_y(float(k.view.height - 1)),
        coarse(k.view.tan_half_fov * float(view.height) >
               larger_pixel * view.tan_half_fov * float(k.view.height)) {}
  // Returns the disparity of the pixel that holds the place.
  Lanes disparity(const Lanes& x, const Lanes& y) const {
    LaneMask index = to_int(clamped(y, last_y)) * k.view.width + to_int(clamped(x, last_x));
#ifdef __AVX2__
    if (lie_close(index, 1) && size_t(index[0]) + window <= k.disparity.size())
      return lanes_as<Lanes>(Window(&k.disparity[size_t(index[0])]).pick(index - index[0]));
#endif
    return lanes_as<Lanes>(gather(k.disparity.data(), index));
  }
  // Returns what the keyframe shows there, as a disparity in the new view.
  Lanes surface(const Lanes& x, const Lanes& y) const {
    Lanes s = disparity(x, y);
    Lanes z = back.one.z + x * back.across.z + y * back.down.z + s * back.baseline.z;
    return z > least_depth ? s / z : Lanes{};
  }
};

// Reads four pixels a lane: the first, the one after it, and the two below them if `below` is not
// `first`.
inline void read_corners(const Keyframe& k, const LaneMask& first, const LaneMask& below,
                         LaneBits& c00, LaneBits& c10, LaneBits& c01, LaneBits& c11) {
#ifdef __AVX2__
  size_t begin = size_t(first[0]), next = begin + size_t(k.view.width);
  if (lie_close(first, 2) && next + window <= k.color.size()) {
    LaneMask at = first - first[0], after = at + 1;
    Window row(&k.color[begin]), row_below(&k.color[next]);
    c00 = row.pick(at), c10 = row.pick(after);
    c01 = row_below.pick(at), c11 = row_below.pick(after);
    return;
  }
#endif
  gather_pairs(k.color.data(), first, c00, c10);
  gather_pairs(k.color.data(), below, c01, c11);
}

// Returns bilinear colours, of the pixels around that lie on the surface of the nearest of them.
inline LaneBits sample_color(const Source& source, const Lanes& x, const Lanes& y, float pixels) {
  const Keyframe& k = source.k;
  int width = k.view.width;
  auto place = [](const Lanes& v, float last) {
    return to_int(clamped(v * fractions - (0.5f * fractions - 0.5f), last * fractions));
  };
  LaneMask px = place(x, source.last_x), py = place(y, source.last_y);
  LaneMask x0 = px >> fraction_bits, y0 = py >> fraction_bits;
  LaneBits fx = lanes_as<LaneBits>(px & (fractions - 1)),
           fy = lanes_as<LaneBits>(py & (fractions - 1));
  // If there is no further row its weight is 0; behind the last pixel there is one more.
  LaneMask first = y0 * width + x0, below = first + (lanes_as<LaneMask>(fy > 0u) & width);
  LaneBits c00, c10, c01, c11;
  read_corners(k, first, below, c00, c10, c01, c11);
  LaneBits w11 = fx * fy, w10 = fx * fractions - w11, w01 = fy * fractions - w11,
           w00 = uint32_t(fractions * fractions) - w10 - w01 - w11;
  float allowed = half_step * Keyframe::step_scale / std::max(pixels, 1e-3f);
  uint32_t limit = uint32_t(std::min(allowed, 255.0f));
  if (any_lane((c00 >> 24) > limit)) {
    float apart = allowed / Keyframe::step_scale;
    Lanes own = source.disparity(x, y);
    LaneBits lost{};
    auto thin = [&](const LaneMask& index, LaneBits& weight) {
      LaneMask other = lanes_abs(lanes_as<Lanes>(gather(k.disparity.data(), index)) - own) > apart;
      lost += weight & lanes_as<LaneBits>(other);
      weight &= lanes_as<LaneBits>(~other);
    };
    thin(first, w00), thin(first + 1, w10), thin(below, w01), thin(below + 1, w11);
    // The nearest pixel is always of its own surface.
    LaneMask is_right = lanes_as<LaneMask>(fx) >= fractions / 2,
             is_below = lanes_as<LaneMask>(fy) >= fractions / 2;
    w11 += lost & lanes_as<LaneBits>(is_right & is_below),
        w10 += lost & lanes_as<LaneBits>(is_right & ~is_below);
    w01 += lost & lanes_as<LaneBits>(~is_right & is_below),
        w00 += lost & lanes_as<LaneBits>(~is_right & ~is_below);
  }
  constexpr uint32_t two = 0x00ff00ffu;
  LaneBits red_blue =
      (c00 & two) * w00 + (c10 & two) * w10 + (c01 & two) * w01 + (c11 & two) * w11 + 0x00800080u;
  auto green = [](const LaneBits& c) { return (c >> 8) & 255u; };
  LaneBits g = green(c00) * w00 + green(c10) * w10 + green(c01) * w01 + green(c11) * w11 + 128u;
  return ((red_blue >> 8) & two) | (g & 0xff00u);
}

}  // namespace wellspring::picture::warping
