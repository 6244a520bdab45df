// SPDX-License-Identifier: Apache-2.0
// What pixels of a warped picture ask of a keyframe, eight neighbours at a time: where they lie in
// it, what is to be seen there, and its colour. See picture/warp_picture.h.
#pragma once
#include <algorithm>
#include <cstring>

#include "cache/simd.h"
#include "picture/keyframe.h"

namespace wellspring::warping {

// Over that of the other view: nothing is nearer to a camera.
inline constexpr float least_depth = 1e-6f;
// Pixels that disparities within a bilinear sample may open.
inline constexpr float half_step = 0.5f;
// Pixels of a keyframe that are as many times as large as the picture's count as larger: margins
// are rounded to whole pixels, and a field of view may change a little between two keyframes.
inline constexpr float larger_pixel = 1.1f;
// Places of a bilinear sample between two pixels, as a power of 2.
inline constexpr int fractions = 16, fraction_bits = 4;

// From a pixel (x, y) and its disparity w in one view to another: one + x * across + y * down + w *
// baseline is the place there times its depth over the depth here, and that ratio.
struct Mapping {
  vec3 one, across, down, baseline;
};
inline Mapping make_mapping(const View& from, const View& to) {
  float scale = 2 * from.tan_half_fov / float(from.height);
  float focal = float(to.height) * 0.5f / to.tan_half_fov;
  auto seen = [&](vec3 d) {
    double x = dot(dvec3(d), dvec3(to.right)), y = dot(dvec3(d), dvec3(to.up)),
           z = dot(dvec3(d), dvec3(to.forward));
    return vec3(float(focal * x + 0.5 * to.width * z), float(0.5 * to.height * z - focal * y),
                float(z));
  };
  vec3 right = from.right * scale, down = from.up * -scale;
  vec3 corner =
      from.forward - right * (0.5f * float(from.width)) - down * (0.5f * float(from.height));
  return {seen(corner), seen(right), seen(down), seen(from.position - to.position)};
}

struct Place {
  f8 x, y, ratio;  // ratio: of depths, there over here
};
inline Place carry(const Mapping& m, const Place& base, const f8& w) {
  f8 z = larger(base.ratio + w * m.baseline.z, splat(least_depth));
  f8 inverse = 1.0f / z;
  return {(base.x + w * m.baseline.x) * inverse, (base.y + w * m.baseline.y) * inverse, z};
}

template <class T>
inline u8 gather(const T* from, const i8& index) {
  static_assert(sizeof(T) == 4);
#ifdef __AVX2__
  return u8(_mm256_i32gather_epi32(reinterpret_cast<const int*>(from), __m256i(index), 4));
#else
  u8 v;
  for (int i = 0; i < lanes; i++)
    std::memcpy(reinterpret_cast<uint32_t*>(&v) + i, from + index[i], 4);
  return v;
#endif
}
// Words at the places and those after them.
inline void gather_pairs(const uint32_t* from, const i8& index, u8& a, u8& b) {
#ifdef __AVX2__
  auto pairs = [&](const __m128i& i) {
    return u8(_mm256_i32gather_epi64(reinterpret_cast<const long long*>(from), i, 4));
  };
  u8 low = pairs(__m128i(low_half(as<u8>(index)))), high = pairs(__m128i(high_half(as<u8>(index))));
  a = __builtin_shufflevector(low, high, 0, 2, 4, 6, 8, 10, 12, 14);
  b = __builtin_shufflevector(low, high, 1, 3, 5, 7, 9, 11, 13, 15);
#else
  a = gather(from, index), b = gather(from, index + 1);
#endif
}
#ifdef __AVX2__
// Sixteen words in a row, of which eight are picked much faster than gathered.
struct Window {
  u8 low, high;
  explicit Window(const void* from)
      : low(load<u8>(from)), high(load<u8>(static_cast<const uint32_t*>(from) + lanes)) {}
  u8 pick(const i8& at) const {  // 0 to 15
    auto permute = [&](const u8& v) {
      return i8(_mm256_permutevar8x32_epi32(__m256i(v), __m256i(at)));
    };
    return as<u8>(at < lanes ? permute(low) : permute(high));
  }
};
#endif
inline constexpr int window = 2 * lanes;
// Whether neighbours lie in a window that begins with the first of them.
inline bool lie_close(const i8& index, int width_of_pick) {
  return !any(as<i8>(as<u8>(index - index[0]) > uint32_t(window - width_of_pick)));
}
inline i8 to_int(const f8& v) { return __builtin_convertvector(v, i8); }
inline float least(const f8& v) {
  f8 a = smaller(v, __builtin_shufflevector(v, v, 4, 5, 6, 7, 0, 1, 2, 3));
  a = smaller(a, __builtin_shufflevector(a, a, 2, 3, 0, 1, 6, 7, 4, 5));
  return std::min(a[0], a[1]);
}
inline float most(const f8& v) { return -least(-v); }
// NaN becomes 0.
inline f8 clamped(const f8& v, float high) { return smaller(larger(v, f8{}), splat(high)); }

// What every pixel asks of the keyframe.
struct Source {
  const Keyframe& k;
  Mapping to, back;  // from the new view to the keyframe's, and back
  float last_x, last_y;
  float seam = 0;  // pixels over which it passes into something else at its border
  // Its pixels are larger: colours are bilinear across silhouettes, too, which would have steps.
  bool coarse;

