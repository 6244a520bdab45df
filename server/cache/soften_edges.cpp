// SPDX-License-Identifier: Apache-2.0
#include "cache/soften_edges.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace wellspring {
namespace {

// Codes are near enough the roots of the light they show.
vec3 read(const Image8& image, uint32_t pixel) {
  const uint8_t* p = &image.rgb[3 * size_t(pixel)];
  return vec3(p[0], p[1], p[2]) * vec3(p[0], p[1], p[2]);
}
void write(Image8& image, uint32_t pixel, vec3 light) {
  for (int k = 0; k < 3; k++)
    image.rgb[3 * size_t(pixel) + size_t(k)] =
        uint8_t(std::min(std::sqrt(std::max(light[k], 0.0f)) + 0.5f, 255.0f));
}
vec3 read(const std::vector<vec3>& color, uint32_t pixel) { return color[pixel]; }
void write(std::vector<vec3>& color, uint32_t pixel, vec3 light) {
  color[pixel] = glm::max(light, vec3(0));
}

// All colours beyond edges are read before any pixel is written.
template <class Picture>
void soften(std::span<const std::vector<EdgeShare>> edges, Picture& picture) {
  std::vector<std::vector<vec3>> beyond(edges.size());
  parallel_ranges(int(edges.size()), 4, [&](int begin, int end) {
    for (size_t i = size_t(begin); i < size_t(end); i++) {
      beyond[i].reserve(edges[i].size());
      for (const EdgeShare& edge : edges[i])
        beyond[i].push_back(edge.share * read(picture, edge.other));
    }
  });
  parallel_ranges(int(edges.size()), 4, [&](int begin, int end) {
    for (size_t i = size_t(begin); i < size_t(end); i++)
      for (size_t k = 0; k < edges[i].size(); k++) {
        const EdgeShare& edge = edges[i][k];
        write(picture, edge.pixel, (1 - edge.share) * read(picture, edge.pixel) + beyond[i][k]);
      }
  });
}

}  // namespace

void soften_edges(std::span<const std::vector<EdgeShare>> edges, Image8& image) {
  soften(edges, image);
}
void soften_edges(std::span<const std::vector<EdgeShare>> edges, std::vector<vec3>& color) {
  soften(edges, color);
}

}  // namespace wellspring
