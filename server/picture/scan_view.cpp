// SPDX-License-Identifier: Apache-2.0
#include "picture/scan_view.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/memory.h"
#include "base/parallel.h"
#include "light/visible/surface_buffer.h"
#include "scan/draw/fill_holes.h"
#include "scan/draw/point_colors.h"
#include "scan/tree/choose_nodes.h"
#include "scan/tree/point_tree.h"

namespace wellspring::picture {
namespace {

constexpr size_t moving_points = 1'000'000, settled_points = 2'500'000;
constexpr int block = 4;              // pixels across whose light is found once
constexpr int most_normals = 6;       // a block's normal is the mean of so many
constexpr float least_cosine = 0.5f;  // between a pixel's normal and its block's
constexpr float least_turn = 0.25f;   // normals of points are noisy: none makes light vanish
constexpr float least_share = 0.02f;  // a block's that faces or lies otherwise
constexpr float most_step = 0.04f;    // from a pixel to its block, as a share of the depth
constexpr std::array<glm::ivec2, 16> nearest_first = {{{2, 2},
                                                       {1, 1},
                                                       {2, 1},
                                                       {1, 2},
                                                       {3, 2},
                                                       {2, 3},
                                                       {0, 1},
                                                       {1, 0},
                                                       {3, 1},
                                                       {1, 3},
                                                       {0, 2},
                                                       {2, 0},
                                                       {3, 3},
                                                       {0, 0},
                                                       {3, 0},
                                                       {0, 3}}};

// Leads from the scene to a scan's own frame, in which one metre is 1 / scale of the scene's.
ScanCamera camera_of(const PlacedScan& placed, const View& view, vec2 offset) {
  const glm::dquat back = glm::conjugate(glm::dquat(placed.turn));
  const auto way = [&](vec3 v) { return vec3(back * dvec3(v)); };
  ScanCamera camera = picture::camera_of(view);
  camera.eye = back * (camera.eye - dvec3(placed.position)) / double(placed.scale);
  camera.right = way(view.right), camera.up = way(view.up), camera.forward = way(view.forward);
  camera.near = view.near / placed.scale;
  camera.offset = offset;
  return camera;
}

}  // namespace

ScanCamera camera_of(const View& view) {
  ScanCamera camera;
  camera.eye = dvec3(view.position);
  camera.right = view.right, camera.up = view.up, camera.forward = view.forward;
  camera.tan_half_fov = view.tan_half_fov;
  camera.width = view.width, camera.height = view.height;
  camera.axis = axis_place(view);
  camera.near = view.near;
  return camera;
}

size_t ScanWork::memory_bytes() const {
  size_t sum = 0;
  for (const PointBuffer& one : buffers)
    sum += bytes_of(one.depth, one.color, one.normal, one.classification, one.node);
  for (const std::vector<LitBlock>& one : blocks) sum += bytes_of(one);
  for (const Known& one : known) sum += one.light->memory_bytes();
  return sum;
}

namespace {

constexpr size_t most_known = 8;  // states of lamps, times scans

// Returns the light of the maps on a scan.
const StandInLight& find_light(const ShownScans& scans, int stand_in, ScanWork& work) {
  auto same = [&](const ScanWork::Known& one) {
    return one.map == scans.maps && one.stand_in == stand_in;
  };
  auto found = std::ranges::find_if(work.known, same);
  if (found == work.known.end()) {
    auto light = std::make_shared<StandInLight>(*scans.world, uint32_t(stand_in), *scans.maps);
    work.known.push_front({scans.maps, stand_in, std::move(light)});
    if (work.known.size() > most_known) work.known.pop_back();
  } else {
    work.known.splice(work.known.begin(), work.known, found);
  }
  return *work.known.front().light;
}

}  // namespace

ScanView::ScanView(const ShownScans& scans, const View& view, vec2 offset, bool settled,
                   ScanWork& work)
    : view_(view), offset_(offset) {
  work.buffers.resize(std::max(work.buffers.size(), scans.all().size()));
  work.blocks.resize(work.buffers.size());
  for (const PlacedScan& placed : scans.all()) {
    if (!placed.points) continue;
    const ScanCamera camera = camera_of(placed, view, offset);
    ChooseSettings choose;
    choose.budget = settled ? settled_points : moving_points;
    const ChosenNodes chosen = choose_nodes(*placed.points, camera, choose);
    if (chosen.nodes.empty()) continue;
    std::vector<NodePoints> nodes;
    for (const ChosenNode& one : chosen.nodes) nodes.push_back(placed.points->points_of(one.node));
    PointBuffer& buffer = work.buffers[seen_.size()];
    work.raster.draw(buffer, nodes, camera, {.blended = settled});
    fill_holes(buffer, nodes, camera);
    Seen seen{&placed, &buffer, placed.position.y + placed.scale * placed.low,
              std::max(placed.scale * (placed.high - placed.low), 1e-6f),
              glm::mat3_cast(placed.turn)};
    if (placed.look.colors == ScanColors::lit && scans.maps && placed.stand_in >= 0) {
      std::vector<LitBlock>& blocks = work.blocks[seen_.size()];
      light_blocks(find_light(scans, placed.stand_in, work), seen, blocks);
      seen.blocks = &blocks, seen.usual = scans.maps->usual;
    }
    seen_.push_back(seen);
  }
}

// Returns the normal of what a pixel sees, in the scene, towards the eye.
vec3 ScanView::normal_at(const Seen& one, int x, int y) const {
  const uint32_t word = one.buffer->normal[size_t(y) * size_t(view_.width) + size_t(x)];
  if (word == PointBuffer::no_normal)
    return -glm::normalize(PixelGrid(view_, offset_).at(float(x), float(y)));
  return one.turn * point_normal(word);
}

// Finds the light at a pixel of every block, the nearest to its middle that shows the scan. It
// faces as a few pixels around do, those that look at the eye the most: on a floor that is seen
// along itself noise turns single normals away from the eye, and so upside down.
void ScanView::light_blocks(const StandInLight& light, const Seen& seen,
                            std::vector<LitBlock>& blocks) const {
  const int columns = (view_.width + block - 1) / block, rows = (view_.height + block - 1) / block;
  blocks.resize(size_t(columns) * size_t(rows));
  const PixelGrid grid(view_, offset_);
  parallel_each(rows, [&](int row) {
    for (int column = 0; column < columns; column++) {
      LitBlock& lit = blocks[size_t(row) * size_t(columns) + size_t(column)];
      lit = {};
      vec3 place(0);
      float first = 0;
      int known = 0;
      for (const glm::ivec2 from : nearest_first) {
        const int x = column * block + from.x, y = row * block + from.y;
        if (x >= view_.width || y >= view_.height) continue;
        const float depth =
            seen.buffer->depth[size_t(y) * size_t(view_.width) + size_t(x)] * seen.placed->scale;
        if (!std::isfinite(depth)) continue;
        if (known == 0) first = depth, place = depth * grid.at(float(x), float(y));
        if (std::abs(depth - first) > most_step * first) continue;
        const vec3 normal = normal_at(seen, x, y);
        lit.normal -= normal * dot(normal, glm::normalize(grid.at(float(x), float(y))));
        if (++known == most_normals) break;
      }
      const float length = glm::length(lit.normal);
      if (!(length > 0)) continue;
      lit.normal /= length;
      const StandInLit found = light.find(view_.position + place, lit.normal);
      if (found.known) lit.light = found.light, lit.slope = found.slope, lit.depth = first;
    }
  });
}

// Returns the light on eight pixels: that of the four blocks around each, as far as they lie on the
// same surface.
Lanes3 ScanView::light_at(const Seen& one, int x, int y, const Lanes& depth) const {
  const int columns = (view_.width + block - 1) / block, rows = (view_.height + block - 1) / block;
  const float at_y = (float(y) + 0.5f) / block - 0.5f;
  const int row = int(std::floor(at_y));
  Lanes3 normal, sum;
  for (int k = 0; k < lane_count; k++)
    if (std::isfinite(depth[k])) normal.set(k, normal_at(one, x + k, y));
  Lanes weights{};
  for (int tap = 0; tap < 4; tap++) {
    const int down = std::clamp(row + (tap >> 1), 0, rows - 1);
    const float share_y = tap >> 1 ? at_y - float(row) : 1 - (at_y - float(row));
    Lanes3 light, slope, own;
    Lanes far{}, share{};
    for (int k = 0; k < lane_count; k++) {
      const float at_x = (float(x + k) + 0.5f) / block - 0.5f;
      const int column = int(std::floor(at_x));
      const float share_x = tap & 1 ? at_x - float(column) : 1 - (at_x - float(column));
      const LitBlock& lit = (*one.blocks)[size_t(down) * size_t(columns) +
                                          size_t(std::clamp(column + (tap & 1), 0, columns - 1))];
      light.set(k, lit.light), slope.set(k, lit.slope), own.set(k, lit.normal);
      far[k] = lit.depth;
      share[k] = lit.depth > 0 ? share_x * share_y + least_share : 0;
    }
    const Lanes off = (far - depth) * (1 / most_step) / depth;
    const Lanes cosine = dot(own, normal), facing = lanes_max(cosine, all_lanes(least_share));
    // A normal that turns away from all around is noise.
    const Lanes turn = cosine > least_cosine ? 1 + dot(slope, normal - own) : all_lanes(1);
    const Lanes weight = share * facing * facing / (1 + off * off * off * off);
    sum = sum + light * (weight * lanes_max(turn, all_lanes(least_turn)));
    weights += weight;
  }
  const LaneMask known = weights > 0;
  return choose(known, sum * (1 / weights), all_lanes(vec3(one.usual)));
}

// Returns the colour of what a pixel sees of a scan, `depth` metres along the axis.
vec3 ScanView::color_at(const Seen& one, int x, int y, float depth) const {
  const size_t at = size_t(y) * size_t(view_.width) + size_t(x);
  const uint32_t code = one.buffer->color[at];
  switch (one.placed->look.colors) {
    case ScanColors::captured:
    case ScanColors::lit: break;
    case ScanColors::intensity: return intensity_color(code);
    case ScanColors::classification: return class_color(one.buffer->classification[at]);
    case ScanColors::height: {
      const float up =
          view_.position.y + depth * PixelGrid(view_, offset_).at(float(x), float(y)).y;
      return height_color((up - one.lowest) / one.height);
    }
  }
  return captured_color(code);
}

SeenScan ScanView::look(int x, int y) const {
  SeenScan found;
  const int first = std::max(-x, 0), end = std::min(view_.width - x, lane_count);
  const size_t row = size_t(y) * size_t(view_.width);
  for (const Seen& one : seen_) {
    Lanes depth = all_lanes(INFINITY);
    Lanes3 color;
    for (int k = first; k < end; k++) {
      const float here = one.buffer->depth[row + size_t(x + k)] * one.placed->scale;
      if (!(here < found.depth[k])) continue;
      depth[k] = here;
      color.set(k, one.placed->look.brightness * color_at(one, x + k, y, here));
    }
    const LaneMask near = depth < found.depth;
    if (!any_lane(near)) continue;
    if (one.blocks) color = color * light_at(one, x, y, depth);
    found.light = choose(near, color, found.light);
    found.depth = near ? depth : found.depth;
    found.object = near ? all_lane_bits(one.placed->object) : found.object;
  }
  return found;
}

}  // namespace wellspring::picture
