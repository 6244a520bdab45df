// SPDX-License-Identifier: Apache-2.0
#include "kiosk/network/gray_view.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace wellspring::kiosk {

vec2 cut_to_picture(const Cut& cut, vec2 share) {
  const float c = std::cos(cut.angle), s = std::sin(cut.angle);
  const vec2 q = (share - vec2(0.5f)) * vec2(cut.width, cut.height);
  return cut.middle + vec2(c * q.x + s * q.y, -s * q.x + c * q.y);
}

NetworkInput cut_out(const GrayView& picture, const Cut& cut, int columns, int rows) {
  const cv::Mat whole(picture.height, picture.width, CV_8U, const_cast<uint8_t*>(picture.pixels));
  cv::Mat source = whole, out;
  vec2 origin{0};
  float scale = 1;  // pixels of `source` per pixel of the picture
  const float shrink = cut.width / float(columns);
  if (shrink > 1.2f) {
    // What the cut touches, made smaller by means over areas first.
    const float reach = 0.5f * std::hypot(cut.width, cut.height) + 2 * shrink;
    cv::Rect area(int(cut.middle.x - reach), int(cut.middle.y - reach), int(2 * reach) + 1,
                  int(2 * reach) + 1);
    area &= cv::Rect(0, 0, picture.width, picture.height);
    const int w = int(std::lround(float(area.width) / shrink));
    const int h = int(std::lround(float(area.height) / shrink));
    if (w >= 1 && h >= 1) {
      cv::resize(whole(area), source, {w, h}, 0, 0, cv::INTER_AREA);
      origin = {float(area.x), float(area.y)};
      scale = 1 / shrink;
    }
  }
  // Middles of pixels lie at halves.
  auto to_source = [&](float x, float y) {
    const vec2 p =
        cut_to_picture(cut, {(x + 0.5f) / float(columns), (y + 0.5f) / float(rows)}) - origin;
    return p * scale - vec2(0.5f);
  };
  const vec2 a = to_source(0, 0), u = to_source(1, 0) - a, v = to_source(0, 1) - a;
  const cv::Mat map = (cv::Mat_<double>(2, 3) << u.x, v.x, a.x, u.y, v.y, a.y);
  cv::warpAffine(source, out, map, {columns, rows}, cv::INTER_LINEAR | cv::WARP_INVERSE_MAP,
                 cv::BORDER_REPLICATE);
  NetworkInput input{columns, rows, std::vector<float>(3 * out.total())};
  for (size_t c = 0; c < 3; c++)
    std::copy(out.ptr(), out.ptr() + out.total(),
              input.planes.begin() + std::ptrdiff_t(c * out.total()));
  return input;
}

}  // namespace wellspring::kiosk
