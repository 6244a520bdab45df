// SPDX-License-Identifier: Apache-2.0
#include "picture/grass_view.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/memory.h"
#include "base/parallel.h"
#include "picture/keyframe.h"
#include "world/one_ray.h"

namespace wellspring::picture {
namespace {

constexpr int looks_across = 20, looks_down = 14;
constexpr float same_depth = 0.02f;  // share of a depth by which grass may be behind what is seen

PictureWindow window_of(const ShownLawn& shown, const View& view) {
  if (!shown.light || shown.lawn->blades == 0) return {};
  return window_around(shown.bounds, view);
}

// Returns where a ray enters a box; infinity: nowhere.
float enters(const Ray& ray, const Bounds& box) {
  float first = 0, last = INFINITY;
  for (int k = 0; k < 3; k++)
    cut_by_slab(box.low[k], box.high[k], ray.origin[k], 1 / ray.direction[k], first, last);
  return first <= last ? first : INFINITY;
}

}  // namespace

PictureWindow lawn_window(std::span<const ShownLawn> lawns, const View& view) {
  PictureWindow all;
  for (const ShownLawn& shown : lawns) all = joined(all, window_of(shown, view));
  return all;
}

bool sees_lawns(const World& world, std::span<const ShownLawn> lawns, const View& view) {
  for (const ShownLawn& shown : lawns) {
    if (shown.lawn->blades == 0) continue;
    const PictureWindow window = window_around(shown.bounds, view);
    if (window.empty()) continue;
    for (int i = 0; i < looks_across * looks_down; i++) {
      const vec2 share =
          (vec2(i % looks_across, i / looks_across) + 0.5f) / vec2(looks_across, looks_down);
      const Ray ray = view_ray(view, float(window.left) + share.x * float(window.width),
                               float(window.top) + share.y * float(window.height));
      const float enter = enters(ray, shown.bounds);
      if (enter < INFINITY && !(world.intersect(ray).t < enter)) return true;
    }
  }
  return false;
}

size_t LawnWork::memory_bytes() const {
  size_t sum = bytes_of(layers, before);
  for (const Layer& one : layers)
    sum += bytes_of(one.picture.depth, one.picture.normal, one.picture.color,
                    one.picture.height_share, one.picture.sway, one.picture.coverage);
  return sum + light.memory_bytes();
}

GrassView::GrassView(std::span<const ShownLawn> lawns, const GrassWorld& world, const View& view,
                     vec2 offset, std::span<const float> before, LawnWork& work) {
  const bool exact = !before.empty();
  if (!exact) offset = vec2(0.5f);
  std::optional<MovingShade> shade;
  if (work.layers.size() < lawns.size()) work.layers.resize(lawns.size());
  for (size_t i = 0; i < lawns.size(); i++) {
    const ShownLawn& shown = lawns[i];
    LawnWork::Layer& layer = work.layers[i];
    layer.window = window_of(shown, view), layer.drawn = false;
    const bool hidden = world.world && !sees_lawns(*world.world, lawns.subspan(i, 1), view);
    if (layer.window.empty() || hidden) continue;
    const PictureWindow& window = layer.window;
    LawnView from;
    from.eye = view.position;
    from.right = view.right, from.up = view.up, from.forward = view.forward;
    from.tan_half_fov = view.tan_half_fov * float(window.height) / float(view.height);
    from.width = window.width, from.height = window.height;
    from.axis = axis_place(view) - vec2(window.left, window.top);
    from.near = view.near;
    from.offset = offset;
    LawnDrawSettings settings;
    if (exact) {
      settings.coverage = false, settings.least_width = 0;
      work.before.resize(size_t(window.width) * size_t(window.height));
      for (int y = 0; y < window.height; y++)
        std::copy_n(&before[size_t(window.top + y) * size_t(view.width) + size_t(window.left)],
                    window.width, &work.before[size_t(y) * size_t(window.width)]);
      settings.before = work.before;
    }
    work.drawer.draw(*shown.lawn, *shown.state, shown.wind, from, settings, layer.picture);
    if (layer.picture.width != window.width) continue;  // a view that nothing can be drawn of
    if (!shade) shade.emplace(world.world ? MovingShade(*world.world) : MovingShade());
    light_grass(shown, world, *shade, view, offset, window, work.light, layer.picture);
    layer.drawn = true;
    layers_.push_back({&layer, shown.object});
  }
}

bool GrassView::shows(int x, int y, int count) const {
  return std::ranges::any_of(layers_, [&](const Seen& one) {
    const PictureWindow& w = one.layer->window;
    return y >= w.top && y < w.top + w.height && x < w.left + w.width && x + count > w.left;
  });
}

SeenLawn GrassView::look(int x, int y) const {
  SeenLawn found;
  for (const Seen& one : layers_) {
    const PictureWindow& w = one.layer->window;
    const LawnPicture& picture = one.layer->picture;
    if (y < w.top || y >= w.top + w.height) continue;
    const int first = std::max(w.left - x, 0), end = std::min(w.left + w.width - x, lane_count);
    for (int k = first; k < end; k++) {
      const size_t i = size_t(y - w.top) * size_t(w.width) + size_t(x + k - w.left);
      const float cover = picture.coverage[i], depth = picture.depth[i];
      if (!(cover > 0)) continue;
      const bool nearer = depth < found.depth[k];
      const vec3 light = cover * picture.color[i], other = found.light.at(k);
      found.light.set(k,
                      nearer ? light + (1 - cover) * other : other + (1 - found.cover[k]) * light);
      found.cover[k] += (1 - found.cover[k]) * cover;
      if (!nearer) continue;
      found.depth[k] = depth, found.object[k] = one.object;
    }
  }
  return found;
}

namespace {

// Adds the codes of what a lawn's layer shows in a row of blocks to `sums`.
void add_sways(const LawnWork::Layer& layer, float strength, const Keyframe& keyframe, int row,
               std::span<float> sums) {
  const View& view = keyframe.view;
  const PictureWindow& w = layer.window;
  const float focal = 0.5f * float(view.height) / view.tan_half_fov;
  const float scale = strength * focal / (SwayImage::unit * SwayImage::block * SwayImage::block);
  const int first = std::max(row * SwayImage::block, w.top),
            end = std::min((row + 1) * SwayImage::block, w.top + w.height);
  for (int y = first; y < end; y++)
    for (int x = w.left; x < w.left + w.width; x++) {
      const size_t from = size_t(y - w.top) * size_t(w.width) + size_t(x - w.left);
      const float cover = layer.picture.coverage[from], depth = layer.picture.depth[from];
      const float disparity = keyframe.disparity[size_t(y) * size_t(view.width) + size_t(x)];
      if (!(cover > 0) || depth * disparity > 1 + same_depth) continue;
      sums[size_t(x / SwayImage::block)] += cover * layer.picture.sway[from] * scale / depth;
    }
}

}  // namespace

SwayImage find_sway(std::span<const ShownLawn> lawns, const LawnWork& work,
                    const Keyframe& keyframe) {
  SwayImage image;
  auto sways = [&](size_t i) { return work.layers[i].drawn && lawns[i].wind.strength > 0; };
  size_t first = 0;
  const size_t count = std::min(lawns.size(), work.layers.size());
  while (first < count && !sways(first)) first++;
  if (first == count) return image;
  const View& view = keyframe.view;
  image.columns = (view.width + SwayImage::block - 1) / SwayImage::block;
  image.rows = (view.height + SwayImage::block - 1) / SwayImage::block;
  image.code.resize(size_t(image.columns) * size_t(image.rows));
  image.wind = lawns[first].wind, image.time = lawns[first].state->time;
  parallel_ranges(image.rows, 8, [&](int begin, int end) {
    std::vector<float> sums(size_t(image.columns));
    for (int row = begin; row < end; row++) {
      std::ranges::fill(sums, 0.0f);
      for (size_t i = first; i < count; i++)
        if (sways(i)) add_sways(work.layers[i], lawns[i].wind.strength, keyframe, row, sums);
      for (int column = 0; column < image.columns; column++)
        image.code[size_t(row * image.columns + column)] =
            uint8_t(std::min(std::round(sums[size_t(column)]), 255.0f));
    }
  });
  return image;
}

}  // namespace wellspring::picture
