// SPDX-License-Identifier: Apache-2.0
#include "picture/lit_blocks.h"

namespace wellspring::picture {
namespace {

constexpr float least_cosine = 0.5f;  // between a pixel's normal and its block's
constexpr float least_turn = 0.25f;   // normals of points are noisy: none makes light vanish
constexpr float least_share = 0.02f;  // a block's that faces or lies otherwise

}  // namespace

void LitBlocks::begin(const View& view, vec2 offset, const PictureWindow& window) {
  view_ = view, offset_ = offset, window_ = window;
  columns_ = (view.width + side - 1) / side, rows_ = (view.height + side - 1) / side;
  blocks_.assign(size_t(columns_) * size_t(rows_), LitBlock{});
}

bool LitBlocks::reach(int x, int y) const {
  if (x >= window_.left + window_.width || x + lane_count <= window_.left || y < window_.top ||
      y >= window_.top + window_.height)
    return false;
  const int half = side / 2, left = std::max(x - half, 0) / side,
            right = std::min((x + lane_count - 1 + half) / side, columns_ - 1);
  for (const int row : {std::max(y - half, 0) / side, std::min((y + half) / side, rows_ - 1)})
    for (int column = left; column <= right; column++)
      if (blocks_[size_t(row) * size_t(columns_) + size_t(column)].depth > 0) return true;
  return false;
}

Lanes3 LitBlocks::at(int x, int y, const Lanes& depth, const Lanes3& normal, float usual) const {
  const float at_y = (float(y) + 0.5f) / side - 0.5f;
  const int row = int(std::floor(at_y));
  Lanes3 sum;
  Lanes weights{};
  for (int tap = 0; tap < 4; tap++) {
    const int down = std::clamp(row + (tap >> 1), 0, rows_ - 1);
    const float share_y = tap >> 1 ? at_y - float(row) : 1 - (at_y - float(row));
    Lanes3 light, slope, own;
    Lanes far{}, share{};
    for (int k = 0; k < lane_count; k++) {
      const float at_x = (float(x + k) + 0.5f) / side - 0.5f;
      const int column = int(std::floor(at_x));
      const float share_x = tap & 1 ? at_x - float(column) : 1 - (at_x - float(column));
      const LitBlock& lit = blocks_[size_t(down) * size_t(columns_) +
                                    size_t(std::clamp(column + (tap & 1), 0, columns_ - 1))];
      light.set(k, lit.light), slope.set(k, lit.slope), own.set(k, lit.normal);
      far[k] = lit.depth;
      share[k] = lit.depth > 0 ? share_x * share_y + least_share : 0;
    }
    const Lanes off = (far - depth) * (1 / lit_blocks::most_step) / depth;
    const Lanes cosine = dot(own, normal), facing = lanes_max(cosine, all_lanes(least_share));
    // A normal that turns away from all around is noise.
    const Lanes turn = cosine > least_cosine ? 1 + dot(slope, normal - own) : all_lanes(1);
    const Lanes weight = share * facing * facing / (1 + off * off * off * off);
    sum = sum + light * (weight * lanes_max(turn, all_lanes(least_turn)));
    weights += weight;
  }
  return choose(weights > 0, sum * (1 / weights), all_lanes(vec3(usual)));
}

void LitBlocks::describe(float lift, SurfaceBuffer& surfaces) const {
  const float focal = 0.5f * float(view_.height) / view_.tan_half_fov;
  View& blocks = surfaces.view = view_;
  blocks.width = columns_, blocks.height = rows_;
  blocks.tan_half_fov = 0.5f * float(rows_ * side) / focal;
  blocks.middle.x += 0.5f * float(columns_ * side - view_.width) / focal;
  blocks.middle.y -= 0.5f * float(rows_ * side - view_.height) / focal;
  const size_t room = blocks_.size() + surface_buffer_pad;
  surfaces.depth.assign(room, INFINITY);
  surfaces.object.assign(room, 0);
  for (auto* plane : {&surfaces.nx, &surfaces.ny, &surfaces.nz}) plane->assign(room, 0);
  surfaces.lift.assign(room, lift);
  surfaces.gloss.clear(), surfaces.metallic.clear();
  for (size_t i = 0; i < blocks_.size(); i++) {
    const LitBlock& lit = blocks_[i];
    if (!(lit.depth > 0)) continue;
    surfaces.depth[i] = lit.depth;
    surfaces.nx[i] = lit.normal.x, surfaces.ny[i] = lit.normal.y, surfaces.nz[i] = lit.normal.z;
  }
}

void LitBlocks::add(const LightPlanes& light) {
  for (size_t i = 0; i < blocks_.size(); i++) {
    LitBlock& lit = blocks_[i];
    if (!(lit.depth > 0)) continue;
    const vec3 before = lit.light;
    lit.light += vec3(light.red[i], light.green[i], light.blue[i]);
    // The slope is a share of the light, of which the moving lights' part has none.
    lit.slope *= luminance(before) / std::max(luminance(lit.light), 1e-12f);
  }
}

}  // namespace wellspring::picture
