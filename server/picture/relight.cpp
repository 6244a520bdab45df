// SPDX-License-Identifier: Apache-2.0
#include "picture/relight.h"

#include <algorithm>
#include <array>

#include "base/parallel.h"
#include "frame/tone_curve.h"
#include "picture/moving_picture.h"
#include "world/texture.h"

namespace wellspring::picture {
namespace {

constexpr float unseen = 1 / 4096.0f;  // light that changes no code

std::array<float, 256> decoded() {
  std::array<float, 256> shown;
  for (size_t i = 0; i < shown.size(); i++) shown[i] = decode_srgb(uint8_t(i));
  return shown;
}

// Radiance times exposure of what a code shows; of white the least.
vec3 light_of(uint32_t color) {
  static const std::array<float, 256> shown = decoded();
  const vec3 linear(shown[color & 255], shown[color >> 8 & 255], shown[color >> 16 & 255]);
  const float peak = max_component(linear);
  if (peak <= shoulder_start) return linear;
  static constexpr float most = 0.995f;  // from there on a code says nothing
  const LaneMask code = eval_peak_codes(all_lanes(invert_shoulder(std::min(peak, most))));
  return invert_tone_curve(linear, uint8_t(code[0]));
}

// Eight pixels from lane `i` of the run on.
void put_lanes(const Keyframe& keyframe, const Lanes3& added, size_t at, int count, Image8& picture,
               std::vector<uint8_t>& peaks) {
  float light[3][lane_count] = {};
  for (int k = 0; k < count; k++) {
    const vec3 own = light_of(keyframe.color[at + size_t(k)]);
    light[0][k] = own.x, light[1][k] = own.y, light[2][k] = own.z;
  }
  const Lanes3 sum =
      Lanes3{load_lanes(light[0]), load_lanes(light[1]), load_lanes(light[2])} + added;
  uint8_t bytes[3 * lane_count];
  store_pixels(bytes, eval_tone_curve(sum));
  const LaneMask peak = eval_peak_codes(max_component(sum));
  std::copy_n(bytes, 3 * count, &picture.rgb[3 * at]);
  for (int k = 0; k < count; k++) peaks[at + size_t(k)] = uint8_t(peak[k]);
}

}  // namespace

void relight(const Keyframe& keyframe, const BackdropLight& backdrop, const Tonemap& tonemap,
             Image8& picture, std::vector<uint8_t>& peaks) {
  const View& view = keyframe.view;
  const PictureWindow whole{0, 0, view.width, view.height};
  copy_colors(keyframe, whole, picture);
  guess_peaks(picture, whole, peaks);
  parallel_for(view.height, [&](int y) {
    RunKnown reflected;
    for (int x = 0; x < view.width; x += RasterRun::most) {
      const int count = std::min(RasterRun::most, view.width - x);
      reflect_light(backdrop.surfaces, backdrop.light, x, y, count, reflected);
      const size_t at = size_t(y) * size_t(view.width) + size_t(x);
      for (int i = 0; i < count; i += lane_count) {
        const Lanes3 added = Lanes3{load_lanes(reflected.red + i), load_lanes(reflected.green + i),
                                    load_lanes(reflected.blue + i)} *
                             all_lanes(tonemap.exposure);
        const int here = std::min(count - i, lane_count);
        const unsigned lit = negative_lanes(max_component(added) > unseen) & ((1u << here) - 1);
        if (lit) put_lanes(keyframe, added, at + size_t(i), here, picture, peaks);
      }
    }
  });
}

}  // namespace wellspring::picture
