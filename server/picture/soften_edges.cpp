// SPDX-License-Identifier: Apache-2.0
#include "picture/soften_edges.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"
#include "frame/tonemap.h"
#include "world/texture.h"

namespace wellspring::picture {
namespace {

// Replaces a share of a pixel's `own` light by that `beyond` the edge in what it has `become`, and
// never leaves the range of the latter two.
vec3 mix_in(float share, vec3 own, vec3 beyond, vec3 become) {
  return clamp(become + share * (beyond - own), min(become, beyond), max(become, beyond));
}

struct LinearPicture {
  using Pixel = vec3;
  std::vector<vec3>& color;
  vec3 read(uint32_t pixel) const { return color[pixel]; }
  void mix(const EdgeShare& edge, vec3 own, vec3 beyond) const {
    color[edge.pixel] = mix_in(edge.share, own, beyond, color[edge.pixel]);
  }
};

// Holds the sRGB transfer function in tables.
struct Codes {
  static constexpr int roots = 2047;  // steps from 0 to 1 of a linear value's square root
  std::array<float, 256> linear{};
  std::array<uint8_t, roots + 2> of_root{};
};
const Codes& known_codes() {
  static const Codes known = [] {
    Codes codes;
    for (size_t i = 0; i < codes.linear.size(); i++) codes.linear[i] = decode_srgb(uint8_t(i));
    for (size_t i = 0; i < codes.of_root.size(); i++) {
      float root = std::min(float(i) / Codes::roots, 1.0f);
      codes.of_root[i] = uint8_t(encode_srgb(all_lanes(root * root))[0] * 255 + 0.5f);
    }
    return codes;
  }();
  return known;
}

// Mixes light of before the tone curve.
struct ShownPicture {
  struct Pixel {
    std::array<uint8_t, 3> code;
    uint8_t peak;
  };
  Image8& image;
  std::span<uint8_t> peaks;
  const Codes& codes = known_codes();

  Pixel read(uint32_t pixel) const {
    const uint8_t* c = &image.rgb[3 * size_t(pixel)];
    return {{c[0], c[1], c[2]}, peaks[pixel]};
  }
  vec3 light_of(const Pixel& p) const {
    const auto& linear = codes.linear;
    return invert_tone_curve({linear[p.code[0]], linear[p.code[1]], linear[p.code[2]]}, p.peak);
  }
  void mix(const EdgeShare& edge, const Pixel& own, const Pixel& beyond) const {
    vec3 light = mix_in(edge.share, light_of(own), light_of(beyond), light_of(read(edge.pixel)));
    write(edge.pixel, light);
  }
  void write(uint32_t pixel, vec3 light) const {
    float peak = max_component(light), scale = 1, offset = 0;
    peaks[pixel] = uint8_t(eval_peak_codes(all_lanes(peak))[0]);
    if (peak > shoulder_start) eval_shoulder(peak, scale, offset);
    for (int k = 0; k < 3; k++) {
      float root = std::sqrt(light[k] * scale + offset);
      image.rgb[3 * size_t(pixel) + size_t(k)] = codes.of_root[size_t(root * Codes::roots + 0.5f)];
    }
  }
};

// All colours are read before any pixel is written.
template <class Picture>
void soften(std::span<const std::vector<EdgeShare>> edges, const Picture& picture) {
  using Pixel = typename Picture::Pixel;
  std::vector<std::vector<std::pair<Pixel, Pixel>>> sides(edges.size());
  parallel_ranges(int(edges.size()), 4, [&](int begin, int end) {
    for (size_t i = size_t(begin); i < size_t(end); i++) {
      sides[i].reserve(edges[i].size());
      for (const EdgeShare& edge : edges[i])
        sides[i].push_back({picture.read(edge.pixel), picture.read(edge.other)});
    }
  });
  parallel_ranges(int(edges.size()), 4, [&](int begin, int end) {
    for (size_t i = size_t(begin); i < size_t(end); i++)
      for (size_t k = 0; k < edges[i].size(); k++)
        picture.mix(edges[i][k], sides[i][k].first, sides[i][k].second);
  });
}

}  // namespace

void soften_edges(std::span<const std::vector<EdgeShare>> edges, std::vector<vec3>& color) {
  soften(edges, LinearPicture{color});
}
void soften_edges(std::span<const std::vector<EdgeShare>> edges, Image8& image,
                  std::span<uint8_t> peaks) {
  soften(edges, ShownPicture{image, peaks});
}

}  // namespace wellspring::picture
