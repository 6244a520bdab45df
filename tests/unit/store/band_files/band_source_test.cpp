// SPDX-License-Identifier: Apache-2.0
#include "store/band_files/band_source.h"

#include <cmath>
#include <limits>

#include "base/load_error.h"
#include "image/image.h"
#include "store/band_files/band_places.h"
#include "unit/folder.h"
#include "unit/store/band_files/made_bands.h"

namespace wellspring::test {
namespace {

using namespace store;

constexpr int width = 40, height = 24;

// Returns a code of at most 200, so that it fits into 8 bits.
double code_at(int x, int y, int band) { return (x * 7 + y * 13 + band * 31) % 200; }

// Expects code_at() of each band, where `white` stands for 1.
void expect_codes(const BandSource& source, double white, size_t bands = 3) {
  ASSERT_EQ(source.width(), width);
  ASSERT_EQ(source.height(), height);
  ASSERT_EQ(source.bands().nm.size(), bands);
  for (const auto& [top, rows] : {std::pair(0, height), std::pair(13, 7)}) {
    std::vector<float> read;
    source.read(top, rows, read);
    ASSERT_EQ(read.size(), size_t(width) * size_t(rows) * bands);
    size_t i = 0;
    for (int band = 0; band < int(bands); band++)
      for (int y = top; y < top + rows; y++)
        for (int x = 0; x < width; x++)
          ASSERT_NEAR(read[i++], code_at(x, y, band) / white, 1e-6)
              << x << ", " << y << ": " << band;
  }
}

std::string refused_source(const std::string& path) {
  try {
    const BandSource source(path);
    std::vector<float> read;
    source.read(0, int(std::min<int64_t>(source.height(), height)), read);
  } catch (const LoadError& error) {
    return error.what();
  }
  return "";
}

MadeBands usual() {
  MadeBands made;
  made.description = wavelengths_json(3);
  made.value = code_at;
  return made;
}

// Writes a grey PNG of 8 bits.
std::string grey_png(int wide, int high, int band, bool coloured = false) {
  Image8 image{wide, high, {}};
  for (int y = 0; y < high; y++)
    for (int x = 0; x < wide; x++)
      for (int c = 0; c < 3; c++)
        image.rgb.push_back(uint8_t(code_at(x, y, band) + (coloured && c == 2 && x == 5)));
  const std::vector<uint8_t> bytes = encode_png(image, "", "test.png");
  return {bytes.begin(), bytes.end()};
}

TEST(BandSource, SamplesAreReadHoweverTheyAreStored) {
  for (const BandCode code : {BandCode::u8, BandCode::u16, BandCode::f32})
    for (const bool planar : {false, true})
      for (const int tile : {0, 16}) {
        SCOPED_TRACE(int(code) * 100 + planar * 10 + tile);
        const Folder folder;
        MadeBands made = usual();
        made.code = code, made.planar = planar, made.tile = tile;
        expect_codes(BandSource(write_bands_tiff(folder.file("a.tif"), made)), largest_code(code));
      }
}

TEST(BandSource, WhiteBlackAndGammaAreApplied) {
  const Folder folder;
  MadeBands made = usual();
  made.description = R"({"wavelengths_nm": [400, 500, 600], "white": [110, 210, 310], "black": 10,
                         "gamma": 2})";
  const BandSource source(write_bands_tiff(folder.file("a.tif"), made));
  std::vector<float> read;
  source.read(0, 1, read);
  for (int band = 0; band < 3; band++) {
    const double share = std::max(0.0, (code_at(9, 0, band) - 10) / (100.0 + 100 * band));
    EXPECT_NEAR(read[size_t(band * width + 9)], share * share, 1e-6);
  }
}

