// SPDX-License-Identifier: Apache-2.0
#include "spectrum/lamps.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <map>

#include "spectrum/color.h"
#include "spectrum/observer.h"
#include "spectrum/read/spectra_file.h"

namespace wellspring::test {
namespace {

dvec2 chromaticity(const std::string& name) {
  const dvec3 xyz = xyz_of(find_lamp(name)->power);
  return dvec2(xyz.x, xyz.y) / (xyz.x + xyz.y + xyz.z);
}

// CIE 15:2018, table T.3 and table 10.
TEST(SpectrumLamps, HaveTheirPublishedChromaticities) {
  const std::map<std::string, dvec2> known{
      {"A", {0.44758, 0.40745}},    {"D50", {0.34567, 0.35850}}, {"D55", {0.33243, 0.34744}},
      {"D65", {0.31272, 0.32903}},  {"D75", {0.29903, 0.31488}}, {"FL2", {0.3721, 0.3751}},
      {"FL11", {0.3805, 0.3769}},   {"HP1", {0.5330, 0.4150}},   {"LED-B1", {0.4560, 0.4078}},
      {"LED-V2", {0.3781, 0.3775}}, {"E", {1 / 3.0, 1 / 3.0}}};
  for (const auto& [name, xy] : known) {
    EXPECT_NEAR(chromaticity(name).x, xy.x, 3e-4) << name;
    EXPECT_NEAR(chromaticity(name).y, xy.y, 3e-4) << name;
  }
}

TEST(SpectrumLamps, FormulasGiveTheStandardsTables) {
  const std::string file =
      std::string(WELLSPRING_DATA) + "/10_exhibits/spectra/colour/illuminants_cie.csv";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no tables of illuminants";
  const SpectraFile read = read_spectra(file, {.quantity = Quantity::power});
  int compared = 0;
  for (const NamedSpectrum& one : read.spectra) {
    const auto lamp = find_lamp(one.name);
    if (!lamp) continue;
    compared++;
    const dvec3 published = LampObserver(one.spectrum).white(),
                own = LampObserver(lamp->power).white();
    EXPECT_NEAR(own.x, published.x, 2e-4) << one.name;
    EXPECT_NEAR(own.z, published.z, 2e-4) << one.name;
  }
  EXPECT_GE(compared, 46);
}

TEST(SpectrumLamps, AllThatAreListedAreFoundAndShine) {
  for (const std::string& name : lamp_names()) {
    const auto lamp = find_lamp(name);
    ASSERT_TRUE(lamp) << name;
    EXPECT_EQ(lamp->name, name);
    EXPECT_FALSE(lamp->about.empty());
    EXPECT_GT(xyz_of(lamp->power).y, 0) << name;
  }
}

TEST(SpectrumLamps, AnyTemperatureAndAnyLinesAreLamps) {
  EXPECT_NEAR(correlated_temperature(xyz_of(find_lamp("2700K")->power))->kelvin, 2700, 2);
  EXPECT_NEAR(correlated_temperature(xyz_of(find_lamp("D5700K")->power))->kelvin, 5700, 6);
  EXPECT_TRUE(find_lamp("589.0*2+589.6"));
  for (const char* name : {"", "F", "LED", "10K", "-5K", "1e9K", "D300K", "nanK", "589*", "589+",
                           "589*-1", "900", "589*nan", "candles"})
    EXPECT_FALSE(find_lamp(name)) << name;
}

}  // namespace
}  // namespace wellspring::test