  Source(const Keyframe& k, const View& view)
      : k(k),
        to(make_mapping(view, k.view)),
        back(make_mapping(k.view, view)),
        last_x(float(k.view.width - 1)),
        last_y(float(k.view.height - 1)),
        coarse(k.view.tan_half_fov * float(view.height) >
               larger_pixel * view.tan_half_fov * float(k.view.height)) {}
  // Of the pixel that holds the place.
  f8 disparity(const f8& x, const f8& y) const {
    i8 index = to_int(clamped(y, last_y)) * k.view.width + to_int(clamped(x, last_x));
#ifdef __AVX2__
    if (lie_close(index, 1) && size_t(index[0]) + window <= k.disparity.size())
      return as<f8>(Window(&k.disparity[size_t(index[0])]).pick(index - index[0]));
#endif
    return as<f8>(gather(k.disparity.data(), index));
  }
  // What the keyframe shows there, as a disparity in the new view.
  f8 surface(const f8& x, const f8& y) const {
    f8 s = disparity(x, y);
    f8 z = back.one.z + x * back.across.z + y * back.down.z + s * back.baseline.z;
    return z > least_depth ? s / z : f8{};
  }
};

// Four pixels each: the first, that after it, and those below both where `below` is not `first`.
inline void read_corners(const Keyframe& k, const i8& first, const i8& below, u8& c00, u8& c10,
                         u8& c01, u8& c11) {
#ifdef __AVX2__
  size_t begin = size_t(first[0]), next = begin + size_t(k.view.width);
  if (lie_close(first, 2) && next + window <= k.color.size()) {
    i8 at = first - first[0], after = at + 1;
    Window row(&k.color[begin]), row_below(&k.color[next]);
    c00 = row.pick(at), c10 = row.pick(after);
    c01 = row_below.pick(at), c11 = row_below.pick(after);
    return;
  }
#endif
  gather_pairs(k.color.data(), first, c00, c10);
  gather_pairs(k.color.data(), below, c01, c11);
}

// Bilinear, of the pixels around that lie on the surface of the nearest of them.
inline u8 sample_color(const Source& source, const f8& x, const f8& y, float pixels) {
  const Keyframe& k = source.k;
  int width = k.view.width;
  auto place = [](const f8& v, float last) {
    return to_int(clamped(v * fractions - (0.5f * fractions - 0.5f), last * fractions));
  };
  i8 px = place(x, source.last_x), py = place(y, source.last_y);
  i8 x0 = px >> fraction_bits, y0 = py >> fraction_bits;
  u8 fx = as<u8>(px & (fractions - 1)), fy = as<u8>(py & (fractions - 1));
  // Where there is no further row its weight is 0; behind the last pixel there is one more.
  i8 first = y0 * width + x0, below = first + (as<i8>(fy > 0u) & width);
  u8 c00, c10, c01, c11;
  read_corners(k, first, below, c00, c10, c01, c11);
  u8 w11 = fx * fy, w10 = fx * fractions - w11, w01 = fy * fractions - w11,
     w00 = uint32_t(fractions * fractions) - w10 - w01 - w11;
  float allowed = half_step * Keyframe::step_scale / std::max(pixels, 1e-3f);
  uint32_t limit = uint32_t(std::min(allowed, 255.0f));
  if (any((c00 >> 24) > limit)) {
    float apart = allowed / Keyframe::step_scale;
    f8 own = source.disparity(x, y);
    u8 lost{};
    auto thin = [&](const i8& index, u8& weight) {
      i8 other = magnitude(as<f8>(gather(k.disparity.data(), index)) - own) > apart;
      lost += weight & as<u8>(other);
      weight &= as<u8>(~other);
    };
    thin(first, w00), thin(first + 1, w10), thin(below, w01), thin(below + 1, w11);
    // The nearest pixel is always of its own surface.
    i8 is_right = as<i8>(fx) >= fractions / 2, is_below = as<i8>(fy) >= fractions / 2;
    w11 += lost & as<u8>(is_right & is_below), w10 += lost & as<u8>(is_right & ~is_below);
    w01 += lost & as<u8>(~is_right & is_below), w00 += lost & as<u8>(~is_right & ~is_below);
  }
  constexpr uint32_t two = 0x00ff00ffu;
  u8 red_blue =
      (c00 & two) * w00 + (c10 & two) * w10 + (c01 & two) * w01 + (c11 & two) * w11 + 0x00800080u;
  auto green = [](const u8& c) { return (c >> 8) & 255u; };
  u8 g = green(c00) * w00 + green(c10) * w10 + green(c01) * w01 + green(c11) * w11 + 128u;
  return ((red_blue >> 8) & two) | (g & 0xff00u);
}

}  // namespace wellspring::warping