TEST(BandSource, PagesFilesAndFoldersAreRead) {
  const Folder folder;
  MadeBands made = usual();
  made.pages = true;
  expect_codes(BandSource(write_bands_tiff(folder.file("pages.tif"), made)), 65535);
  made.description.clear();
  made.page_name = [](int band) { return std::to_string(400 + 10 * band) + " nm"; };
  const BandSource named(write_bands_tiff(folder.file("named.tif"), made));
  expect_codes(named, 65535);
  EXPECT_EQ(named.bands().nm, (std::vector<double>{400, 410, 420}));
  // The description lies beside the file.
  made = usual();
  made.description.clear();
  const std::string file = write_bands_tiff(folder.file("beside.tif"), made);
  const std::string json = folder.write("beside.bands.json", wavelengths_json(3));
  expect_codes(BandSource(file), 65535);
  expect_codes(BandSource(json), 65535);
  // A file for each band, named by the description, and by wavelengths.
  for (int band = 0; band < 3; band++)
    folder.write("p" + std::to_string(band) + ".png", grey_png(width, height, band));
  expect_codes(BandSource(folder.write("list.json", R"({"wavelengths_nm": [400, 410, 420],
      "files": ["p0.png", "p1.png", "p2.png"]})")),
               255);
  const Folder camera;
  for (int band = 0; band < 3; band++)
    camera.write("oil_0" + std::to_string(950 + 60 * band) + "nm.png",
                 grey_png(width, height, band));
  camera.write("notes.txt", "500 nm");
  const BandSource by_name(camera.path.string());
  expect_codes(by_name, 255);
  EXPECT_EQ(by_name.bands().nm, (std::vector<double>{950, 1010, 1070}));
}

TEST(BandSource, WhatIsWrongInATiffIsNamedWithItsPlace) {
  const auto told = [](const std::function<void(MadeBands&)>& change) {
    const Folder folder;
    MadeBands made = usual();
    change(made);
    const std::string text = refused_source(write_bands_tiff(folder.file("a.tif"), made));
    EXPECT_TRUE(text.empty() || text.starts_with(folder.file("a.tif"))) << text;
    return text;
  };
  const auto expect = [&](const char* what, const std::function<void(MadeBands&)>& change) {
    const std::string text = told(change);
    EXPECT_NE(text.find(what), std::string::npos) << text;
  };
  EXPECT_EQ(told([](MadeBands&) {}), "");
  expect("page 1: has 3 samples a pixel for 4 wavelengths",
         [](MadeBands& made) { made.description = wavelengths_json(4); });
  expect("has 3 bands for 5 wavelengths",
         [](MadeBands& made) { made.pages = true, made.description = wavelengths_json(5); });
  expect("page 1: tells no wavelength", [](MadeBands& made) { made.description.clear(); });
  expect("420 nm is there twice", [](MadeBands& made) {
    made.description.clear(), made.pages = true;
    made.page_name = [](int band) { return band > 0 ? "420 nm" : "410 nm"; };
  });
  expect("400 nm comes after longer ones", [](MadeBands& made) {
    made.description.clear(), made.pages = true;
    made.page_name = [](int band) { return band == 1 ? "400 nm" : "410 nm"; };
  });
  expect("band 2 (410 nm), pixel 17, 5: is no number", [](MadeBands& made) {
    made.code = BandCode::f32;
    made.value = [](int x, int y, int band) {
      return x == 17 && y == 5 && band == 1 ? std::nan("") : 0.5;
    };
  });
  expect("is no number", [](MadeBands& made) {
    made.code = BandCode::f32;
    made.value = [](int, int, int) { return std::numeric_limits<double>::infinity(); };
  });
  expect("min-is-black", [](MadeBands& made) { made.photometric = PHOTOMETRIC_MINISWHITE; });
  expect("page 1: is turned", [](MadeBands& made) { made.orientation = 6; });
  expect("not micrometres",
         [](MadeBands& made) { made.description = R"({"wavelengths_nm": [0.4, 0.5, 0.6]})"; });
}

