// SPDX-License-Identifier: Apache-2.0
#include "collection/layout.h"

#include <gtest/gtest.h>

#include "collection/eigenpairs.h"
#include "unit/collection/made_sets.h"

namespace wellspring::test {
namespace {

std::vector<dvec2> draw_places(int count, uint64_t seed, dvec2 size = dvec2(1)) {
  Rng random(seed);
  std::vector<dvec2> places;
  for (int i = 0; i < count; i++)
    places.push_back(size * dvec2(double(random.uniform()), double(random.uniform())));
  return places;
}

TEST(Layout, PlacesOnAPlaneComeBack) {
  for (const int count : {2, 3, 10, 400}) {
    const auto places = draw_places(count, uint64_t(count), {3, 1});
    const Layout layout = lay_out(distances_of(places));
    EXPECT_LT(layout.stress, 1e-9) << count;
    for (int i = 0; i < count; i++) {
      EXPECT_LT(layout.item_stress[size_t(i)], 1e-9);
      for (int k = 0; k < i; k++)
        EXPECT_NEAR(glm::distance(layout.places[size_t(i)], layout.places[size_t(k)]),
                    glm::distance(places[size_t(i)], places[size_t(k)]), 1e-9);
    }
  }
}

TEST(Layout, AMapOfAsManyAsThereMayBeIsTrue) {
  EXPECT_LT(lay_out(distances_of(draw_places(most_on_map, 9))).stress, 1e-9);
}

TEST(Layout, AxesOfEqualLengthAreFoundToo) {
  const std::vector<dvec2> square = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
  EXPECT_LT(lay_out(distances_of(square)).stress, 1e-9);
  std::vector<dvec2> ring;
  for (int i = 0; i < 36; i++)
    ring.emplace_back(std::cos(i * 0.1745329252), std::sin(i * 0.1745329252));
  EXPECT_LT(lay_out(distances_of(ring)).stress, 1e-9);
}

TEST(Layout, HardCasesAreMaps) {
  const Layout one = lay_out(distances_of(std::vector<dvec2>(1)));
  EXPECT_EQ(one.places.size(), 1u);
  EXPECT_EQ(one.stress, 0);
  const Layout equal = lay_out(distances_of(std::vector<dvec2>(50, dvec2(3, 4))));
  EXPECT_EQ(equal.stress, 0);
  for (const dvec2& place : equal.places) EXPECT_EQ(glm::length(place), 0);
  std::vector<dvec2> line;
  for (int i = 0; i < 30; i++) line.emplace_back(i, 2 * i);
  EXPECT_LT(lay_out(distances_of(line)).stress, 1e-9);
  EXPECT_TRUE(lay_out({}).places.empty());
}

TEST(Layout, StressSaysWhatAMapCannotShow) {
  // Corners of a simplex: every place is as good, none is true.
  Distances apart;
  apart.count = 20;
  apart.pairs.assign(20 * 19 / 2, 1);
  EXPECT_GT(lay_out(apart).stress, 0.4);

  // One of many lies off the plane.
  std::vector<dvec3> places;
  for (const dvec2& place : draw_places(60, 5)) places.emplace_back(place, 0);
  places.emplace_back(0.5, 0.5, 0.6);
  const Layout layout = lay_out(distances_of(places));
  double others = 0;
  for (size_t i = 0; i + 1 < places.size(); i++) others = std::max(others, layout.item_stress[i]);
  EXPECT_GT(layout.item_stress.back(), 2 * layout.stress);
  EXPECT_GT(layout.item_stress.back(), others);
}

TEST(Eigenpairs, OfASmallMatrixAreAllFound) {
  const auto pairs = small_eigenpairs({2, 1, 0, 1, 2, 0, 0, 0, -5}, 3);
  ASSERT_EQ(pairs.size(), 3u);
  EXPECT_NEAR(pairs[0].value, 3, 1e-12);
  EXPECT_NEAR(pairs[1].value, 1, 1e-12);
  EXPECT_NEAR(pairs[2].value, -5, 1e-12);
  EXPECT_NEAR(std::abs(pairs[0].vector[0]), std::sqrt(0.5), 1e-12);
}

TEST(Eigenpairs, TheLargestAreFoundBesideLargeNegativeOnes) {
  // A diagonal matrix whose negative values are larger, and whose best lie close together.
  constexpr size_t n = 300;
  auto product = [](const double* in, double* out) {
    for (size_t i = 0; i < n; i++)
      for (size_t k = 0; k < product_vectors; k++) {
        const double value = i < 3 ? 1 + 0.01 * double(i) : i < 100 ? -0.2 * double(i) : 0.5;
        out[i * product_vectors + k] = value * in[i * product_vectors + k];
      }
  };
  const auto pairs = top_eigenpairs(int(n), 2, product);
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_NEAR(pairs[0].value, 1.02, 1e-9);
  EXPECT_NEAR(pairs[1].value, 1.01, 1e-9);
  EXPECT_NEAR(std::abs(pairs[0].vector[2]), 1, 1e-6);
}

}  // namespace
}  // namespace wellspring::test
