// SPDX-License-Identifier: Apache-2.0
#include "visitor_paste.h"

#include <algorithm>
#include <cmath>

namespace wellspring::test {

namespace {

// Calls body(x, y, pixel) for every pixel of the area that may be changed.
template <class Body>
void for_each(const PictureArea& area, bool behind_visitors, const VisitorPicture& picture,
              const Body& body) {
  const Image8& image = picture.image;
  for (int y = std::max(area.y, 0); y < std::min(area.y + area.height, image.height); y++)
    for (int x = std::max(area.x, 0); x < std::min(area.x + area.width, image.width); x++) {
      const size_t pixel = size_t(y) * size_t(image.width) + size_t(x);
      if (!(behind_visitors && picture.of_visitor[pixel])) body(x, y, pixel);
    }
}

}  // namespace

void paste_portrait(const Image8& from, const PictureArea& part, const PictureArea& to,
                    bool behind_visitors, VisitorPicture& picture) {
  const int border = std::max(1, to.width / 16);
  for_each(to, behind_visitors, picture, [&](int x, int y, size_t pixel) {
    const int u = x - to.x, v = y - to.y;
    const bool frame = std::min({u, v, to.width - 1 - u, to.height - 1 - v}) < border;
    // The mean of what falls on the pixel.
    const int left = part.x + u * part.width / to.width,
              right = std::max(left + 1, part.x + (u + 1) * part.width / to.width),
              top = part.y + v * part.height / to.height,
              bottom = std::max(top + 1, part.y + (v + 1) * part.height / to.height);
    int sum[3] = {0, 0, 0};
    for (int b = top; b < bottom; b++)
      for (int a = left; a < right; a++)
        for (size_t c = 0; c < 3; c++)
          sum[c] += from.rgb[3 * (size_t(b) * size_t(from.width) + size_t(a)) + c];
    for (size_t c = 0; c < 3; c++)
      picture.image.rgb[3 * pixel + c] =
          frame ? uint8_t(40) : uint8_t(sum[c] / ((right - left) * (bottom - top)));
  });
}

void paste_stripes(const PictureArea& to, float phase, VisitorPicture& picture) {
  constexpr float period = 26;  // pixels
  for_each(to, true, picture, [&](int x, int y, size_t pixel) {
    const float at = (float(y) + 0.6f * float(x)) / period + phase;
    const float light = 90 + 60 * std::sin(2 * pi * at);
    for (size_t c = 0; c < 3; c++) picture.image.rgb[3 * pixel + c] = uint8_t(light);
  });
}

void turn_upside_down(VisitorPicture& picture) {
  std::vector<uint8_t>& rgb = picture.image.rgb;
  for (size_t i = 0, j = rgb.size() / 3 - 1; i < j; i++, j--)
    for (size_t c = 0; c < 3; c++) std::swap(rgb[3 * i + c], rgb[3 * j + c]);
}

}  // namespace wellspring::test
