// SPDX-License-Identifier: Apache-2.0
#include "lawn/lawn.h"

#include <gtest/gtest.h>

#include "made.h"

namespace wellspring::test {
namespace {

std::shared_ptr<const ImageCodes> picture(int width, int height, std::vector<uint8_t> greys) {
  ImageCodes codes;
  codes.width = width, codes.height = height;
  for (const uint8_t grey : greys) codes.codes8.insert(codes.codes8.end(), {grey, grey, grey, 255});
  return std::make_shared<const ImageCodes>(codes);
}

std::vector<int> real_blades(const Lawn& lawn) {
  std::vector<int> found;
  for (const LawnTile& tile : lawn.tile)
    for (int i = 0; i < tile.count; i++) found.push_back(tile.begin + i);
  return found;
}

TEST(Lawn, GrowsAsDenseAsWantedInTilesOfItsRectangle) {
  LawnDescription description = small_meadow();
  description.low = {-3, 1}, description.high = {4, 3.5f};
  const Lawn lawn = make_lawn(description);
  EXPECT_NEAR(lawn.blades, 400 * 7 * 2.5f, 10);
  EXPECT_EQ(int(real_blades(lawn).size()), lawn.blades);
  EXPECT_GT(lawn.tile.size(), 10u);
  int before = 0;
  for (size_t t = 0; t < lawn.tile.size(); t++) {
    const LawnTile& tile = lawn.tile[t];
    EXPECT_EQ(tile.begin, before);
    EXPECT_EQ(tile.begin % lane_count, 0);
    before = tile.begin + (tile.count + lane_count - 1) / lane_count * lane_count;
    const vec2 corner =
        lawn.low + lawn.tile_side * vec2(int(t) % lawn.tiles.x, int(t) / lawn.tiles.x);
    for (int i = tile.begin; i < before; i++) {
      const vec2 place(lawn.x[size_t(i)], lawn.z[size_t(i)]);
      EXPECT_TRUE(all(greaterThanEqual(place, corner - 1e-5f)));
      EXPECT_TRUE(all(lessThanEqual(place, min(corner + lawn.tile_side, lawn.high) + 1e-5f)));
      if (i >= tile.begin + tile.count) {
        EXPECT_EQ(lawn.length[size_t(i)], 0);
      }
    }
  }
  EXPECT_EQ(size_t(before), lawn.x.size());
}

TEST(Lawn, FirstBladesOfATileStandForAll) {
  LawnDescription description = small_meadow();
  description.density = 4000;
  const Lawn lawn = make_lawn(description);
  vec2 sum{0};
  int count = 0;
  for (size_t t = 0; t < lawn.tile.size(); t++) {
    const LawnTile& tile = lawn.tile[t];
    const vec2 corner =
        lawn.low + lawn.tile_side * vec2(int(t) % lawn.tiles.x, int(t) / lawn.tiles.x);
    const vec2 size = min(lawn.high - corner, vec2(lawn.tile_side));
    for (int i = 0; i < tile.count / 8; i++, count++)
      sum += (vec2(lawn.x[size_t(tile.begin + i)], lawn.z[size_t(tile.begin + i)]) - corner) / size;
  }
  // The mean of n uniform places is a half, with a deviation of 0.289 / sqrt(n).
  EXPECT_NEAR(sum.x / float(count), 0.5f, 1.5f / std::sqrt(float(count)));
  EXPECT_NEAR(sum.y / float(count), 0.5f, 1.5f / std::sqrt(float(count)));
}

TEST(Lawn, SameSeedSameBladesAnotherSeedOthers) {
  LawnDescription description = small_meadow();
  const Lawn a = make_lawn(description), b = make_lawn(description);
  description.seed = 2;
  const Lawn c = make_lawn(description);
  EXPECT_EQ(a.x, b.x);
  EXPECT_EQ(a.length, b.length);
  EXPECT_EQ(a.side_x, b.side_x);
  EXPECT_NE(a.x, c.x);
}

TEST(Lawn, ExtentSaysWhereItGrows) {
  LawnDescription description = small_meadow();
  description.extent.picture = picture(2, 1, {0, 255});
  const Lawn lawn = make_lawn(description);
  int low = 0, high = 0;
  for (const int i : real_blades(lawn)) {
    low += lawn.x[size_t(i)] < -1;
    high += lawn.x[size_t(i)] > 1;
  }
  EXPECT_EQ(low, 0);  // left of the first pixel's middle
  EXPECT_NEAR(high, 400 * 4, 40);
}

TEST(Lawn, DirectionAndMessinessTurnBlades) {
  LawnDescription description = small_meadow();
  description.direction.constant = {0.9f, 0.9f, 0.5f};
  description.messiness.constant = vec3(0);
  const Lawn neat = make_lawn(description);
  const vec3 wanted = normalize(vec3(1, 1, 0));
  for (const int i : real_blades(neat)) {
    const size_t k = size_t(i);
    EXPECT_LT(glm::length(vec3(neat.grow_x[k], neat.grow_y[k], neat.grow_z[k]) - wanted), 1e-5f);
    EXPECT_EQ(neat.droop[k], description.droop);
  }
  description.messiness.constant = vec3(1);
  const Lawn messy = make_lawn(description);
  float off = 0;
  for (const int i : real_blades(messy)) {
    const size_t k = size_t(i);
    off += glm::length(vec3(messy.grow_x[k], messy.grow_y[k], messy.grow_z[k]) - wanted);
  }
  EXPECT_GT(off / float(messy.blades), 0.3f);
}

TEST(Lawn, StandsOnItsGroundAndNotWhereThereIsNone) {
  LawnDescription description = small_meadow();
  description.ground = [](float x, float z) { return x > 0 ? NAN : 2 + 0.5f * x - 0.25f * z; };
  const Lawn lawn = make_lawn(description);
  EXPECT_GT(lawn.blades, 0);
  for (const LawnTile& tile : lawn.tile) {
    for (int i = 0; i < tile.count; i++) {
      const size_t k = size_t(tile.begin + i);
      EXPECT_LE(lawn.x[k], 0);
      EXPECT_FLOAT_EQ(lawn.y[k], 2 + 0.5f * lawn.x[k] - 0.25f * lawn.z[k]);
    }
    if (tile.count < 3) continue;
    EXPECT_NEAR(tile.slope.x, 0.5f, 1e-3f);
    EXPECT_NEAR(tile.slope.y, -0.25f, 1e-3f);
  }
}

TEST(Lawn, MapIsReadBetweenPixels) {
  LawnMap map;
  map.picture = picture(2, 2, {0, 255, 255, 0});
  EXPECT_FLOAT_EQ(map.at({0.25f, 0.25f}).x, 0);
  EXPECT_FLOAT_EQ(map.at({0.75f, 0.25f}).x, 1);
  EXPECT_FLOAT_EQ(map.at({0.5f, 0.5f}).x, 0.5f);
  EXPECT_FLOAT_EQ(map.at({1, 1}).x, 0);
  map.picture = picture(1, 1, {51});
  for (const vec2 at : {vec2(0), vec2(0.3f, 0.9f), vec2(1), vec2(-4, 7)})
    EXPECT_FLOAT_EQ(map.at(at).y, 0.2f);
  ImageCodes wide;
  wide.width = wide.height = 1;
  wide.codes16 = {65535, 0, 32768, 65535};
  map.picture = std::make_shared<const ImageCodes>(wide);
  EXPECT_FLOAT_EQ(map.at({0.5f, 0.5f}).x, 1);
  EXPECT_FLOAT_EQ(map.at({0.5f, 0.5f}).z, 32768 / 65535.0f);
}

TEST(Lawn, HardDescriptionsMakeHarmlessLawns) {
  const auto count_of = [](auto change) {
    LawnDescription description = small_meadow();
    change(description);
    const Lawn lawn = make_lawn(description);
    for (const int i : real_blades(lawn)) {
      const size_t k = size_t(i);
      EXPECT_TRUE(is_finite(vec3(lawn.x[k], lawn.y[k], lawn.z[k])));
      EXPECT_TRUE(is_finite(vec3(lawn.grow_x[k], lawn.grow_y[k], lawn.grow_z[k])));
      EXPECT_TRUE(std::isfinite(lawn.length[k]) && std::isfinite(lawn.width[k]));
    }
    return lawn.blades;
  };
  using D = LawnDescription;
  EXPECT_EQ(count_of([](D& d) { d.extent.constant = vec3(0); }), 0);
  EXPECT_EQ(count_of([](D& d) { d.extent.constant = vec3(NAN); }), 0);
  EXPECT_EQ(count_of([](D& d) { d.high = d.low; }), 0);
  EXPECT_EQ(count_of([](D& d) { d.high.x = NAN; }), 0);
  EXPECT_EQ(count_of([](D& d) { d.high.x = INFINITY; }), 0);
  EXPECT_EQ(count_of([](D& d) { d.density = NAN; }), 0);
  EXPECT_EQ(count_of([](D& d) { d.ground = [](float, float) { return INFINITY; }; }), 0);
  EXPECT_GT(count_of([](D& d) { d.height = NAN, d.width = -1; }), 0);
  EXPECT_GT(count_of([](D& d) { d.direction.constant = vec3(0.5f); }), 0);
  EXPECT_GT(count_of([](D& d) { d.direction.constant = vec3(NAN); }), 0);
  EXPECT_GT(count_of([](D& d) { d.messiness.constant = vec3(NAN); }), 0);
  EXPECT_GT(count_of([](D& d) { d.extent.picture = picture(1, 1, {255}); }), 0);
  EXPECT_EQ(count_of([](D& d) { d.extent.picture = picture(1, 1, {0}); }), 0);
  EXPECT_NEAR(count_of([](D& d) { d.density = 1 / 16.0f; }), 1, 1);
  EXPECT_NEAR(count_of([](D& d) { d.most_blades = 100; }), 100, 20);
  EXPECT_NEAR(
      count_of([](D& d) { d.most_blades = 1000, d.low = vec2(-1e6f), d.high = vec2(1e6f); }), 1000,
      150);
}

TEST(Lawn, HundredsOfThousandsOfBladesAreNothingSpecial) {
  LawnDescription description;
  description.low = vec2(-10), description.high = vec2(10), description.density = 1000;
  EXPECT_NEAR(make_lawn(description).blades, 400000, 400);
}

}  // namespace
}  // namespace wellspring::test
