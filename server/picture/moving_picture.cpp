// SPDX-License-Identifier: Apache-2.0
#include "picture/moving_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <mutex>

#include "base/memory.h"
#include "base/parallel.h"
#include "frame/tone_curve.h"
#include "world/texture.h"

namespace wellspring::picture {
namespace {

constexpr int run_pixels = RasterRun::most;
constexpr float margin = 2;          // pixels around what moves
constexpr float near_depth = 1e-3f;  // metres: what is nearer may be anywhere

// Where places fall in a picture.
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
  return bytes_of(picture.rgb, picture.layer.rgb, picture.layer.disparity);
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

PictureWindow moving_window(const World& world, const View& view) {
  Extent extent;
  for (int i = 0; i < world.instance_count(); i++) {
    if (!world.is_moving(uint32_t(i)) || !world.is_visible(uint32_t(i))) continue;
    Extent of_mesh = extent_of(world.mesh_of(uint32_t(i)).positions, view);
    if (!of_mesh.ahead()) continue;
    // What reaches from before the eye to behind it may cross the whole picture.
    if (of_mesh.behind) return {0, 0, view.width, view.height};
    extent.add(of_mesh);
  }
  if (!extent.ahead()) return {};
  PictureWindow window;
  window.left = whole(extent.low.x - margin, view.width);
  window.top = whole(extent.low.y - margin, view.height);
  window.width = whole(extent.high.x + margin + 1, view.width) - window.left;
  window.height = whole(extent.high.y + margin + 1, view.height) - window.top;
  return window.empty() ? PictureWindow{} : window;
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
