// SPDX-License-Identifier: Apache-2.0
#include "spectrum/color.h"

#include <gtest/gtest.h>

#include "spectrum/lamps.h"
#include "spectrum/observer.h"

namespace wellspring::test {
namespace {

struct PublishedPair {
  dvec3 first, second;
  double difference;
};

// Table 1 of Sharma, Wu, Dalal, "The CIEDE2000 Color-Difference Formula", 2005.
const std::vector<PublishedPair> published{
    {{50.0000, 2.6772, -79.7751}, {50.0000, 0.0000, -82.7485}, 2.0425},
    {{50.0000, 3.1571, -77.2803}, {50.0000, 0.0000, -82.7485}, 2.8615},
    {{50.0000, 2.8361, -74.0200}, {50.0000, 0.0000, -82.7485}, 3.4412},
    {{50.0000, -1.3802, -84.2814}, {50.0000, 0.0000, -82.7485}, 1.0000},
    {{50.0000, -1.1848, -84.8006}, {50.0000, 0.0000, -82.7485}, 1.0000},
    {{50.0000, -0.9009, -85.5211}, {50.0000, 0.0000, -82.7485}, 1.0000},
    {{50.0000, 0.0000, 0.0000}, {50.0000, -1.0000, 2.0000}, 2.3669},
    {{50.0000, -1.0000, 2.0000}, {50.0000, 0.0000, 0.0000}, 2.3669},
    {{50.0000, 2.4900, -0.0010}, {50.0000, -2.4900, 0.0009}, 7.1792},
    {{50.0000, 2.4900, -0.0010}, {50.0000, -2.4900, 0.0010}, 7.1792},
    {{50.0000, 2.4900, -0.0010}, {50.0000, -2.4900, 0.0011}, 7.2195},
    {{50.0000, 2.4900, -0.0010}, {50.0000, -2.4900, 0.0012}, 7.2195},
    {{50.0000, -0.0010, 2.4900}, {50.0000, 0.0009, -2.4900}, 4.8045},
    {{50.0000, -0.0010, 2.4900}, {50.0000, 0.0010, -2.4900}, 4.8045},
    {{50.0000, -0.0010, 2.4900}, {50.0000, 0.0011, -2.4900}, 4.7461},
    {{50.0000, 2.5000, 0.0000}, {50.0000, 0.0000, -2.5000}, 4.3065},
    {{50.0000, 2.5000, 0.0000}, {73.0000, 25.0000, -18.0000}, 27.1492},
    {{50.0000, 2.5000, 0.0000}, {61.0000, -5.0000, 29.0000}, 22.8977},
    {{50.0000, 2.5000, 0.0000}, {56.0000, -27.0000, -3.0000}, 31.9030},
    {{50.0000, 2.5000, 0.0000}, {58.0000, 24.0000, 15.0000}, 19.4535},
    {{50.0000, 2.5000, 0.0000}, {50.0000, 3.1736, 0.5854}, 1.0000},
    {{50.0000, 2.5000, 0.0000}, {50.0000, 3.2972, 0.0000}, 1.0000},
    {{50.0000, 2.5000, 0.0000}, {50.0000, 1.8634, 0.5757}, 1.0000},
    {{50.0000, 2.5000, 0.0000}, {50.0000, 3.2592, 0.3350}, 1.0000},
    {{60.2574, -34.0099, 36.2677}, {60.4626, -34.1751, 39.4387}, 1.2644},
    {{63.0109, -31.0961, -5.8663}, {62.8187, -29.7946, -4.0864}, 1.2630},
    {{61.2901, 3.7196, -5.3901}, {61.4292, 2.2480, -4.9620}, 1.8731},
    {{35.0831, -44.1164, 3.7933}, {35.0232, -40.0716, 1.5901}, 1.8645},
    {{22.7233, 20.0904, -46.6940}, {23.0331, 14.9730, -42.5619}, 2.0373},
    {{36.4612, 47.8580, 18.3852}, {36.2715, 50.5065, 21.2231}, 1.4146},
    {{90.8027, -2.0831, 1.4410}, {91.1528, -1.6435, 0.0447}, 1.4441},
    {{90.9257, -0.5406, -0.9208}, {88.6381, -0.8985, -0.7239}, 1.5381},
    {{6.7747, -0.2908, -2.4247}, {5.8714, -0.0985, -2.2286}, 0.6377},
    {{2.0776, 0.0795, -1.1350}, {0.9033, -0.0636, -0.5514}, 0.9082},
};

TEST(SpectrumColor, AllPublishedPairsOfCiede2000) {
  ASSERT_EQ(published.size(), 34u);
  for (size_t i = 0; i < published.size(); i++) {
    const auto& [first, second, difference] = published[i];
    EXPECT_NEAR(ciede2000(first, second), difference, 5e-5) << "pair " << i + 1;
    EXPECT_NEAR(ciede2000(second, first), difference, 5e-5) << "pair " << i + 1 << ", turned";
  }
}

TEST(SpectrumColor, WhiteIsHundredAndNeutral) {
  const dvec3 white(0.95, 1, 1.09), lab = lab_of(white, white), black = lab_of(dvec3(0), white);
  EXPECT_NEAR(lab.x, 100, 1e-12);
  EXPECT_NEAR(lab.y, 0, 1e-12);
  EXPECT_NEAR(lab.z, 0, 1e-12);
  EXPECT_NEAR(black.x, 0, 1e-12);
  EXPECT_NEAR(lab_of(0.18 * white, white).x, 49.496, 1e-3);
}

TEST(SpectrumColor, AdaptationMakesOneWhiteTheOther) {
  const dvec3 candle = LampObserver(find_lamp("candle")->power).white();
  const dvec3 day = LampObserver(find_lamp("D65")->power).white();
  const dvec3 adapted = adapt_cat16(candle, candle, day);
  const dvec3 back = adapt_cat16(adapt_cat16({0.2, 0.3, 0.1}, candle, day), day, candle);
  for (int c = 0; c < 3; c++) {
    EXPECT_NEAR(adapted[c], day[c], 1e-12);
    EXPECT_NEAR(back[c], dvec3(0.2, 0.3, 0.1)[c], 1e-12);
    EXPECT_NEAR(adapt_cat16(candle, candle, day, 0)[c], candle[c], 1e-12);
  }
}

TEST(SpectrumColor, Rec709GoesThereAndBack) {
  const dvec3 rgb(0.2, 0.7, 0.05), again = rgb_of(xyz_of_rgb(rgb)), white = xyz_of_rgb(dvec3(1));
  for (int c = 0; c < 3; c++) EXPECT_NEAR(again[c], rgb[c], 1e-12);
  EXPECT_NEAR(white.x, 0.9505, 1e-4);
  EXPECT_NEAR(white.y, 1, 1e-12);
  EXPECT_NEAR(white.z, 1.0890, 2e-4);
}

TEST(SpectrumColor, BlackbodiesHaveTheirTemperature) {
  for (const double kelvin : {1930.0, 2856.0, 6500.0, 15000.0}) {
    const auto found = correlated_temperature(xyz_of(blackbody(kelvin)));
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->kelvin, kelvin, 1e-3 * kelvin);
    EXPECT_NEAR(found->duv, 0, 1e-5);
  }
  const auto day = correlated_temperature(xyz_of(find_lamp("D65")->power));
  EXPECT_NEAR(day->kelvin, 6504, 6);
  EXPECT_NEAR(day->duv, 0.0032, 2e-4);  // above the blackbodies: greener
  EXPECT_FALSE(correlated_temperature(xyz_of(find_lamp("540")->power)));
}

}  // namespace
}  // namespace wellspring::test
