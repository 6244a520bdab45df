// SPDX-License-Identifier: Apache-2.0
#include "scan/splat_draw/draw_shown.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace wellspring::scan {
namespace {

constexpr float most_code = 32767, brightest = 64;

vec3 coefficient(const SplatSet& set, size_t i, int k) {
  const vec3 value = k == 0
                         ? set.color[i]
                         : set.harmonics[i * size_t(splat_harmonics[set.degree]) + size_t(k - 1)];
  return glm::clamp(value, -brightest, brightest);
}

void fill_block(ShownSplats& shown, size_t at, const SplatSet& set, std::span<const uint32_t> which,
                vec3 middle) {
  SplatBlock& block = shown.blocks[at];
  const int used = int(which.size()), coefficients = shown.coefficients();
  for (int lane = 0; lane < lane_count; lane++) {
    const size_t i = which[size_t(std::min(lane, used - 1))];
    const quat q = set.turn[i];
    const float length = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
    const bool turned = length > 1e-12f && std::isfinite(length);
    block.place.set(lane, set.place[i] - middle);
    block.scale.set(lane, glm::abs(set.scale[i]));
    block.turn_x[lane] = turned ? q.x / length : 0;
    block.turn_y[lane] = turned ? q.y / length : 0;
    block.turn_z[lane] = turned ? q.z / length : 0;
    block.turn_w[lane] = turned ? q.w / length : 1;
    block.opacity[lane] = lane < used ? glm::clamp(set.opacity[i], 0.0f, 1.0f) : 0;
  }
  float largest[2] = {1e-20f, 1e-20f};
  for (uint32_t i : which)
    for (int k = 0; k < coefficients; k++)
      largest[k != 0] = glm::max(largest[k != 0], max_component(glm::abs(coefficient(set, i, k))));
  block.color_scale = largest[0] / most_code;
  block.harmonics_scale = largest[1] / most_code;
  int16_t* code = shown.codes.data() + at * size_t(coefficients) * 3 * lane_count;
  for (int k = 0; k < coefficients; k++) {
    const float scale = most_code / largest[k != 0];
    for (int channel = 0; channel < 3; channel++)
      for (int lane = 0; lane < lane_count; lane++)
        *code++ = int16_t(std::lrint(
            coefficient(set, which[size_t(std::min(lane, used - 1))], k)[channel] * scale));
  }
}

}  // namespace

ShownSplats make_shown_splats(const SplatSet& set) {
  ShownSplats shown;
  SplatTree tree = make_splat_tree(set);
  shown.degree = set.degree;
  shown.middle = tree.middle;
  shown.nodes = tree.nodes;
  uint32_t blocks = 0;
  for (SplatNode& node : shown.nodes) {
    node.first = blocks;
    blocks += (node.count + lane_count - 1) / lane_count;
  }
  shown.blocks.resize(blocks);
  shown.codes.resize(size_t(blocks) * size_t(shown.coefficients()) * 3 * lane_count);
  parallel_for(int(shown.nodes.size()), [&](int n) {
    const SplatNode& from = tree.nodes[size_t(n)];
    const bool leaf = from.child_count == 0;
    std::vector<uint32_t> which(from.count);
    for (uint32_t i = 0; i < from.count; i++) which[i] = leaf ? tree.order[from.first + i] : i;
    for (uint32_t begin = 0; begin < from.count; begin += lane_count)
      fill_block(shown, shown.nodes[size_t(n)].first + begin / lane_count,
                 leaf ? set : tree.merged[size_t(n)],
                 std::span(which).subspan(begin, std::min<size_t>(lane_count, from.count - begin)),
                 leaf ? tree.middle : vec3(0));
  });
  return shown;
}

}  // namespace wellspring::scan
