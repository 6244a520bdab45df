// SPDX-License-Identifier: Apache-2.0
#include "store/bands/bands.h"

#include <gtest/gtest.h>

#include "base/load_error.h"
#include "spectrum/color.h"
#include "spectrum/lamps.h"
#include "spectrum/observer.h"
#include "store/bands/band_view.h"

namespace wellspring::test {
namespace {

using namespace store;
using namespace spectrum;

std::string refused_bands(const std::string& text) {
  try {
    read_bands("a.bands.json", text);
  } catch (const LoadError& error) {
    return error.what();
  }
  return "";
}

TEST(Bands, ADescriptionIsReadAndWritten) {
  const Bands bands = read_bands("a.bands.json", R"({"wavelengths_nm": [400, 500.5, 600],
    "white": [100, 200, 300], "black": 2, "gamma": 2, "source": "a museum", "files": ["a.tif"]})");
  EXPECT_EQ(bands.nm, (std::vector<double>{400, 500.5, 600}));
  EXPECT_EQ(bands.white_of(2, 255), 300);
  EXPECT_EQ(bands.files, std::vector<std::string>{"a.tif"});
  const Bands again = read_bands("a.tif", write_bands(bands));
  EXPECT_EQ(again.nm, bands.nm);
  EXPECT_EQ(again.white, bands.white);
  EXPECT_EQ(again.black, 2);
  EXPECT_EQ(again.gamma, 2);
  EXPECT_EQ(again.source, "a museum");
  EXPECT_EQ(read_bands("", R"({"wavelengths_nm": [400], "white": 7})").white_of(3, 255), 7);
  EXPECT_EQ(read_bands("", R"({"wavelengths_nm": [400]})").white_of(3, 255), 255);
}

TEST(Bands, OpenLimesDescriptionIsRead) {
  const Bands bands = read_bands("a.json", R"({"title": "Oil", "attribution": "University",
    "url": "https://example.org/", "dataset": [{"filename": "01.png", "wavelength": 400},
    {"filename": "02.png", "wavelength": 410}]})");
  EXPECT_EQ(bands.nm, (std::vector<double>{400, 410}));
  EXPECT_EQ(bands.files, (std::vector<std::string>{"01.png", "02.png"}));
  EXPECT_EQ(bands.source, "University");
}

TEST(Bands, WhatIsWrongIsNamedWithItsPlace) {
  const std::pair<const char*, const char*> wrong[] = {
      {R"({})", "names no wavelengths"},
      {R"({"wavelengths_nm": [0.4, 0.41, 0.42]})",
       "line 1, /wavelengths_nm/0: is 0.4: wavelengths are nanometres here, not micrometres: 400"},
      {R"({"wavelengths_nm": [400, 410, 410]})", "/wavelengths_nm/2: 410 nm is there twice"},
      {R"({"wavelengths_nm": [400, 420, 410]})",
       "/wavelengths_nm/2: 410 nm comes after 420 nm: bands go from short to long"},
      {R"({"wavelengths_nm": [400, "500"]})", "/wavelengths_nm/1: is not a number"},
      {R"({"wavelengths_nm": [400, 1e9]})", "/wavelengths_nm/1: is not a number from 0 to 20000"},
      {R"({"wavelengths_nm": [50, 400]})", "/wavelengths_nm/0: is 50: nanometres from 100"},
      {R"({"wavelengths_nm": [400, 500], "files": ["a.png", "b.png", "c.png"]})",
       "/files: names 3 files for 2 wavelengths"},
      {R"({"wavelengths_nm": [400, 500], "white": [1, 2, 3]})", "/white: has 3 codes for 2"},
      {R"({"wavelengths_nm": [400, 500], "white": 5, "black": 5})", "/white: 5 is not above black"},
      {R"({"wavelengths_nm": [400, 500], "gamma": 0})", "/gamma: is not a number from 0.2"},
      {R"({"wavelengths": [400, 500]})", "is unknown; did you mean 'wavelengths_nm'"},
      {R"({"dataset": [{"filename": "a.png", "wavelength": 0.4}]})", "not micrometres: 400"}};
  for (const auto& [text, what] : wrong)
    EXPECT_NE(refused_bands(text).find(what), std::string::npos)
        << text << ": " << refused_bands(text);
}

