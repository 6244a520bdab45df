// SPDX-License-Identifier: Apache-2.0
// Projects all points with a z-buffer in two tiled passes (Walter, Drettakis, Greenberg 2002):
// points are transformed in order and sorted into picture tiles, then every tile is z-buffered by
// one thread in its first-level cache. There are no atomics, and the picture is the same whatever
// the number of threads.
#pragma once
#include "cache/point_cache.h"
#include "cache/point_image.h"
#include "world/view.h"

namespace wellspring::cache {

// Views of a window of a view's picture.

// A rectangle of a picture's pixels, from (left, top) on.
struct PictureWindow {
  int left = 0, top = 0, width = 0, height = 0;
  bool empty() const { return width <= 0 || height <= 0; }
};

// The view of a window as a picture of its own; the middle of that may lie off the axis.
struct WindowView : View {
  vec2 shift{0};  // pixels by which its middle lies to the right of and below the whole view's
  WindowView(const View& view) : View(view) {}
  WindowView(const View& view, const PictureWindow& window) : View(view) {
    width = window.width, height = window.height;
    tan_half_fov = view.tan_half_fov * float(height) / float(view.height);
    shift = vec2(float(window.left) + 0.5f * float(width - view.width),
                 float(window.top) + 0.5f * float(height - view.height));
  }
};

// Overwrites image.point and image.depth (image has the view's size) and the points' visible flag.
// Points behind the camera, facing away, evicted or not finite fall nowhere. The nearest wins; of
// equally near ones that of the lower index. `same_view`: keeps the verified flags.
void project_points(PointCache& points, const WindowView& view, bool same_view, Scratch& scratch,
                    PointImage& image);

// Removes points that show through gaps of a nearer surface (paper, section 3.1, on 5x5 instead of
// 3x3 neighbours): a point is removed if neighbours nearer by more than `threshold` (relative) lie
// around it, or are almost all there are. Neighbours on one side only are a silhouette and prove
// nothing, which the paper's average does not tell apart; points seen from this very view stay.
void depth_cull(PointCache& points, float threshold, PointImage& image);

// Returns how many bytes project_points() takes from the scratch.
size_t project_scratch_bytes(int capacity, int width, int height);

}  // namespace wellspring::cache