TEST(BandSource, WhatIsWrongInFilesOfBandsIsNamed) {
  const Folder folder;
  folder.write("a.png", grey_png(width, height, 0));
  folder.write("b.png", grey_png(width, height + 1, 1));
  folder.write("c.png", grey_png(width, height, 1, true));
  const auto told = [&](const std::string& files) {
    return refused_source(
        folder.write("x.bands.json", R"({"wavelengths_nm": [400, 500], "files": )" + files + "}"));
  };
  const std::pair<const char*, const char*> wrong[] = {
      {R"(["a.png", "none.png"])", "none.png: is not there"},
      {R"(["a.png", "b.png"])", "b.png: is 40 x 25 texels, while the first band, "},
      {R"(["a.png", "c.png"])", "c.png: pixel 5, 0: is coloured"},
      {R"(["a.png"])", "a.png: is one PNG for several wavelengths"},
      {R"(["a.png", "x.bands.json"])", "x.bands.json: is neither PNG nor TIFF"}};
  for (const auto& [files, what] : wrong)
    EXPECT_NE(told(files).find(what), std::string::npos) << told(files);
  EXPECT_EQ(told(R"(["a.png", "a.png"])"), "");
  const std::string alone = folder.write("y.bands.json", R"({"wavelengths_nm": [400, 500]})");
  EXPECT_NE(refused_source(alone).find("names no \"files\""), std::string::npos);
  EXPECT_NE(refused_source(folder.path.string()).find("several .json"), std::string::npos);
  const Folder empty;
  EXPECT_NE(refused_source(empty.path.string()).find("neither a .json"), std::string::npos);
  empty.write("a_450nm.png", grey_png(width, height, 0));
  empty.write("b_450nm.png", grey_png(width, height, 0));
  EXPECT_NE(refused_source(empty.path.string()).find("450 nm is there twice"), std::string::npos);
  EXPECT_NE(refused_source(empty.file("none.tif")).find("is not there"), std::string::npos);
  EXPECT_NE(refused_source(empty.file("a_450nm.png")).find("is no picture of bands"),
            std::string::npos);
}

// A head that promises more than its file can hold is not believed.
TEST(BandSource, AbsurdSizesAreRefused) {
  const Folder folder;
  MadeBands made = usual();
  const std::string file = write_bands_tiff(folder.file("a.tif"), made);
  std::string bytes = folder.read("a.tif");
  const auto promise = [&](uint16_t tag, uint32_t value) {
    // Entries of a little-endian TIFF's directory: tag, kind, count, value.
    uint32_t directory;
    std::memcpy(&directory, &bytes[4], 4);
    uint16_t count;
    std::memcpy(&count, &bytes[directory], 2);
    for (size_t at = directory + 2; at < directory + 2 + 12u * count; at += 12)
      if (uint16_t own; std::memcpy(&own, &bytes[at], 2), own == tag) {
        const uint16_t kind = TIFF_LONG;
        std::memcpy(&bytes[at + 2], &kind, 2);
        std::memcpy(&bytes[at + 8], &value, 4);
      }
  };
  promise(TIFFTAG_IMAGEWIDTH, 1u << 18), promise(TIFFTAG_IMAGELENGTH, 1u << 18);
  folder.write("a.tif", bytes);
  const std::string text = refused_source(file);
  EXPECT_NE(text.find("262144 x 262144 texels is in a file of"), std::string::npos) << text;
  promise(TIFFTAG_IMAGEWIDTH, 1u << 31), promise(TIFFTAG_IMAGELENGTH, 24);
  folder.write("a.tif", bytes);
  EXPECT_NE(refused_source(file).find("empty or too large"), std::string::npos)
      << refused_source(file);
}

TEST(BandSource, PlacesLieEvenlyAndAreMeansOfTheirSurroundings) {
  const Folder folder;
  const BandSource source(write_bands_tiff(folder.file("a.tif"), usual()));
  const std::vector<BandPlace> places = sample_places(source, 15);
  ASSERT_EQ(places.size(), 15u);
  for (const BandPlace& place : places) {
    ASSERT_EQ(place.reflectances.size(), 3u);
    double sum = 0;
    for (int64_t y = place.y - 1; y <= place.y + 1; y++)
      for (int64_t x = place.x - 1; x <= place.x + 1; x++)
        sum += code_at(int(x), int(y), 2) / 65535;
    EXPECT_NEAR(place.reflectances[2], sum / 9, 1e-6) << place.x << ", " << place.y;
  }
  EXPECT_EQ(sample_places(source, 1).size(), 1u);
  EXPECT_LE(sample_places(source, 1 << 20).size(), size_t(width * height / 9));
}

}  // namespace
}  // namespace wellspring::test
