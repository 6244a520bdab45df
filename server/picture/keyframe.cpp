// SPDX-License-Identifier: Apache-2.0
#include "picture/keyframe.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <mutex>
#include <stdexcept>

#include "base/memory.h"
#include "base/parallel.h"
#include "frame/disparity_code.h"
#include "frame/tonemap.h"
#include "world/texture.h"

namespace wellspring::picture {
namespace {

// Width and height over the margin on each side: turning goes sideways.
constexpr int margin_across = 40, margin_down = 45;
constexpr int widest_across = 10;       // width over the widest margin, for quick turns
constexpr float widest_tangent = 3;     // tangent from the middle of surroundings to their border
constexpr float nearest_depth = 1e-4f;  // metres, as in project_points()

float disparity_of(float depth) {
  return depth > 0 ? 1 / std::max(depth, nearest_depth)
                   : 0.0f;  // 1 / infinity is 0; NaN is not > 0
}

// Writes the steps of a row: how far apart disparities are there and in the row below.
void write_steps(const Keyframe& k, int y, uint32_t* color) {
  int width = k.view.width;
  const float* row = &k.disparity[size_t(y) * size_t(width)];
  const float* below = y + 1 < k.view.height ? row + width : row;
  auto write = [&](int x, int right) {
    float low = std::min(std::min(row[x], row[right]), std::min(below[x], below[right]));
    float high = std::max(std::max(row[x], row[right]), std::max(below[x], below[right]));
    float step = std::min((high - low) * Keyframe::step_scale + 0.999f, 255.0f);
    color[x] |= uint32_t(int(step)) << 24;
  };
  for (int x = 0; x + 1 < width; x++) write(x, x + 1);
  write(width - 1, width - 1);
}

void bound_block(const Keyframe& k, int column, int row, float& farthest, float& nearest) {
  int x0 = std::max(column * Keyframe::block - 1, 0), y0 = std::max(row * Keyframe::block - 1, 0);
  int x1 = std::min((column + 1) * Keyframe::block + 1, k.view.width),
      y1 = std::min((row + 1) * Keyframe::block + 1, k.view.height);
  float low = k.disparity[size_t(y0) * size_t(k.view.width) + size_t(x0)], high = low;
  for (int y = y0; y < y1; y++) {
    const float* line = &k.disparity[size_t(y) * size_t(k.view.width)];
    for (int x = x0; x < x1; x++) low = std::min(low, line[x]), high = std::max(high, line[x]);
  }
  farthest = low, nearest = high;
}

}  // namespace

View keyframe_view(View view, float turn) {
  int height = view.height;
  auto margin = [](int pixels, int share) { return (pixels / share + 7) / 8 * 8; };
  // At the sides a turn moves more than in the middle.
  float middle = 0.5f * float(height) / view.tan_half_fov,
        side = 0.5f * float(view.width) / middle + std::abs(view.middle.x);
  float moves = turn > 0 ? middle * (1 + side * side) * turn : 0.0f,
        most = float(view.width / widest_across);
  int turning = margin(int(std::min(moves, most)), 1);
  view.width += 2 * std::max(margin(view.width, margin_across), turning);
  view.height += 2 * margin(view.height, margin_down);
  view.tan_half_fov *= float(view.height) / float(height);
  return view;
}

View scaled_view(View view, float scale) {
  view.width = std::max(int(std::lround(scale * float(view.width))), 1);
  view.height = std::max(int(std::lround(scale * float(view.height))), 1);
  return view;
}

float disparity_unit(const View& view) {
  const float focal = 0.5f * float(view.height) / view.tan_half_fov;  // pixels
  return 0.5f / (worst_units * focal);
}

float uncovered_a_metre(const Keyframe& keyframe) {
  constexpr float of_slope = 20;  // parallax within a block of one slanted surface, pixels a metre
  const View& view = keyframe.view;
  const float focal = 0.5f * float(view.height) / view.tan_half_fov;  // pixels
  float sum = 0;
  for (size_t i = 0; i < keyframe.nearest.size(); i++) {
    const float parallax = focal * (keyframe.nearest[i] - keyframe.farthest[i]);  // pixels a metre
    sum += std::clamp((parallax - of_slope) / float(Keyframe::block), 0.0f, 1.0f);
  }
  return sum / float(std::max<size_t>(keyframe.nearest.size(), 1));
}

// Returns the direction to a place of the picture; `across` and `down` are 0 to 1.
static vec3 direction_at(const View& view, float across, float down) {
  float high = view.tan_half_fov, wide = high * float(view.width) / float(view.height);
  return view.forward + view.right * (view.middle.x + wide * (2 * across - 1)) +
         view.up * (view.middle.y + high * (1 - 2 * down));
}

View surrounding_view(std::span<const View> views, float share) {
  View around;
  around.width = around.height = 0;
  if (views.empty() || views[0].width < 1 || views[0].height < 1) return around;
  around = views[0];
  around.middle = vec2(0);
  vec3 middle(0);
  for (const View& view : views) middle += view.forward;
  if (length(middle) > 0.5f * float(views.size())) {
    around.forward = normalize(middle);
    around.right = normalize(cross(around.forward, views[0].up));
    around.up = cross(around.right, around.forward);
  }
  float wide = 0, high = 0;
  for (const View& view : views)
    for (float across : {0.0f, 0.5f, 1.0f})
      for (float down : {0.0f, 0.5f, 1.0f}) {
        vec3 d = direction_at(view, across, down);
        float z = dot(d, around.forward), x = std::abs(dot(d, around.right)),
              y = std::abs(dot(d, around.up));
        wide = std::max(wide, x < widest_tangent * z ? x / z : widest_tangent);
        high = std::max(high, y < widest_tangent * z ? y / z : widest_tangent);
      }
  wide = std::max(wide, 1e-6f), high = std::max(high, 1e-6f);
  float pixels = share * float(views[0].width) * float(views[0].height);
  auto side = [](float length) { return std::max(int(std::lround(length)), 1); };
  float across = std::min(std::sqrt(pixels * wide / high), float(views[0].width)),
        down = std::min(std::sqrt(pixels * high / wide), float(views[0].height));
  around.width = side(std::min(across, down * wide / high));
  around.height = side(float(around.width) * high / wide);
  around.tan_half_fov = std::max(high, wide * float(around.height) / float(around.width));
  return around;
}

void make_keyframe(const View& view, const Image8& picture, std::span<const float> depth,
                   Keyframe& keyframe) {
  size_t width = size_t(std::max(view.width, 0)), height = size_t(std::max(view.height, 0));
  if (width * height == 0 || picture.rgb.size() != 3 * width * height ||
      depth.size() != width * height)
    throw std::invalid_argument("make_keyframe: picture and depth are not of the view's size");
  Keyframe& k = keyframe;
  k.view = view, k.sway = {};
  k.color.resize(width * height + 1);
  k.disparity.resize(width * height + 1);
  k.columns = (view.width + Keyframe::block - 1) / Keyframe::block;
  k.rows = (view.height + Keyframe::block - 1) / Keyframe::block;
  k.farthest.resize(size_t(k.columns) * size_t(k.rows));
  k.nearest.resize(k.farthest.size());
  parallel_ranges(view.height, 16, [&](int begin, int end) {
    for (size_t i = size_t(begin) * width; i < size_t(end) * width; i++) {
      const uint8_t* rgb = &picture.rgb[3 * i];
      k.color[i] = uint32_t(rgb[0] | rgb[1] << 8 | rgb[2] << 16);
      k.disparity[i] = disparity_of(depth[i]);
    }
  });
  parallel_ranges(k.rows, 2, [&](int begin, int end) {
    for (int row = begin; row < end; row++)
      for (int column = 0; column < k.columns; column++) {
        size_t i = size_t(row) * size_t(k.columns) + size_t(column);
        bound_block(k, column, row, k.farthest[i], k.nearest[i]);
      }
    for (int y = begin * Keyframe::block; y < std::min(end * Keyframe::block, view.height); y++)
      write_steps(k, y, &k.color[size_t(y) * width]);
  });
}

size_t memory_bytes(const Keyframe& keyframe) {
  return bytes_of(keyframe.color, keyframe.disparity, keyframe.farthest, keyframe.nearest,
                  keyframe.sway.code);
}

namespace {

constexpr int run_pixels = RasterRun::most;
constexpr float margin = 2;          // pixels around what moves
constexpr float near_depth = 1e-3f;  // metres; nearer places may fall anywhere

// Holds the bounds of places in a picture, pixels.
struct Extent {
  vec2 low{INFINITY}, high{-INFINITY};
  bool behind = false;  // some lie behind the eye
  bool ahead() const { return low.x <= high.x; }
  void add(const Extent& other) {
    low = min(low, other.low), high = max(high, other.high);
    behind |= other.behind;
  }
};

Extent extent_of(std::span<const vec3> places, const View& view) {
  Extent all;
  std::mutex guard;
  parallel_ranges(int(places.size()), 4096, [&](int begin, int end) {
    Extent here;
    for (int i = begin; i < end; i++) {
      Projected at = project_point(view, places[size_t(i)]);
      if (at.depth > near_depth) here.add({vec2(at.x, at.y), vec2(at.x, at.y)});
      else here.behind = true;
    }
    std::lock_guard lock(guard);
    all.add(here);
  });
  return all;
}

int whole(float v, int most) { return int(std::clamp(v, 0.0f, float(most))); }

}  // namespace

size_t memory_bytes(const MovingPicture& picture) {
  return bytes_of(picture.rgb, picture.layer.rgb, picture.layer.disparity, picture.sway.code);
}
size_t memory_bytes(const MovingLight& light) {
  return bytes_of(light.picture.rgb, light.peaks, light.disparity);
}

void lay_over(const MovingPicture& picture, Image8& image) {
  const PictureWindow& w = picture.window;
  for (int y = 0; y < w.height; y++)
    std::memcpy(&image.rgb[3 * (size_t(w.top + y) * size_t(image.width) + size_t(w.left))],
                &picture.rgb[3 * size_t(y) * size_t(w.width)], 3 * size_t(w.width));
}

void lay_over(const MovingPicture& picture, Keyframe& keyframe) {
  const PictureWindow& w = picture.window;
  for (int y = 0; y < w.height; y++) {
    const uint8_t* from = &picture.rgb[3 * size_t(y) * size_t(w.width)];
    uint32_t* to =
        &keyframe.color[size_t(w.top + y) * size_t(keyframe.view.width) + size_t(w.left)];
    for (int x = 0; x < w.width; x++, from += 3)
      to[x] = (to[x] & 0xff000000u) | uint32_t(from[0]) | uint32_t(from[1]) << 8 |
              uint32_t(from[2]) << 16;
  }
}

namespace {

PictureWindow window_of(const Extent& extent, const View& view) {
  if (!extent.ahead()) return {};
  PictureWindow window;
  window.left = whole(extent.low.x - margin, view.width);
  window.top = whole(extent.low.y - margin, view.height);
  window.width = whole(extent.high.x + margin + 1, view.width) - window.left;
  window.height = whole(extent.high.y + margin + 1, view.height) - window.top;
  return window.empty() ? PictureWindow{} : window;
}

}  // namespace

PictureWindow window_around(const Bounds& box, const View& view) {
  vec3 corners[8];
  for (int i = 0; i < 8; i++)
    corners[i] = {i & 1 ? box.high.x : box.low.x, i & 2 ? box.high.y : box.low.y,
                  i & 4 ? box.high.z : box.low.z};
  const Extent extent = extent_of(corners, view);
  if (extent.ahead() && extent.behind) return {0, 0, view.width, view.height};
  return window_of(extent, view);
}

PictureWindow moving_window(const World& world, const View& view) {
  Extent extent;
  for (int i = 0; i < world.instance_count(); i++) {
    if (!world.is_moving(uint32_t(i)) || !world.is_visible(uint32_t(i))) continue;
    Extent of_mesh = extent_of(world.mesh_of(uint32_t(i)).positions, view);
    if (!of_mesh.ahead()) continue;
    // A mesh that reaches from before the eye to behind it may cross the whole picture.
    if (of_mesh.behind) return {0, 0, view.width, view.height};
    extent.add(of_mesh);
  }
  return window_of(extent, view);
}

PictureWindow joined(const PictureWindow& a, const PictureWindow& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  PictureWindow both;
  both.left = std::min(a.left, b.left), both.top = std::min(a.top, b.top);
  both.width = std::max(a.left + a.width, b.left + b.width) - both.left;
  both.height = std::max(a.top + a.height, b.top + b.height) - both.top;
  return both;
}

PictureWindow whole_runs(const PictureWindow& window, const View& view) {
  auto up = [](int v, int step, int most) { return std::min((v + step - 1) / step * step, most); };
  PictureWindow runs;
  runs.left = window.left / run_pixels * run_pixels;
  runs.top = window.top / cell_size * cell_size;
  runs.width = up(window.left + window.width, run_pixels, view.width) - runs.left;
  runs.height = up(window.top + window.height, cell_size, view.height) - runs.top;
  return runs;
}

void copy_colors(const Keyframe& keyframe, const PictureWindow& window, Image8& image) {
  image.width = keyframe.view.width, image.height = keyframe.view.height;
  image.rgb.resize(3 * size_t(image.width) * size_t(image.height));
  parallel_ranges(window.height, 16, [&](int begin, int end) {
    for (int y = window.top + begin; y < window.top + end; y++) {
      size_t at = size_t(y) * size_t(image.width) + size_t(window.left);
      const uint32_t* from = &keyframe.color[at];
      uint8_t* to = &image.rgb[3 * at];
      for (int x = 0; x < window.width; x++, to += 3)
        to[0] = uint8_t(from[x]), to[1] = uint8_t(from[x] >> 8), to[2] = uint8_t(from[x] >> 16);
    }
  });
}

static std::array<uint8_t, 256> find_peaks() {
  std::array<uint8_t, 256> peaks{};
  for (size_t i = 0; i < peaks.size(); i++) {
    float shown = 0.5f * (decode_srgb(uint8_t(i)) + decode_srgb(uint8_t(std::min<size_t>(i, 254))));
    float peak = shown > shoulder_start ? invert_shoulder(shown) : shown;
    peaks[i] = uint8_t(eval_peak_codes(all_lanes(peak))[0]);
  }
  return peaks;
}

void guess_peaks(const Image8& image, const PictureWindow& window, std::vector<uint8_t>& peaks) {
  static const std::array<uint8_t, 256> peak_of = find_peaks();
  peaks.resize(size_t(image.width) * size_t(image.height));
  parallel_ranges(window.height, 16, [&](int begin, int end) {
    for (int y = window.top + begin; y < window.top + end; y++) {
      size_t at = size_t(y) * size_t(image.width) + size_t(window.left);
      const uint8_t* c = &image.rgb[3 * at];
      for (int x = 0; x < window.width; x++, c += 3)
        peaks[at + size_t(x)] = peak_of[std::max({c[0], c[1], c[2]})];
    }
  });
}

void take_window(const Image8& image, const PictureWindow& w, std::vector<uint8_t>& rgb) {
  rgb.resize(3 * size_t(w.width) * size_t(w.height));
  for (int y = 0; y < w.height; y++)
    std::memcpy(&rgb[3 * size_t(y) * size_t(w.width)],
                &image.rgb[3 * (size_t(w.top + y) * size_t(image.width) + size_t(w.left))],
                3 * size_t(w.width));
}

View window_view(const View& view, const PictureWindow& window) {
  const float pixel = 2 * view.tan_half_fov / float(view.height);
  View part = view;
  part.width = window.width, part.height = window.height;
  part.tan_half_fov = 0.5f * pixel * float(window.height);
  part.middle += pixel * vec2(float(window.left) + 0.5f * float(window.width - view.width),
                              0.5f * float(view.height - window.height) - float(window.top));
  return part;
}

}  // namespace wellspring::picture
