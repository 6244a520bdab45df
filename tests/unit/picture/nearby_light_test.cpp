// SPDX-License-Identifier: Apache-2.0
// The light of narrow things is that of the nearest points which show them, wherever in the
// picture.
#include "picture/cells/pixel_light.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>

#include "base/rng.h"
#include "cache/packing.h"
#include "cache/point_image.h"

namespace wellspring::test {
namespace {

constexpr int width = 37, height = 19;  // no lanes divide it, and both sides are near everywhere
constexpr uint32_t thing = 7;

struct Known {
  bool is = false;
  float samples = 0, light = 0;
};

// `share` of the pixels show the thing, half of those with samples.
std::vector<Known> make_points(float share, uint64_t seed, Frame& frame) {
  Rng rng(mix64(seed));
  auto number = [&] { return float(rng.next() >> 8) * 0x1p-24f; };
  size_t pixels = size_t(width) * size_t(height);
  frame.width = width, frame.height = height;
  frame.color.resize(pixels), frame.depth.resize(pixels);
  frame.object.resize(pixels), frame.confidence.resize(pixels);
  std::vector<Known> known(pixels);
  for (int y = 0; y < height; y++)
    for (int x = 0; x < width; x++) {
      size_t i = size_t(y) * width + size_t(x);
      bool shows = number() < share;
      uint32_t count = number() < 0.5f ? 1 + rng.next() % 20 : 0;
      float light = std::exp2(float(rng.next() % 8));
      frame.object[i] = shows ? thing : thing + 1;
      frame.depth[i] = 2;
      frame.confidence[i] =
          std::bit_cast<float>(uint32_t(pack_normal(vec3(0, 0, 1))) | count << 16);
      packed_word(frame, x, y, plane_albedo) = 0;
      packed_word(frame, x, y, plane_rest) = 0;
      packed_word(frame, x, y, plane_smooth) = pack_rgb9e5(vec3(light));
      known[i] = {shows && count > 0, float(count), light};
    }
  return known;
}

// Computes what the header says: rings one after the other until some know the light, which count
// the less the farther off they are.
NearbyLight expected(const std::vector<Known>& known, int px, int py) {
  double points = 0, sum = 0, squares = 0, light = 0, reached = 0;
  for (int ring = 0; ring <= 5 && points < 6; ring++)
    for (int y = 0; y < height; y++)
      for (int x = 0; x < width; x++) {
        const Known& k = known[size_t(y) * width + size_t(x)];
        if (std::max(std::abs(x - px), std::abs(y - py)) != ring || !k.is) continue;
        double distance2 = (x - px) * (x - px) + (y - py) * (y - py), near = 1 / (0.5 + distance2),
               left = std::max(1 - distance2 / (5.5 * 5.5), 0.0),
               weight = near * std::max(left * left, 1e-3);
        reached += near * double(k.samples);
        points++, sum += weight * double(k.samples), squares += weight * weight * double(k.samples);
        light += weight * double(k.samples * k.light);
      }
  NearbyLight found;
  if (points == 0) return found;
  found.samples = float(sum * sum / squares * (sum / reached));
  found.smooth = vec3(float(light / sum));
  return found;
}

// Light of a single point has no border: it is trusted less and less.
TEST(NearbyLight, IsTrustedLessTheFartherItIs) {
  View view{.width = width, .height = height};
  Frame frame;
  make_points(0, 1, frame);
  size_t middle = 9 * width + 18;
  frame.object[middle] = thing;
  frame.confidence[middle] = std::bit_cast<float>(uint32_t(pack_normal(vec3(0, 0, 1))) | 16u << 16);
  packed_word(frame, 18, 9, plane_smooth) = pack_rgb9e5(vec3(4));
  float before = 17;
  for (int away = 0; away <= 5; away++) {
    SeenPlace place{18 + away, 9, vec2(0), 2, vec3(0, 0, 1), vec3(0), thing};
    NearbyLight found = find_light_nearby(view, PixelRays(view), frame, place);
    EXPECT_NEAR(found.smooth.y, 4, 0.1f);
    EXPECT_LT(found.samples, before);
    before = found.samples;
  }
  EXPECT_GT(before, 0);
  EXPECT_LT(before, 1);  // less than one of sixteen samples
}

TEST(NearbyLight, RingsEndAtThePicturesBorders) {
  View view{.width = width, .height = height};
  for (float share : {0.02f, 0.2f, 1.0f}) {
    Frame frame;
    std::vector<Known> known = make_points(share, uint64_t(1000 * share), frame);
    for (int y = 0; y < height; y++)
      for (int x = 0; x < width; x++) {
        SeenPlace place{x, y, vec2(0), 2, vec3(0, 0, 1), vec3(0), thing};
        NearbyLight found = find_light_nearby(view, PixelRays(view), frame, place),
                    wanted = expected(known, x, y);
        ASSERT_NEAR(found.samples, wanted.samples, 1e-3f * wanted.samples)
            << x << " " << y << " " << share;
        ASSERT_NEAR(found.smooth.y, wanted.smooth.y, 1e-3f * wanted.smooth.y)
            << x << " " << y << " " << share;
      }
  }
}

// Cells of other things, and those that were filled from what is around, do not count.
TEST(NearbyLight, FarOffIsThatOfTheNearestCellsWithSamples) {
  constexpr int side = 40;  // cells
  Scratch scratch;
  scratch.start(cells_bytes(side * cell_size, side * cell_size));
  Cells cells;
  take_cells(cells, side * cell_size, side * cell_size, scratch);
  auto put = [&](int x, int y, uint32_t object, float samples, float light) {
    const size_t i = size_t(cells.index(x, y));
    cells.object[i] = object, cells.samples[i] = samples;
    for (int k = 0; k < 3; k++) {
      cells.smooth[size_t(k)][i] = light, cells.rest[size_t(k)][i] = 2 * light;
      cells.albedo[size_t(k)][i] = 0.5f;
    }
  };
  for (int y = 0; y < side; y++)
    for (int x = 0; x < side; x++) put(x, y, thing + 1, 4, 9);
  auto light_at = [&](int x, int y) {
    return find_light_far(cells, {x * cell_size + 1, y * cell_size + 3, vec2(0), 2, vec3(0, 0, 1),
                                  vec3(0.5f), thing});
  };
  EXPECT_EQ(light_at(20, 20).samples, 0);
  put(22, 20, thing, 0, 7);
  EXPECT_EQ(light_at(20, 20).samples, 0);
  put(26, 20, thing, 3, 1), put(20, 14, thing, 1, 5), put(20, 5, thing, 8, 8);
  const NearbyLight found = light_at(20, 20);
  EXPECT_EQ(found.samples, 4);
  EXPECT_FLOAT_EQ(found.smooth.y, 2);
  EXPECT_FLOAT_EQ(found.rest.y, 4);
  EXPECT_FLOAT_EQ(light_at(0, 0).smooth.x, 0);    // 20 cells off
  EXPECT_FLOAT_EQ(light_at(39, 39).smooth.x, 0);  // likewise
  EXPECT_FLOAT_EQ(light_at(20, 0).smooth.x, 8);   // at the border
}

}  // namespace
}  // namespace wellspring::test