std::string refused_view(const Bands& bands, const BandView& view) {
  try {
    weigh_bands("a.tif", bands, view);
  } catch (const LoadError& error) {
    return error.what();
  }
  return "";
}

Bands visible_bands() {
  Bands bands;
  for (int nm = 400; nm <= 700; nm += 10) bands.nm.push_back(nm);
  return bands;
}

dvec3 sum_of(const BandWeights& weights) {
  dvec3 sum(0);
  for (const dvec3& one : weights) sum += one;
  return sum;
}

TEST(Bands, WhiteStaysWhiteOrIsAsBrightAsItCanBe) {
  const Bands bands = visible_bands();
  for (const BandView& view : {BandView{}, BandView{"candle", true, {}}, BandView{"", false, {550}},
                               BandView{"", false, {700, 550, 450}}})
    for (int c = 0; c < 3; c++) EXPECT_NEAR(sum_of(weigh_bands("", bands, view))[c], 1, 3e-3);
  const dvec3 candle = sum_of(weigh_bands("", bands, {"candle", false, {}}));
  const dvec3 lamp = rgb_of(LampObserver(find_lamp("candle")->power).white());
  EXPECT_NEAR(candle.x, 1, 1e-12);
  EXPECT_NEAR(candle.y, lamp.y / lamp.x, 1e-9);
  EXPECT_NEAR(candle.z, lamp.z / lamp.x, 1e-9);
}

TEST(Bands, AWavelengthIsTakenFromTheBandsBesideIt) {
  const Bands bands = visible_bands();
  const BandWeights weights = weigh_bands("", bands, {"", false, {700, 552.5, 400}});
  EXPECT_EQ(weights[30], dvec3(1, 0, 0));
  EXPECT_EQ(weights[15], dvec3(0, 0.75, 0));
  EXPECT_EQ(weights[16], dvec3(0, 0.25, 0));
  EXPECT_EQ(weights[0], dvec3(0, 0, 1));
  EXPECT_NEAR(glm::length(sum_of(weights) - dvec3(1)), 0, 1e-12);
}

TEST(Bands, ViewsThatTheBandsDoNotTellAreRefused) {
  const Bands bands = visible_bands();
  const std::pair<BandView, const char*> wrong[] = {
      {{"candel", false, {}}, "a.tif: there is no lamp 'candel'"},
      {{"", false, {701}}, "has no band at 701 nm: it has 400 to 700 nm"},
      {{"", false, {900, 650, 550}}, "has no band at 900 nm"}};
  for (const auto& [view, what] : wrong)
    EXPECT_NE(refused_view(bands, view).find(what), std::string::npos) << refused_view(bands, view);
  const std::pair<std::vector<double>, const char*> blind[] = {
      {{500, 600, 700}, "tells no colours: its first band is 500 nm"},
      {{400, 450, 500, 550}, "its last band is 550 nm"},
      {{400, 440, 560, 650}, "bands are missing between 440 and 560 nm"}};
  for (const auto& [nm, what] : blind) {
    Bands few;
    few.nm = nm;
    EXPECT_NE(refused_view(few, {}).find(what), std::string::npos) << refused_view(few, {});
    EXPECT_EQ(refused_view(few, {"", false, {nm[1]}}), "");
  }
  Bands seven;
  seven.nm = {420, 450, 500, 560, 600, 650, 730, 850, 940};
  EXPECT_EQ(refused_view(seven, {}), "");
}

}  // namespace
}  // namespace wellspring::test
