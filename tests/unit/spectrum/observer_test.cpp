// SPDX-License-Identifier: Apache-2.0
#include "spectrum/observer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "base/read_file.h"
#include "spectrum/color.h"
#include "spectrum/lamps.h"
#include "spectrum/tables.h"
#include "spectrum/wavelength_density.h"

namespace wellspring::test {
namespace {

// Returns the table of x, y, z of CIE 1931 at every nanometre, or nothing where it is not here.
StandardTables every_nanometre() {
  const std::string file =
      std::string(WELLSPRING_DATA) + "/10_exhibits/spectra/colour/cmf_cie_1931_2deg.csv";
  if (!std::filesystem::exists(file)) return {};
  return read_standard(read_file(file, 1 << 20));
}

TEST(SpectrumObserver, IsTheStandardsAtEveryNanometre) {
  const StandardTables tables = every_nanometre();
  if (tables.empty()) GTEST_SKIP() << "no table of every nanometre";
  double sum_y = 0;
  for (size_t i = 0; i < spectrum_size; i++) {
    sum_y += matching_functions()[i].y;
    for (int c = 0; c < 3; c++)
      EXPECT_NEAR(matching_functions()[i][c], tables[size_t(c)].second.value[i], 6e-4) << nm_of(i);
  }
  EXPECT_NEAR(sum_y, 106.856917, 2e-4);
}

TEST(SpectrumObserver, EqualPowerIsEquallyMuchOfAllThree) {
  const dvec3 white = LampObserver(even_spectrum(7)).white();
  EXPECT_NEAR(white.x, 1, 2e-3);
  EXPECT_NEAR(white.y, 1, 1e-12);
  EXPECT_NEAR(white.z, 1, 2e-3);
}

// The furnace: a white surface sends back all light, and a grey one its share, under any lamp.
TEST(SpectrumObserver, WhiteSurfacesSendBackAllLight) {
  for (const char* name : {"E", "A", "D65", "candle", "FL11", "HP1", "LED-B1", "sodium"}) {
    const LampObserver lamp(find_lamp(name)->power);
    const dvec3 white = lamp.xyz(even_spectrum(1)), grey = lamp.xyz(even_spectrum(0.25));
    EXPECT_NEAR(white.y, 1, 1e-12) << name;
    for (int c = 0; c < 3; c++) {
      EXPECT_NEAR(white[c], lamp.white()[c], 1e-12) << name;
      EXPECT_NEAR(grey[c], 0.25 * lamp.white()[c], 1e-12) << name;
    }
  }
}

TEST(SpectrumObserver, SodiumShowsBrightnessAlone) {
  // All light is of one color, so all surfaces are, and yellow tells nothing from blue.
  const LampObserver lamp(find_lamp("sodium")->power);
  Spectrum blue = even_spectrum(0), yellow = even_spectrum(0);
  for (size_t i = 0; i < spectrum_size; i++) {
    blue[i] = nm_of(i) < 500 ? 0.9 : 0.2;
    yellow[i] = nm_of(i) < 500 ? 0.1 : 0.2;
  }
  EXPECT_NEAR(
      ciede2000(lab_of(lamp.xyz(blue), lamp.white()), lab_of(lamp.xyz(yellow), lamp.white())), 0,
      1e-9);
  const dvec3 line = xyz_of(find_lamp("589.0")->power);
  EXPECT_NEAR(line.x / line.y, matching_functions()[229].x / matching_functions()[229].y, 1e-9);
}

TEST(SpectrumObserver, ALineBetweenNanometresIsShared) {
  Spectrum power = even_spectrum(0);
  add_line(589.25, 4, power);
  EXPECT_NEAR(power[229], 3, 1e-9);
  EXPECT_NEAR(power[230], 1, 1e-9);
  add_line(200, 4, power), add_line(1e30, 4, power), add_line(NAN, 4, power);
  double sum = 0;
  for (const double one : power) sum += one;
  EXPECT_NEAR(sum, 4, 1e-9);
}

TEST(SpectrumGrid, MeansOfATableAreItsIntegral) {
  const SpectrumTable table{{400, 500, 600}, {0, 1, 0}};
  const Spectrum spectrum = resample(table);
  EXPECT_NEAR(spectrum[50], 0.1, 1e-12);
  EXPECT_NEAR(spectrum[140], 1 - 0.0025, 1e-12);  // the peak is a little cut off
  EXPECT_EQ(spectrum[0], 0);
  EXPECT_EQ(spectrum.back(), 0);
  double sum = 0;
  for (const double one : spectrum) sum += one;
  EXPECT_NEAR(sum, 100, 1e-9);
}

TEST(SpectrumGrid, NoiseOfFinerStepsIsAveraged) {
  SpectrumTable table;
  for (int i = 0; i < 5000; i++) {
    table.nm.push_back(350 + 0.1 * i);
    table.value.push_back(0.5 + (i % 2 ? 0.1 : -0.1));
  }
  for (const double one : resample(table)) EXPECT_NEAR(one, 0.5, 0.011);
}

TEST(SpectrumDensity, HasThePapersNormAndQuantiles) {
  const WavelengthDensity density(360, 830);
  EXPECT_NEAR(density.norm(), 253.8197, 5e-5);
  const double quantiles[][2] = {{0.01, 369.03}, {0.1, 424.34}, {0.25, 479.15}, {0.5, 545.90},
                                 {0.75, 616.86}, {0.9, 686.02}, {0.99, 795.79}};
  for (const auto& [share, nm] : quantiles) EXPECT_NEAR(density.quantile(share), nm, 5e-3);
  EXPECT_NEAR(density.quantile(0), 360, 1e-9);
  EXPECT_NEAR(density.quantile(1), 830, 1e-9);
  double sum = 0;
  for (int i = 0; i < 4700; i++) sum += 0.1 * density.at(360.05 + 0.1 * i);
  EXPECT_NEAR(sum, 1, 1e-6);
}

}  // namespace
}  // namespace wellspring::test
