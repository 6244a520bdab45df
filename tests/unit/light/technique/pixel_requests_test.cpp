// SPDX-License-Identifier: Apache-2.0
#include "light/technique/technique.h"

#include <gtest/gtest.h>

#include <cstring>
#include <vector>

namespace wellspring::test {
namespace {

View slanted_view() {
  Scene scene;
  View view = make_view_towards(scene, {1, 2, 3}, {-2, 1.5, -4}, {0.1f, 1, 0}, 1.1f, 37, 21);
  view.middle = {0.4f, -0.25f};
  return view;
}

std::vector<PixelSample> all_samples(const View& view, int spp) {
  std::vector<PixelSample> which;
  for (int y = 0; y < view.height; y++)
    for (int x = 0; x < view.width; x++)
      for (int i = 0; i < spp; i++) which.push_back({x, y, i});
  return which;
}

TEST(PixelRequests, AreTheSameAloneAndAmongOthers) {
  View view = slanted_view();
  std::vector<PixelSample> which = all_samples(view, 3);
  std::vector<Request> together(which.size());
  make_pixel_requests(view, 5, which, together);
  for (size_t i = 0; i < which.size(); i++) {
    Request alone = pixel_request(view, 5, which[i].x, which[i].y, which[i].index);
    ASSERT_EQ(std::memcmp(&alone.ray, &together[i].ray, sizeof(Ray)), 0) << i;
    ASSERT_EQ(alone.seed, together[i].seed);
    ASSERT_EQ(alone.index, together[i].index);
    ASSERT_EQ(alone.pixel, together[i].pixel);
  }
}

TEST(PixelRequests, LieInTheirPixelsEverywhere) {
  View view = slanted_view();
  const int spp = 16;
  std::vector<PixelSample> which = all_samples(view, spp);
  std::vector<Request> requests(which.size());
  make_pixel_requests(view, 9, which, requests);
  for (size_t i = 0; i < which.size(); i += spp) {
    int quarters[4] = {};
    for (size_t k = i; k < i + spp; k++) {
      const Ray& ray = requests[k].ray;
      ASSERT_NEAR(length(ray.direction), 1, 1e-6f);
      ASSERT_EQ(ray.origin, view.position);
      Projected at = project_point(view, ray.origin + ray.direction);
      float x = at.x - float(which[k].x), y = at.y - float(which[k].y);
      ASSERT_TRUE(x > -1e-4f && x < 1 + 1e-4f && y > -1e-4f && y < 1 + 1e-4f) << x << " " << y;
      quarters[(x < 0.5f) + 2 * (y < 0.5f)]++;
      Ray same = view_ray(view, at.x, at.y);
      ASSERT_GT(dot(same.direction, ray.direction), 1 - 1e-6f);
    }
    // Sixteen points of Sobol's sequence: four in each quarter of the pixel, but for rounding.
    for (int of_quarter : quarters) ASSERT_TRUE(of_quarter >= 3 && of_quarter <= 5) << of_quarter;
  }
}

}  // namespace
}  // namespace wellspring::test
