// SPDX-License-Identifier: Apache-2.0
#include "cache/soften_edges.h"

#include <algorithm>
#include <array>
#include <cstdlib>

#include "base/parallel.h"
#include "frame/tone_curve.h"
#include "world/texture.h"

namespace wellspring {
namespace {

struct LinearPicture {
  using Pixel = vec3;
  std::vector<vec3>& color;
  vec3 read(uint32_t pixel) const { return color[pixel]; }
  void mix(const EdgeShare& edge, vec3 beyond) const {
    vec3 light = (1 - edge.share) * color[edge.pixel] + edge.share * beyond;
    color[edge.pixel] = glm::max(light, vec3(0));
  }
};

// Mixed through the tone curve.
struct ShownPicture {
  struct Pixel {
    std::array<uint8_t, 3> code;
    uint8_t peak;
  };
  Image8& image;
  std::span<uint8_t> peaks;
  const std::array<float, 256>& linear_of = linear_of_codes();

  static const std::array<float, 256>& linear_of_codes() {
    static const std::array<float, 256> linear = [] {
      std::array<float, 256> all{};
      for (size_t i = 0; i < all.size(); i++) all[i] = decode_srgb(uint8_t(i));
      return all;
    }();
    return linear;
  }
  Pixel read(uint32_t pixel) const {
    const uint8_t* c = &image.rgb[3 * size_t(pixel)];
    return {{c[0], c[1], c[2]}, peaks[pixel]};
  }
  vec3 light_of(const Pixel& p) const {
    return invert_tone_curve({linear_of[p.code[0]], linear_of[p.code[1]], linear_of[p.code[2]]},
                             p.peak);
  }
  void mix(const EdgeShare& edge, const Pixel& beyond) const {
    Pixel own = read(edge.pixel);
    int most = 0;
    for (size_t k = 0; k < 3; k++) most = std::max(most, std::abs(own.code[k] - beyond.code[k]));
    if (float(most) * edge.share < 0.5f) return;  // most creases change no code
    vec3 light = (1 - edge.share) * light_of(own) + edge.share * light_of(beyond);
    peaks[edge.pixel] = uint8_t(eval_peak_codes(all_lanes(max_component(light)))[0]);
    eval_tone_curve(light, &image.rgb[3 * size_t(edge.pixel)]);
  }
};

// All colours beyond edges are read before any pixel is written.
template <class Picture>
void soften(std::span<const std::vector<EdgeShare>> edges, const Picture& picture) {
  std::vector<std::vector<typename Picture::Pixel>> beyond(edges.size());
  parallel_ranges(int(edges.size()), 4, [&](int begin, int end) {
    for (size_t i = size_t(begin); i < size_t(end); i++) {
      beyond[i].reserve(edges[i].size());
      for (const EdgeShare& edge : edges[i]) beyond[i].push_back(picture.read(edge.other));
    }
  });
  parallel_ranges(int(edges.size()), 4, [&](int begin, int end) {
    for (size_t i = size_t(begin); i < size_t(end); i++)
      for (size_t k = 0; k < edges[i].size(); k++) picture.mix(edges[i][k], beyond[i][k]);
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

}  // namespace wellspring
