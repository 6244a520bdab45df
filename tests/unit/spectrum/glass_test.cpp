// SPDX-License-Identifier: Apache-2.0
#include "spectrum/glass.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "base/load_error.h"
#include "spectrum/read/dispersion_file.h"

namespace wellspring::test {
namespace {

const std::string bk7 = R"(# a comment
REFERENCES: |
    <a href="https://example.org">a: catalogue</a>
DATA:
  - type: formula 2
    wavelength_range: 0.3 2.5
    coefficients: 0 1.03961212 0.00600069867 0.231792344 0.0200179144 1.01046945 103.560653
  - type: tabulated k
    data: |
        0.400 1.0E-08
        0.700 9.0E-09
CONDITIONS:
    temperature: 293
)";

Dispersion by_formula(int formula, std::vector<double> coefficients) {
  Dispersion glass;
  glass.formula = formula, glass.coefficients = std::move(coefficients);
  glass.low_nm = 300, glass.high_nm = 2000;
  return glass;
}

std::string glass_refusal(const std::string& text) {
  try {
    read_dispersion_text("glass.yml", text);
  } catch (const LoadError& error) {
    EXPECT_EQ(error.file, "glass.yml");
    return error.where + ": " + error.what_;
  }
  return "";
}

std::string with_data(const std::string& data) { return "DATA:\n" + data; }

TEST(SpectrumGlass, CrownGlassHasItsIndexAndAbbeNumber) {
  const Dispersion glass = read_dispersion_text("N-BK7.yml", bk7);
  EXPECT_EQ(glass.name, "N-BK7");
  EXPECT_NE(glass.source.find("a: catalogue"), std::string::npos);
  EXPECT_NEAR(*index_at(glass, line_d_nm), 1.5168, 5e-6);
  EXPECT_NEAR(*abbe_number(glass), 64.17, 5e-3);
  EXPECT_NEAR(*transmittance_at(glass, 550, 0.01), 0.99783, 1e-4);
  EXPECT_FALSE(index_at(glass, 299));
  EXPECT_FALSE(index_at(glass, 2501));
}

// Values by hand for light of one micrometre, at which powers are 1; and of half of one.
TEST(SpectrumGlass, EveryFormula) {
  EXPECT_NEAR(*index_at(by_formula(1, {0, 1.25, 0.5}), 1000), std::sqrt(1 + 1.25 / 0.75), 1e-12);
  EXPECT_NEAR(*index_at(by_formula(2, {0, 1.25, 0.5}), 1000), std::sqrt(1 + 1.25 / 0.5), 1e-12);
  EXPECT_NEAR(*index_at(by_formula(3, {2, 0.5, 2}), 500), std::sqrt(2 + 0.5 * 0.25), 1e-12);
  EXPECT_NEAR(*index_at(by_formula(4, {2, 0.5, 2, 0.5, 2, 0, 0, 0, 0, 0.1, 2}), 1000),
              std::sqrt(2 + 0.5 / 0.75 + 0.1), 1e-12);
  EXPECT_NEAR(*index_at(by_formula(5, {1.5, 0.01, -2}), 500), 1.54, 1e-12);
  EXPECT_NEAR(*index_at(by_formula(6, {0, 0.02, 5}), 500), 1 + 0.02 / (5 - 4), 1e-12);
  EXPECT_NEAR(*index_at(by_formula(7, {1.5, 0.01, 0.001, 0.1, 0.2, 0.3}), 1000),
              1.5 + 0.01 / 0.972 + 0.001 / (0.972 * 0.972) + 0.6, 1e-12);
  EXPECT_NEAR(*index_at(by_formula(8, {0.2, 0.05, 0.5, 0.01}), 1000),
              std::sqrt((1 + 2 * 0.31) / (1 - 0.31)), 1e-12);
  EXPECT_NEAR(*index_at(by_formula(9, {2, 0.1, 0.5, 0.2, 0.5, 0.25}), 1000),
              std::sqrt(2 + 0.1 / 0.5 + 0.2 * 0.5 / 0.5), 1e-12);
  EXPECT_FALSE(index_at(by_formula(3, {-2}), 1000));  // a root of less than zero
}

TEST(SpectrumGlass, ATableIsNotExtrapolated) {
  const Dispersion metal = read_dispersion_text(
      "gold.yml", with_data("  - type: tabulated nk\n    data: |\n        0.4 1.6 1.9\n        0.6 "
                            "0.2 2.9\n"));
  EXPECT_NEAR(*index_at(metal, 500), 0.9, 1e-9);
  EXPECT_FALSE(index_at(metal, 650));
  EXPECT_FALSE(abbe_number(metal));
}

TEST(SpectrumGlass, LinesOutOfOrderAreMovedAndNamed) {
  const Dispersion glass = read_dispersion_text(
      "a.yml", with_data("  - type: tabulated nk\n    data: |\n        0.5 1.5 0\n        0.4 1.6 "
                         "-0.1\n        0.7 1.4 0\n"));
  EXPECT_NEAR(*index_at(glass, 450), 1.55, 1e-9);
  EXPECT_EQ(*transmittance_at(glass, 400, 1), 1);
  EXPECT_FALSE(transmittance_at(glass, 800, 1));
  ASSERT_EQ(glass.notes.size(), 2u);
  EXPECT_NE(glass.notes[1].find("extinction is below 0 at 1 wavelengths from 0.4"),
            std::string::npos);
  EXPECT_NE(glass.notes[0].find("line of 0.4 micrometres is out of order"), std::string::npos);
}

TEST(SpectrumGlass, WhatIsWrongIsNamedWithItsLine) {
  EXPECT_NE(glass_refusal("just words").find("there is no DATA"), std::string::npos);
  EXPECT_NE(glass_refusal("DATA: 3\n").find("there is no list DATA"), std::string::npos);
  EXPECT_NE(glass_refusal("DATA: [\n").find("line "), std::string::npos);
  EXPECT_NE(glass_refusal(with_data("  - type: formula 12\n    wavelength_range: 0.3 1\n"))
                .find("line 2: there is no formula 12"),
            std::string::npos);
  EXPECT_NE(
      glass_refusal(with_data("  - type: formula 5\n    wavelength_range: 0.3 1\n    coefficients: "
                              "1 x\n"))
          .find("line 4: 'x' is no number"),
      std::string::npos);
  EXPECT_NE(glass_refusal(with_data("  - type: formula 5\n    coefficients: 1\n"))
                .find("wavelength_range"),
            std::string::npos);
  EXPECT_NE(glass_refusal(with_data("  - type: tabulated k\n    data: |\n        0.5 1.5\n"))
                .find("no entry of DATA has an index"),
            std::string::npos);
  EXPECT_NE(glass_refusal(std::string(200'000, '[')), "");
}

TEST(SpectrumGlass, TheCatalogueIsReadAsPublished) {
  const std::string folder = std::string(WELLSPRING_DATA) + "/10_exhibits/spectra/";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no catalogue";
  const struct {
    const char* file;
    double index, abbe;  // 0: not compared
  } known[] = {{"schott/N-BK7.yml", 1.51680, 64.17},      {"schott/F2.yml", 1.62004, 36.37},
               {"schott/N-SF11.yml", 1.78472, 25.68},     {"schott/SF6.yml", 1.80518, 25.43},
               {"gems/C-Peter.yml", 2.41749, 0},          {"gems/Al2O3-Malitson-o.yml", 1.76817, 0},
               {"gems/Al2O3-Malitson-e.yml", 1.76010, 0}, {"gems/TiO2-Devore-o.yml", 2.61426, 0},
               {"gems/TiO2-Devore-e.yml", 2.91035, 0},    {"gems/CaCO3-Ghosh-o.yml", 1.65846, 0},
               {"gems/MgAl2O4-Tropf.yml", 1.71621, 0},    {"gems/H2O-Daimon-20.0C.yml", 1.33340, 0},
               {"gems/Au-Johnson.yml", 0.2774, 0}};
  for (const auto& [file, index, abbe] : known) {
    const Dispersion glass = read_dispersion(folder + file);
    EXPECT_NEAR(*index_at(glass, line_d_nm), index, index < 1 ? 5e-4 : 6e-6) << file;
    if (abbe > 0) {
      EXPECT_NEAR(*abbe_number(glass), abbe, 6e-3) << file;
    }
  }
  // Cinnabar is known from 620 nm only: nobody is to guess the rest.
  const Dispersion cinnabar = read_dispersion(folder + "gems/HgS-Bond-o.yml");
  EXPECT_FALSE(index_at(cinnabar, line_d_nm));
  EXPECT_TRUE(index_at(cinnabar, 650));
  int read = 0;
  for (const char* part : {"schott", "gems"})
    for (const auto& entry : std::filesystem::directory_iterator(folder + part))
      if (entry.path().extension() == ".yml" && entry.path().stem() != "about") {
        EXPECT_NO_THROW(read_dispersion(entry.path().string())) << entry.path();
        read++;
      }
  EXPECT_EQ(read, 183);
}

}  // namespace
}  // namespace wellspring::test
