// SPDX-License-Identifier: Apache-2.0
// Windows of pictures: what is judged is what is shown there.
#include "benchmark/show_truth.h"

#include <gtest/gtest.h>

#include "base/rng.h"
#include "judge/flip.h"

namespace wellspring::test {
namespace {

Image8 noise(int width, int height) {
  Rng rng(5);
  Image8 image{width, height, {}};
  for (int i = 0; i < 3 * width * height; i++) image.rgb.push_back(uint8_t(rng.next() >> 24));
  return image;
}

TEST(Window, ItsRaysAreThoseOfTheWholeView) {
  View whole{.position = {1, 2, 3}, .tan_half_fov = 0.4f, .width = 64, .height = 36};
  const Window window{40, 3, 16, 9};
  const View view = window_view(whole, window);
  for (const vec2 at : {vec2(0.5f, 0.5f), vec2(15.5f, 0.5f), vec2(7, 8.5f)}) {
    const Ray ray = view_ray(view, at.x, at.y);
    const Ray wanted = view_ray(whole, float(window.x) + at.x, float(window.y) + at.y);
    EXPECT_NEAR(length(ray.direction - wanted.direction), 0, 1e-6f);
    EXPECT_EQ(ray.origin, wanted.origin);
  }
}

TEST(Window, IsJudgedAsAPartOfTheWholePicture) {
  const Image8 shown = noise(96, 96), other{96, 96, std::vector<uint8_t>(3 * 96 * 96, 128)};
  const Window window{32, 40, 16, 8}, around{20, 28, 40, 32};
  Converged truth{window, around, cut(other, around), {}};
  const FlipMap map = eval_flip(shown, other);
  double sum = 0;
  for (int y = window.y; y < window.y + window.height; y++)
    for (int x = window.x; x < window.x + window.width; x++)
      sum += double(map.error[size_t(y * 96 + x)]);
  EXPECT_NEAR(judge(shown, truth), sum / (16 * 8), 1e-4);
}

}  // namespace
}  // namespace wellspring::test
