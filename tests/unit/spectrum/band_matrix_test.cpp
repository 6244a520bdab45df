// SPDX-License-Identifier: Apache-2.0
#include "spectrum/band_matrix.h"

#include <gtest/gtest.h>

#include <random>

#include "spectrum/color.h"
#include "spectrum/lamps.h"
#include "spectrum/observer.h"
#include "spectrum/report/place_pairs.h"

namespace wellspring::test {
namespace {

using namespace spectrum;

TEST(BandMatrix, IsExactForSpectraThatAreLinearBetweenBands) {
  const std::vector<std::vector<double>> cameras = {
      {400, 410, 420, 430, 440, 450, 460, 470, 480, 490, 500, 510, 520, 530, 540, 550,
       560, 570, 580, 590, 600, 610, 620, 630, 640, 650, 660, 670, 680, 690, 700},
      {365, 420.5, 450, 505.25, 560, 630, 730, 850, 940},
      {550}};
  std::mt19937 random(3);
  for (const std::vector<double>& nm : cameras)
    for (const char* name : {"D65", "candle", "LED-B1", "FL11", "589.0*2+589.6"}) {
      SCOPED_TRACE(name);
      SpectrumTable table{nm, {}};
      for (size_t i = 0; i < nm.size(); i++) table.value.push_back(double(random() % 1000) / 1000);
      const Spectrum power = find_lamp(name)->power;
      const std::vector<dvec3> matrix = band_matrix(nm, power);
      dvec3 sum(0), white(0);
      for (size_t i = 0; i < nm.size(); i++) sum += matrix[i] * table.value[i], white += matrix[i];
      const dvec3 reference = LampObserver(power).xyz(resample(table));
      for (int c = 0; c < 3; c++) EXPECT_NEAR(sum[c], reference[c], 1e-12) << nm.size();
      EXPECT_NEAR(white.y, 1, 1e-12);
    }
}

// Two paints that have one colour in daylight: the second differs by what daylight's observer does
// not see (a metameric black, Wyszecki and Stiles 1982, section 3.8).
TEST(PlacePairs, APaintAndItsRetouchingAreFound) {
  std::vector<double> nm;
  for (int i = 0; i < 31; i++) nm.push_back(400 + 10 * i);
  const std::vector<dvec3> day = band_matrix(nm, find_lamp("D65")->power);
  std::vector<double> paint, other, black;
  for (size_t i = 0; i < nm.size(); i++) {
    paint.push_back(0.3 + 0.15 * std::sin(nm[i] / 40));
    other.push_back(0.7 - 0.01 * double(i));
    black.push_back(std::cos(nm[i] / 18));
  }
  // Removes X, Y and Z of the difference one after the other, by the part that is not seen as the
  // others, until nothing is left of any.
  for (int round = 0; round < 2000; round++)
    for (int c = 0; c < 3; c++) {
      double seen = 0, length = 0;
      for (size_t i = 0; i < nm.size(); i++) {
        seen += black[i] * day[i][c], length += day[i][c] * day[i][c];
      }
      for (size_t i = 0; i < nm.size(); i++) black[i] -= seen / length * day[i][c];
    }
  std::vector<double> retouching = paint;
  for (size_t i = 0; i < nm.size(); i++) retouching[i] += 0.12 * black[i];
  const std::vector<LampSpectrum> lamps = {*find_lamp("D65"), *find_lamp("A"), *find_lamp("FL11")};
  const LampReportSettings settings{.near_de00 = 1, .far_de00 = 2};
  // The retouching is there twice: the second pair tells nothing new.
  const std::vector<std::vector<double>> places{paint, other, retouching, retouching};
  const auto unlike = find_unlike_places(nm, places, lamps, settings);
  const auto pairs = choose_place_pairs(nm, places, lamps, settings, unlike);
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_EQ(pairs[0].first, 0u);
  EXPECT_EQ(pairs[0].second, 2u);
  EXPECT_EQ(pairs[0].near_lamp, 0u);
  EXPECT_LT(pairs[0].de00[0], 0.01);
  EXPECT_GT(pairs[0].de00[pairs[0].far_lamp], 2);
  // The table tells each difference as CIEDE2000 of the 1 nm reference does.
  for (size_t lamp = 0; lamp < lamps.size(); lamp++) {
    const LampObserver observer(lamps[lamp].power);
    const dvec3 white = LampObserver(lamps[0].power).white();
    const auto lab = [&](const std::vector<double>& values) {
      const dvec3 xyz = observer.xyz(resample({nm, values}));
      return lab_of(adapt_cat16(xyz, observer.white(), white), white);
    };
    EXPECT_NEAR(pairs[0].de00[lamp], ciede2000(lab(paint), lab(retouching)), 1e-6);
  }
  const std::string text = place_pairs_text(pairs, {"1, 1", "2, 2", "3, 3", "4, 4"}, lamps);
  EXPECT_NE(text.find("1, 1    3, 3        0.0"), std::string::npos) << text;
  EXPECT_TRUE(find_unlike_places(nm, {paint, other}, lamps, settings).empty());
  // Shards find them together, each pair once.
  const std::vector<std::vector<double>> divided{paint, paint, retouching, other};
  const auto whole = find_unlike_places(nm, divided, lamps, settings);
  auto parts = find_unlike_places(nm, divided, lamps, settings, {1, 2});
  const auto first = find_unlike_places(nm, divided, lamps, settings, {0, 2});
  EXPECT_EQ(parts.size(), 1u);
  EXPECT_EQ(first.size(), 1u);
  parts.insert(parts.end(), first.begin(), first.end());
  EXPECT_EQ(parts.size(), whole.size());
  const auto merged = choose_place_pairs(nm, divided, lamps, settings, parts);
  ASSERT_EQ(merged.size(), 1u);
  EXPECT_EQ(merged[0].first, 0u);
  EXPECT_EQ(merged[0].de00, choose_place_pairs(nm, divided, lamps, settings, whole)[0].de00);
}

}  // namespace
}  // namespace wellspring::test
