// SPDX-License-Identifier: Apache-2.0
#include "picture/scan_view.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/memory.h"
#include "base/parallel.h"
#include "light/visible/surface_buffer.h"
#include "picture/keyframe.h"
#include "scan/draw/fill_holes.h"
#include "scan/draw/point_colors.h"
#include "scan/draw/spheres.h"
#include "scan/tree/choose_nodes.h"
#include "scan/tree/point_tree.h"

namespace wellspring::picture {
namespace {

constexpr size_t moving_points = 1'000'000, settled_points = 2'500'000;
// Spheres are opaque: those behind cells that are so opaque are not drawn.
constexpr float opaque_cell = 0.9f;

// Leads from the scene to a scan's own frame, in which one metre is 1 / scale of the scene's.
ScanCamera camera_of(const PlacedScan& placed, const dvec3& zero, const View& view, vec2 offset) {
  const glm::dquat back = glm::conjugate(glm::dquat(placed.turn));
  const auto way = [&](vec3 v) { return vec3(back * dvec3(v)); };
  ScanCamera camera = picture::camera_of(view);
  camera.eye = back * (camera.eye - dvec3(placed.position)) / double(placed.scale) - zero;
  camera.right = way(view.right), camera.up = way(view.up), camera.forward = way(view.forward);
  camera.near = view.near / placed.scale;
  camera.offset = offset;
  for (const ScanCut& cut : placed.look.cuts)
    camera.cuts.push_back(
        {way(cut.normal), (cut.offset - dot(cut.normal, placed.position)) / placed.scale});
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

PictureWindow shaded_window(const MovingShade& shade, const View& view) {
  return shade.any() ? window_around(shade.bounds(), view) : PictureWindow{};
}

bool has_moved(const Bounds& before, const Bounds& now) {
  constexpr float sways = 0.25f;  // metres
  // Nothing moves where low is above high, infinite both.
  return !(before.low == now.low && before.high == now.high) &&
         !(max_component(glm::abs(before.low - now.low)) < sways &&
           max_component(glm::abs(before.high - now.high)) < sways);
}

size_t ScanWork::memory_bytes() const {
  size_t sum = raster.memory_bytes();
  for (const PointBuffer& one : buffers)
    sum += bytes_of(one.depth, one.color, one.normal, one.classification, one.node);
  for (const LitBlocks& one : blocks) sum += one.memory_bytes();
  for (const Known& one : known) sum += one.light->memory_bytes();
  return sum + light::memory_bytes(surfaces) + light::memory_bytes(bounce) +
         light::memory_bytes(light);
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
                   ScanWork& work, const DynamicImage* dynamic)
    : view_(view), offset_(offset) {
  work.buffers.resize(std::max(work.buffers.size(), scans.all().size()));
  work.blocks.resize(work.buffers.size());
  std::optional<MovingShade> shade;
  for (const PlacedScan& placed : scans.all()) {
    if (placed.sets.empty()) continue;
    const ScanSet& set = placed.sets[size_t(placed.look.set)];
    const ScanCamera camera = camera_of(placed, set.offset, view, offset);
    const bool spheres = placed.sphere > 0;
    const DiscStyle style{.spheres = spheres, .blended = settled};
    ChooseSettings choose;
    if (spheres) choose.threshold = opaque_cell;
    choose.budget = settled ? settled_points : moving_points;
    const ChosenNodes chosen = choose_nodes(*set.points, camera, choose);
    if (chosen.nodes.empty()) continue;
    std::vector<NodePoints> nodes;
    for (const ChosenNode& one : chosen.nodes)
      nodes.push_back(spheres ? spheres_of(*set.points, one.node, placed.sphere, style)
                              : set.points->points_of(one.node));
    PointBuffer& buffer = work.buffers[seen_.size()];
    work.raster.draw(buffer, nodes, camera, style);
    if (!spheres) fill_holes(buffer, nodes, camera);
    Seen seen{&placed, &buffer, placed.position.y + placed.scale * placed.low,
              std::max(placed.scale * (placed.high - placed.low), 1e-6f),
              glm::mat3_cast(placed.turn)};
    if (!shade) shade.emplace(*scans.world);
    light(scans, *shade, dynamic, seen, work.blocks[seen_.size()], work);
    seen_.push_back(seen);
  }
}

// Finds the light on a scan: of reflectance all, of others the share that what moves leaves.
void ScanView::light(const ShownScans& scans, const MovingShade& shade, const DynamicImage* dynamic,
                     Seen& seen, LitBlocks& blocks, ScanWork& work) const {
  const PlacedScan& placed = *seen.placed;
  const ScanColors colors = placed.look.colors;
  if (colors != ScanColors::captured && colors != ScanColors::lit) return;
  auto depth_at = [&](int x, int y) {
    return seen.buffer->depth[size_t(y) * size_t(view_.width) + size_t(x)] * placed.scale;
  };
  auto facing = [&](int x, int y) { return normal_at(seen, x, y); };
  seen.is_lit = colors == ScanColors::lit && scans.maps && placed.stand_in >= 0;
  const PictureWindow whole{0, 0, view_.width, view_.height};
  if (!seen.is_lit) {
    const PictureWindow window = shaded_window(shade, view_);
    if (window.empty()) return;
    blocks.begin(view_, offset_, window);
    blocks.fill(depth_at, facing, [&](vec3 place, LitBlock& lit) {
      if (!shade.reaches(place)) return false;
      lit.light = vec3(shade.eval_open(place, lit.normal, vec3(0)));
      return true;
    });
    seen.blocks = &blocks;
    return;
  }
  const StandInLight& known = find_light(scans, placed.stand_in, work);
  blocks.begin(view_, offset_, whole);
  const float block_width = LitBlocks::side * 2 * view_.tan_half_fov / float(view_.height);
  blocks.fill(depth_at, facing, [&](vec3 place, LitBlock& lit) {
    const StandInLit found = known.find(place, lit.normal);
    lit.slope = found.slope;
    lit.light = found.known && shade.any()
                    ? shade.shade(*scans.world, *scans.lights->tables, place, lit.normal, found,
                                  uint32_t(placed.stand_in), known.reach(),
                                  block_width * dot(place - view_.position, view_.forward))
                    : found.light;
    return found.known;
  });
  if (dynamic) {
    blocks.describe(known.reach(), work.surfaces);
    light_others(*scans.world, *scans.lights, *dynamic, dynamic->from, work.surfaces, work.bounce,
                 work.light);
    blocks.add(work.light);
  }
  seen.blocks = &blocks, seen.usual = scans.maps->usual;
}

// Returns the normal of what a pixel sees, in the scene, towards the eye.
vec3 ScanView::normal_at(const Seen& one, int x, int y) const {
  const uint32_t word = one.buffer->normal[size_t(y) * size_t(view_.width) + size_t(x)];
  if (word == PointBuffer::no_normal)
    return -glm::normalize(PixelGrid(view_, offset_).at(float(x), float(y)));
  return one.turn * point_normal(word);
}

Lanes3 ScanView::normals_at(const Seen& one, int x, int y, const Lanes& depth) const {
  Lanes3 normal;
  for (int k = 0; k < lane_count; k++)
    if (std::isfinite(depth[k])) normal.set(k, normal_at(one, x + k, y));
  return normal;
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
    if (one.blocks && one.blocks->reach(x, y))
      color = color * one.blocks->at(x, y, depth, normals_at(one, x, y, depth), one.usual);
    found.light = choose(near, color, found.light);
    found.depth = near ? depth : found.depth;
    found.object = near ? all_lane_bits(one.placed->object) : found.object;
  }
  return found;
}

ScanSurface ScanView::surface(int x, int y) const {
  ScanSurface found;
  const size_t at = size_t(y) * size_t(view_.width) + size_t(x);
  for (const Seen& one : seen_) {
    const float depth = one.buffer->depth[at] * one.placed->scale;
    if (!(depth < found.depth)) continue;
    found = {depth, normal_at(one, x, y), one.is_lit ? color_at(one, x, y, depth) : vec3(0),
             one.placed->object};
  }
  return found;
}

void lay_scans_over(const ShownScans& scans, const Keyframe& keyframe, ScanWork& work,
                    BackdropSurfaces& backdrop) {
  constexpr float lift = 0.1f;        // metres; stand-ins are coarser than points
  constexpr float tolerance = 1.02f;  // the keyframe's pixels are means
  SurfaceBuffer& lit = backdrop.surfaces;
  const View &view = keyframe.view, light_view = lit.view;
  auto each = [](const View& of, const auto& take) {
    parallel_each(of.height, [&](int y) {
      for (int x = 0; x < of.width; x++) take(x, y, size_t(y) * size_t(of.width) + size_t(x));
    });
  };
  const ScanView coarse(scans, light_view, vec2(0.5f), true, work);
  if (!coarse.any()) return;
  lit.lift.assign(lit.depth.size(), 0);
  each(light_view, [&](int x, int y, size_t at) {
    const ScanSurface seen = coarse.surface(x, y);
    if (!(seen.depth < lit.depth[at])) return;
    lit.depth[at] = seen.depth, lit.object[at] = seen.object, lit.lift[at] = lift;
    lit.nx[at] = seen.normal.x, lit.ny[at] = seen.normal.y, lit.nz[at] = seen.normal.z;
    if (!lit.gloss.empty()) lit.gloss[at] = 0, lit.metallic[at] = 0;
  });
  const PixelGrid grid(light_view), own(view);
  const ScanView fine(scans, view, vec2(0.5f), true, work);
  each(view, [&](int x, int y, size_t at) {
    const ScanSurface seen = fine.surface(x, y);
    if (!(seen.depth * keyframe.disparity[at] < tolerance)) return;
    const vec3 place = seen.depth * own.at(float(x), float(y));
    show_pixel(backdrop, grid, x, y, {place, seen.normal, seen.depth, seen.object},
               seen.reflectance);
  });
}

}  // namespace wellspring::picture
