// SPDX-License-Identifier: Apache-2.0
#include "spectrum/bins.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "spectrum/color.h"
#include "spectrum/lamps.h"
#include "spectrum/observer.h"

namespace wellspring::test {
namespace {

const char* const lamps[] = {"candle", "A", "D75", "LED-B1", "LED-V2", "FL11", "HP1", "sodium"};

// A pigment whose reflectance rises at an edge.
Spectrum edge_at(double nm, double width) {
  Spectrum spectrum;
  for (size_t i = 0; i < spectrum_size; i++)
    spectrum[i] = 0.05 + 0.8 / (1 + std::exp((nm - nm_of(i)) / width));
  return spectrum;
}

double error_of(const SpectralBins& bins, const Spectrum& lamp, const Spectrum& reflectance) {
  const LampObserver observer(lamp);
  const dvec3 guess = xyz_of_means(lamp_matrix(bins, lamp), bin_means(bins, reflectance));
  return ciede2000(lab_of(observer.xyz(reflectance), observer.white()),
                   lab_of(guess, observer.white()));
}

TEST(SpectrumBins, CoverAllWavelengthsOnce) {
  const SpectralBins bins = make_bins(12);
  ASSERT_EQ(bins.count(), 12u);
  EXPECT_EQ(bins.edges_nm.front(), 359.5);
  EXPECT_EQ(bins.edges_nm.back(), 830.5);
  EXPECT_TRUE(std::ranges::is_sorted(bins.edges_nm));
  for (const Spectrum& weights : bins.weights) {
    EXPECT_NEAR(std::accumulate(weights.begin(), weights.end(), 0.0), 1, 1e-12);
    EXPECT_GE(*std::ranges::min_element(weights), 0);
  }
  for (size_t w = 0; w < spectrum_size; w++)
    EXPECT_TRUE(std::ranges::any_of(bins.weights, [&](const Spectrum& b) { return b[w] > 0; }));
}

TEST(SpectrumBins, GreySurfacesAreExactUnderEveryLamp) {
  for (const int count : {2, 8, 12, 16, 32})
    for (const BinShapes shapes : {BinShapes::estimated, BinShapes::even}) {
      const SpectralBins bins = make_bins(count, shapes);
      for (const char* name : lamps)
        EXPECT_NEAR(error_of(bins, find_lamp(name)->power, even_spectrum(0.4)), 0, 1e-6)
            << count << " " << name;
    }
}

TEST(SpectrumBins, MeansOfAShapeAreItsOwn) {
  // A mean of 1 in a bin stands for a reflectance that has this mean there, and 0 elsewhere.
  const SpectralBins bins = make_bins();
  for (size_t i = 0; i < bins.count(); i++) {
    const std::vector<double> means = bin_means(bins, bins.shapes[i]);
    for (size_t k = 0; k < bins.count(); k++) EXPECT_NEAR(means[k], i == k, 2e-3) << i << " " << k;
  }
}

TEST(SpectrumBins, TheEstimateIsNearerThanEvenBins) {
  const SpectralBins estimated = make_bins(12), even = make_bins(12, BinShapes::even);
  double sum = 0, sum_even = 0, most = 0;
  for (const char* name : lamps)
    for (const double nm : {460.0, 500.0, 540.0, 580.0, 620.0}) {
      const Spectrum lamp = find_lamp(name)->power, pigment = edge_at(nm, 12);
      const double error = error_of(estimated, lamp, pigment);
      sum += error, sum_even += error_of(even, lamp, pigment);
      most = std::max(most, error);
    }
  EXPECT_LT(sum, 0.5 * sum_even);
  EXPECT_LT(most, 1.5);
}

// A surface of which only a colour is known has that colour under daylight, and white is white in
// every bin.
TEST(SpectralBins, MeansOfAColourHaveThatColour) {
  const SpectralBins bins = make_bins();
  const std::vector<dvec3> means = color_means(bins);
  const std::vector<dvec3> daylight = lamp_matrix(bins, find_lamp("D65")->power);
  for (const dvec3& rgb : {dvec3(1, 0, 0), dvec3(0, 1, 0), dvec3(0, 0, 1), dvec3(0.8, 0.3, 0.1)}) {
    std::vector<double> own;
    for (const dvec3& one : means) own.push_back(dot(one, rgb));
    const dvec3 seen = rgb_of(xyz_of_means(daylight, own));
    for (int c = 0; c < 3; c++) EXPECT_NEAR(seen[c], rgb[c], 2e-3) << rgb.x << " " << c;
  }
  for (const dvec3& one : means) EXPECT_NEAR(one.x + one.y + one.z, 1, 1e-9);
  // The estimate is smooth: the colour of a common paint lies between black and white.
  for (const dvec3& one : means) {
    EXPECT_GT(dot(one, dvec3(0.4, 0.2, 0.1)), 0);
    EXPECT_LT(dot(one, dvec3(0.4, 0.2, 0.1)), 1);
  }
}

}  // namespace
}  // namespace wellspring::test
