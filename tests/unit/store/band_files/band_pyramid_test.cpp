// SPDX-License-Identifier: Apache-2.0
#include "store/band_files/band_pyramid.h"

#include <cmath>
#include <filesystem>
#include <random>

#include "base/load_error.h"
#include "spectrum/color.h"
#include "spectrum/lamps.h"
#include "spectrum/observer.h"
#include "spectrum/upsample.h"
#include "unit/store/band_files/made_bands.h"
#include "unit/store/format/pictures.h"

namespace wellspring::test {
namespace {

using namespace store;
using namespace spectrum;
namespace fs = std::filesystem;

const std::vector<BandView> views = {
    {}, {"candle", false, {}}, {"candle", true, {}}, {"LED-B3", true, {}}, {"FL11", false, {}}};

double linear_of(uint8_t code) {
  const double c = code / 255.0;
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}
dvec3 color_at(const Piece& piece, int x, int y) {
  const uint8_t* rgba = &piece.bytes[(size_t(y) * size_t(piece.width) + size_t(x)) * 4];
  return {linear_of(rgba[0]), linear_of(rgba[1]), linear_of(rgba[2])};
}
dvec3 lab_of_rgb(const dvec3& rgb) { return lab_of(xyz_of_rgb(rgb), xyz_of_rgb(dvec3(1))); }

// Returns what a view shows of a spectrum, from its single nanometres.
dvec3 reference_of(const Spectrum& reflectance, const BandView& view) {
  const LampObserver lamp(find_lamp(view.lamp.empty() ? "D65" : view.lamp)->power);
  const dvec3 day = LampObserver(find_lamp("D65")->power).white();
  const auto shown = [&](const dvec3& xyz) {
    return rgb_of(view.adapted ? adapt_cat16(xyz, lamp.white(), day) : xyz);
  };
  const dvec3 white = shown(lamp.white());
  return shown(lamp.xyz(reflectance)) / std::max({white.x, white.y, white.z});
}

std::shared_ptr<const PicturePyramid> open_view(const std::string& file, const BandView& view) {
  return open_picture(file, "", "en", {}, view);
}

// Smooth spectra of colours that all lamps can show, one for each texel of 16 x 16, in 31 bands.
struct SmoothPicture {
  static constexpr int side = 16;
  std::vector<Spectrum> spectra;
  MadeBands made;

  SmoothPicture() {
    std::mt19937 random(5);
    const auto next = [&] { return 0.08 + 0.8 * double(random() % 1000) / 1000; };
    for (int i = 0; i < side * side; i++) {
      const dvec3 grey(next());
      spectra.push_back(
          sample_reflectance(fit_reflectance(glm::mix(grey, dvec3(next(), next(), next()), 0.5))));
    }
    made.width = made.height = side, made.bands = 31, made.tile = 0;
    made.description = wavelengths_json(31);
    made.value = [this](int x, int y, int band) {
      const Spectrum& one = spectra[size_t(y * side + x)];
      return std::round(65535 * one[size_t(400 + 10 * band - first_nm)]);
    };
  }
};

// Colours of bands, 10 nm apart, through the file and to codes of 8 bits, beside the reference at
// 1 nm. One step of a code alone is up to half a unit of CIEDE2000.
TEST(BandPyramid, ColorsAreThoseOfTheSpectraUnderEachLamp) {
  const SmoothPicture picture;
  const Folder folder;
  const BandSource source(write_bands_tiff(folder.file("raw.tif"), picture.made));
  struct Kept {
    const char* name;
    BandPyramidSettings settings;
    double mean, most;  // CIEDE2000
  };
  for (const Kept& kept : {Kept{"8.tif", {}, 0.25, 1}, Kept{"16.tif", {.bits = 16}, 0.25, 1}}) {
    write_band_pyramid(source, folder.file(kept.name), kept.settings);
    for (const BandView& view : views) {
      SCOPED_TRACE(std::string(kept.name) + " " + view.lamp);
      const Piece shown = whole_level(*open_view(folder.file(kept.name), view), 0);
      double sum = 0, most = 0;
      int count = 0;
      for (int i = 0; i < shown.width * shown.height; i++) {
        const dvec3 wanted = reference_of(picture.spectra[size_t(i)], view);
        // Colours that the screen cannot show are cut.
        if (std::min({wanted.x, wanted.y, wanted.z}) < 0.002) continue;
        const double difference = ciede2000(
            lab_of_rgb(color_at(shown, i % shown.width, i / shown.width)), lab_of_rgb(wanted));
        sum += difference, most = std::max(most, difference), count++;
      }
      ASSERT_GT(count, 100);
      EXPECT_LT(sum / count, kept.mean);
      EXPECT_LT(most, kept.most);
      RecordProperty(std::string(kept.name) + view.lamp, std::to_string(sum / count));
    }
  }
}

TEST(BandPyramid, OneBandAndFalseColorsAreTheBands) {
  const SmoothPicture picture;
  const Folder folder;
  const BandSource source(write_bands_tiff(folder.file("raw.tif"), picture.made));
  write_band_pyramid(source, folder.file("a.tif"));
  for (const std::string& file : {folder.file("raw.tif"), folder.file("a.tif")}) {
    const Piece red = whole_level(*open_view(file, {"", false, {650}}), 0);
    const Piece three = whole_level(*open_view(file, {"", false, {650, 550, 455}}), 0);
    for (int i = 0; i < 256; i++) {
      const auto at = [&](int nm) { return picture.spectra[size_t(i)][size_t(nm - first_nm)]; };
      const dvec3 grey = color_at(red, i % 16, i / 16), color = color_at(three, i % 16, i / 16);
      EXPECT_NEAR(grey.x, at(650), 0.007);
      EXPECT_EQ(grey.x, grey.z);
      EXPECT_NEAR(color.x, at(650), 0.007);
      EXPECT_NEAR(color.y, at(550), 0.007);
      EXPECT_NEAR(color.z, (at(450) + at(460)) / 2, 0.007);
    }
  }
}

TEST(BandPyramid, OnePictureIsShownHoweverItIsStored) {
  const Folder folder;
  MadeBands made;
  made.width = 70, made.height = 50, made.bands = 9;
  made.description = wavelengths_json(9, 400, 40);
  made.value = [](int x, int y, int band) {
    return 0.5 + 0.4 * std::sin(x * 0.2 + band) * std::cos(y * 0.15 - band);
  };
  const auto value = made.value;
  std::optional<Piece> first;
  for (const BandCode code : {BandCode::f32, BandCode::u16, BandCode::u8})
    for (const bool planar : {false, true})
      for (const int tile : {0, 16}) {
        SCOPED_TRACE(int(code) * 100 + planar * 10 + tile);
        made.code = code, made.planar = planar, made.tile = tile;
        made.value = [&](int x, int y, int band) {
          const double largest = largest_code(code);
          return code == BandCode::f32 ? value(x, y, band)
                                       : std::round(largest * value(x, y, band));
        };
        const auto shown = open_view(write_bands_tiff(folder.file("a.tif"), made), {"A", true, {}});
        const Piece piece = whole_level(*shown, 0);
        if (!first) first = piece;
        expect_same(piece, *first, code == BandCode::u8 ? 2 : 1);
      }
}

TEST(BandPyramid, SmallerVersionsAreMeansOfTheLight) {
  const Folder folder;
  MadeBands made;
  made.width = 601, made.height = 333, made.bands = 4, made.planar = true;
  made.description = wavelengths_json(4, 430, 70);
  made.value = [](int x, int y, int band) {
    return 20000.0 + (x * 37 + y * 71 + band * 11) % 40 * 900 + 10 * (x % 100);
  };
  const BandSource source(write_bands_tiff(folder.file("raw.tif"), made));
  double done = 0;
  const BandPyramidStats stats = write_band_pyramid(
      source, folder.file("a.tif"), {.bits = 16, .progress = [&](double share) { done = share; }});
  EXPECT_EQ(stats.levels, 3);
  EXPECT_EQ(stats.above, 0);
  EXPECT_EQ(done, 1);
  const auto shown = open_view(folder.file("a.tif"), {});
  ASSERT_EQ(shown->levels().size(), 3u);
  EXPECT_EQ(shown->levels()[1].width, 301);
  EXPECT_EQ(shown->levels()[2].height, 84);
  Piece whole = whole_level(*shown, 0);
  for (int level = 1; level < 3; level++) {
    whole = halve(whole);
    expect_same(whole_level(*shown, level), whole, 2);
  }
}

TEST(BandPyramid, InfraredAloneIsWrittenAndShownAsBands) {
  const Folder folder;
  MadeBands made;
  made.width = made.height = 300, made.description = wavelengths_json(3, 900, 100);
  made.value = [](int x, int, int band) { return 100 * x + 10'000 * band; };
  const BandSource source(write_bands_tiff(folder.file("raw.tif"), made));
  EXPECT_EQ(write_band_pyramid(source, folder.file("a.tif")).levels, 2);
  const Piece grey = whole_level(*open_view(folder.file("a.tif"), {"", false, {1000}}), 0);
  EXPECT_NEAR(color_at(grey, 150, 7).x, 25'000 / 65'535.0, 0.007);
  EXPECT_THROW(open_view(folder.file("a.tif"), {}), LoadError);
}

TEST(BandPyramid, WhatIsCutIsCounted) {
  const Folder folder;
  MadeBands made;
  made.code = BandCode::f32, made.description = wavelengths_json(3, 430, 100);
  made.value = [](int x, int, int band) { return band == 1 ? (x < 10 ? 1.5 : -0.1) : 0.5; };
  const BandSource source(write_bands_tiff(folder.file("raw.tif"), made));
  const BandPyramidStats stats = write_band_pyramid(source, folder.file("a.tif"));
  EXPECT_NEAR(stats.above, 0.25 / 3, 1e-9);
  EXPECT_NEAR(stats.below, 0.75 / 3, 1e-9);
  try {
    write_band_pyramid(source, folder.file("none/a.tif"));
    ADD_FAILURE() << "was written";
  } catch (const LoadError& error) {
    EXPECT_NE(std::string(error.what()).find("No such file"), std::string::npos) << error.what();
  }
}

TEST(BandPyramid, JpegTilesKeepColors) {
  const Folder folder;
  MadeBands made;
  made.width = made.height = 256, made.bands = 31, made.description = wavelengths_json(31);
  made.value = [](int x, int y, int band) {
    return 30000 + 20000 * std::sin(x / 30.0 + band * 0.2) * std::cos(y / 25.0);
  };
  const BandSource source(write_bands_tiff(folder.file("raw.tif"), made));
  write_band_pyramid(source, folder.file("a.tif"));
  write_band_pyramid(source, folder.file("b.tif"), {.quality = 90});
  EXPECT_LT(fs::file_size(folder.file("b.tif")), fs::file_size(folder.file("a.tif")));
  for (const BandView& view : views)
    expect_same(whole_level(*open_view(folder.file("b.tif"), view), 0),
                whole_level(*open_view(folder.file("a.tif"), view), 0), 12);
}

TEST(BandPyramid, PicturesWithoutBandsAndFloatsThatAreNoNumbersAreRefused) {
  const Folder folder;
  const auto told = [](const std::string& file, const BandView& view) -> std::string {
    try {
      whole_level(*open_view(file, view), 0);
    } catch (const LoadError& error) {
      return error.what();
    }
    return "";
  };
  const std::string png = folder.write("a.png", png_of(20, 20, pattern));
  EXPECT_EQ(told(png, {}), "");
  EXPECT_NE(told(png, {"candle", false, {}}).find("a.png: has no bands"), std::string::npos);
  const std::string plain = write_tiff(folder, {TiffSpec{}});
  EXPECT_EQ(told(plain, {}), "");
  EXPECT_NE(told(plain, {"", false, {500}}).find("test.tif: has no bands"), std::string::npos);
  MadeBands made;
  made.code = BandCode::f32, made.description = wavelengths_json(3, 430, 100);
  made.value = [](int x, int y, int band) { return x == 20 && y == 3 && band == 1 ? NAN : 0.5; };
  const std::string text = told(write_bands_tiff(folder.file("nan.tif"), made), {});
  EXPECT_NE(text.find("tile 1, 0: band 2 has a value that is no number"), std::string::npos)
      << text;
}

// A real painting, photographed in 31 bands, and its authors' own picture of it in daylight.
TEST(BandPyramid, APaintingLooksAsItsAuthorsShowIt) {
  const fs::path folder =
      fs::path(WELLSPRING_DATA) / "10_exhibits" / "pictures" / "oil_painting_31_bands";
  if (!fs::exists(folder)) GTEST_SKIP() << "no painting at " << folder;
  const Folder made;
  const BandSource source(folder.string());
  EXPECT_EQ(source.bands().nm.size(), 31u);
  EXPECT_EQ(source.bands().source, "Columbia University");
  write_band_pyramid(source, made.file("a.tif"));
  const Piece theirs = whole_level(*open_picture((folder / "oil_painting_RGB.jpg").string()), 0);
  const Piece ours = whole_level(*open_view(made.file("a.tif"), {}), 0);
  const Piece candle = whole_level(*open_view(made.file("a.tif"), {"candle", false, {}}), 0);
  ASSERT_EQ(ours.width, theirs.width);
  // Their picture is as much brighter as its exposure was longer; colours are the same.
  dvec3 sum_ours(0), sum_theirs(0), sum_candle(0);
  for (int y = 0; y < ours.height; y++)
    for (int x = 0; x < ours.width; x++) {
      sum_ours += color_at(ours, x, y), sum_theirs += color_at(theirs, x, y);
      sum_candle += color_at(candle, x, y);
    }
  const double exposure = sum_theirs.y / sum_ours.y;
  double sum = 0;
  int count = 0;
  for (int y = 0; y < ours.height; y += 4)
    for (int x = 0; x < ours.width; x += 4) {
      const dvec3 theirs_here = color_at(theirs, x, y);
      if (std::max({theirs_here.x, theirs_here.y, theirs_here.z}) > 0.98) continue;
      sum += ciede2000(lab_of_rgb(glm::min(exposure * color_at(ours, x, y), dvec3(1))),
                       lab_of_rgb(theirs_here));
      count++;
    }
  RecordProperty("mean_de00", std::to_string(sum / count));
  EXPECT_LT(sum / count, 4);
  EXPECT_GT(sum_candle.x / sum_candle.z, 3 * sum_ours.x / sum_ours.z);
}

}  // namespace
}  // namespace wellspring::test
