// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <lcms2.h>
#include <sys/stat.h>
#include <thread>

#include "store/format/tiff_pyramid.h"
#include "unit/store/band_files/made_bands.h"
#include "unit/store/format/pictures.h"

namespace wellspring::test {
namespace {

using namespace store;

Piece shown(const TiffSpec& page) { return piece_of(page.width, page.height, page.codes, 3); }

// Expects that the picture's finest level shows these codes.
void expect_shown(const TiffSpec& page, const Piece& wanted, int tolerance = 0) {
  for (const int tile : {16, 0}) {
    SCOPED_TRACE(tile);
    const Folder folder;
    TiffSpec spec = page;
    spec.tile = tile;
    const auto pyramid = open_picture(write_tiff(folder, {spec}));
    expect_same(whole_level(*pyramid, 0), wanted, tolerance);
  }
}

TEST(Tiff, ColorsAreReadHoweverTheyAreStored) {
  for (const int compression :
       {COMPRESSION_NONE, COMPRESSION_LZW, COMPRESSION_ADOBE_DEFLATE, COMPRESSION_PACKBITS})
    for (const int planar : {PLANARCONFIG_CONTIG, PLANARCONFIG_SEPARATE}) {
      SCOPED_TRACE(compression * 10 + planar);
      TiffSpec page;
      page.compression = compression, page.planar = planar;
      expect_shown(page, shown(page));
      page.bits = 16;  // rounds to what 8 bits are
      page.codes = [](int x, int y, int c) { return pattern(x, y, c) * 257 + (x % 3 - 1) * 128; };
      page.codes = [codes = page.codes](int x, int y, int c) {
        return std::clamp(codes(x, y, c), 0, 65535);
      };
      expect_shown(page, piece_of(page.width, page.height, pattern));
    }
}

TEST(Tiff, GreysAndPalettesOfEachDepthAreRead) {
  for (const int bits : {1, 2, 4, 8, 16})
    for (const int photometric :
         {PHOTOMETRIC_MINISBLACK, PHOTOMETRIC_MINISWHITE, PHOTOMETRIC_PALETTE}) {
      if (bits == 16 && photometric == PHOTOMETRIC_PALETTE) continue;
      SCOPED_TRACE(bits * 10 + photometric);
      const int most = (1 << bits) - 1;
      TiffSpec page;
      page.width = 37, page.channels = 1, page.bits = bits, page.photometric = photometric;
      page.codes = [=](int x, int y, int) { return (x * 771 + y * 1285) & most; };
      expect_shown(page, piece_of(37, page.height, [&](int x, int y, int c) {
                     const int code = page.codes(x, y, 0);
                     if (photometric == PHOTOMETRIC_PALETTE) return pattern(code, 0, c);
                     const int grey = int(code * 255.0 / most + 0.5);
                     return photometric == PHOTOMETRIC_MINISWHITE ? 255 - grey : grey;
                   }));
    }
}

TEST(Tiff, AlphaIsReadAndTakenOutOfColors) {
  TiffSpec page;
  page.channels = 4;
  page.codes = [](int x, int y, int c) { return c == 3 ? x * 6 : pattern(x, y, c) * x / 40; };
  page.extra = EXTRASAMPLE_UNASSALPHA;
  expect_shown(page, piece_of(page.width, page.height, page.codes, 4));
  page.extra = EXTRASAMPLE_UNSPECIFIED;
  expect_shown(page, shown(page));
  page.extra = EXTRASAMPLE_ASSOCALPHA;
  expect_shown(page, piece_of(
                         page.width, page.height,
                         [&](int x, int y, int c) {
                           const int alpha = x * 6, code = page.codes(x, y, c);
                           if (c == 3 || alpha == 0) return code;
                           return std::min(255, (code * 255 + alpha / 2) / alpha);
                         },
                         4));
}

TEST(Tiff, JpegIsReadInEachSpaceOfColors) {
  for (const int photometric : {PHOTOMETRIC_YCBCR, PHOTOMETRIC_RGB, PHOTOMETRIC_MINISBLACK}) {
    SCOPED_TRACE(photometric);
    TiffSpec page;
    page.photometric = photometric, page.compression = COMPRESSION_JPEG;
    if (photometric == PHOTOMETRIC_MINISBLACK) page.channels = 1;
    page.codes = [&](int x, int y, int c) { return 40 + 3 * x + 2 * y + (page.channels > 1) * c; };
    expect_shown(page, piece_of(page.width, page.height, page.codes), 6);
  }
}

TEST(Tiff, InksAbsorb) {
  TiffSpec page;
  page.channels = 4, page.photometric = PHOTOMETRIC_SEPARATED;
  expect_shown(page, piece_of(page.width, page.height, [](int x, int y, int c) {
                 return ((255 - pattern(x, y, c)) * (255 - pattern(x, y, 3)) + 127) / 255;
               }));
}

std::string save_profile(cmsHPROFILE profile) {
  cmsUInt32Number size = 0;
  cmsSaveProfileToMem(profile, nullptr, &size);
  std::string bytes(size, '\0');
  cmsSaveProfileToMem(profile, bytes.data(), &size);
  cmsCloseProfile(profile);
  return bytes;
}

TEST(Tiff, ProfilesOfColorsAndGreysAreApplied) {
  const cmsCIExyY white = {0.3127, 0.3290, 1};
  const cmsCIExyYTRIPLE primaries = {{0.64, 0.33, 1}, {0.21, 0.71, 1}, {0.15, 0.06, 1}};
  cmsToneCurve* linear = cmsBuildGamma(nullptr, 1);
  cmsToneCurve* curves[] = {linear, linear, linear};
  TiffSpec page;
  page.icc = save_profile(cmsCreateRGBProfile(&white, &primaries, curves));
  page.codes = [](int, int, int) { return 55; };  // 0.2157 of linear grey is 128 of sRGB
  expect_shown(page, piece_of(40, 24, [](int, int, int) { return 128; }), 1);
  page.codes = [](int, int, int c) { return c == 1 ? 255 : 0; };  // greener than sRGB can show
  expect_shown(page, piece_of(40, 24, [](int, int, int c) { return c == 1 ? 255 : 0; }), 1);
  page.codes = [](int, int, int c) { return c == 0 ? 55 : 0; };  // Adobe's red is that of sRGB,
  const Folder folder;                                           // brighter by the greener green
  const Piece red = whole_level(*open_picture(write_tiff(folder, {page})), 0);
  EXPECT_GT(red.bytes[0], 140);
  TiffSpec grey;
  grey.channels = 1, grey.photometric = PHOTOMETRIC_MINISBLACK;
  grey.icc = save_profile(cmsCreateGrayProfile(&white, linear));
  grey.codes = [](int, int, int) { return 55; };
  expect_shown(grey, piece_of(40, 24, [](int, int, int) { return 128; }), 1);
  grey.icc = page.icc;  // is no profile of greys
  expect_shown(grey, piece_of(40, 24, [](int, int, int) { return 55; }));
  grey.icc = "no profile";
  expect_shown(grey, piece_of(40, 24, [](int, int, int) { return 55; }));
  cmsFreeToneCurve(linear);
}

// Returns the picture as a viewer has to show it: TIFF 6.0, tag Orientation.
Piece oriented(const TiffSpec& page) {
  const int o = page.orientation, w = page.width, h = page.height;
  const bool swaps = o >= 5;
  return piece_of(swaps ? h : w, swaps ? w : h, [=](int x, int y, int c) {
    switch (o) {
      case 2: return pattern(w - 1 - x, y, c);
      case 3: return pattern(w - 1 - x, h - 1 - y, c);
      case 4: return pattern(x, h - 1 - y, c);
      case 5: return pattern(y, x, c);
      case 6: return pattern(y, h - 1 - x, c);
      case 7: return pattern(w - 1 - y, h - 1 - x, c);
      case 8: return pattern(w - 1 - y, x, c);
      default: return pattern(x, y, c);
    }
  });
}

TEST(Tiff, MirroredAndTurnedPicturesStandUpright) {
  for (int orientation = 1; orientation <= 8; orientation++) {
    SCOPED_TRACE(orientation);
    TiffSpec page;
    page.width = 41, page.height = 27, page.orientation = orientation;
    expect_shown(page, oriented(page));
  }
}

TEST(Tiff, SmallerPagesAndSubIfdsAreLevelsAndOtherPicturesAreNot) {
  for (const bool sub : {false, true})
    for (const char* mode : {"w", "w8", "wb"}) {
      SCOPED_TRACE(mode);
      const Folder folder;
      std::vector<TiffSpec> pages(5);
      const int sizes[][2] = {{81, 61}, {30, 20}, {41, 31}, {81, 61}, {20, 15}};
      for (size_t i = 0; i < pages.size(); i++) {
        pages[i].width = sizes[i][0], pages[i].height = sizes[i][1];
        pages[i].codes = [i](int x, int y, int c) { return pattern(x, y, c) ^ int(i); };
        if (i != 2) pages[i].compression = COMPRESSION_LZW;
      }
      const auto pyramid = open_picture(write_tiff(folder, pages, sub, mode));
      ASSERT_EQ(pyramid->levels().size(), 3u);
      expect_same(whole_level(*pyramid, 0), shown(pages[0]));
      expect_same(whole_level(*pyramid, 1), shown(pages[2]));
      expect_same(read_level(*pyramid, 2), shown(pages[4]));
    }
}

TEST(Tiff, ThreadsReadAtOnce) {
  const Folder folder;
  TiffSpec fine, coarse;
  fine.width = 400, fine.height = 300, fine.compression = COMPRESSION_LZW;
  coarse = fine;
  coarse.width = 200, coarse.height = 150;
  const auto pyramid = open_picture(write_tiff(folder, {fine, coarse}));
  std::vector<std::jthread> threads;
  for (int i = 0; i < 12; i++)
    threads.emplace_back(
        [&, i] { expect_same(whole_level(*pyramid, i % 2), shown(i % 2 ? coarse : fine)); });
}

TEST(Tiff, LongAndTinyPicturesAreRead) {
  TiffSpec page;
  page.width = 30000, page.height = 3;
  const Folder folder;
  const auto pyramid = open_picture(write_tiff(folder, {page}));
  expect_same(whole_level(*pyramid, 0), shown(page));
  EXPECT_EQ(pyramid->levels().back().width, 235);
  EXPECT_EQ(pyramid->levels().back().height, 1);
  page.width = 1, page.height = 1;
  expect_shown(page, shown(page));
}

TEST(Tiff, LargePicturesWithoutSmallerVersionsAreRefusedWithAdvice) {
  for (const int tile : {16, 0}) {
    const Folder folder;
    TiffSpec page;
    page.width = 2000, page.height = 50, page.tile = tile;
    const std::string file = write_tiff(folder, {page});
    EXPECT_NO_THROW(load_tiff(file, 100'000));
    try {
      load_tiff(file, 99'999);
      ADD_FAILURE() << "was read";
    } catch (const LoadError& error) {
      EXPECT_NE(error.what_.find("`./wellspring import picture " + file), std::string::npos);
    }
  }
}

// Changes an entry of the first page of a little-endian file: its value, and its type to LONG.
void set_entry(std::string& bytes, int tag, uint32_t value) {
  const auto number = [&](size_t at, int count) {
    uint32_t n = 0;
    for (int i = count; i-- > 0;) n = n << 8 | uint8_t(bytes[at + size_t(i)]);
    return n;
  };
  const size_t list = number(4, 4);
  for (size_t i = 0; i < number(list, 2); i++) {
    const size_t at = list + 2 + 12 * i;
    if (int(number(at, 2)) != tag) continue;
    bytes[at + 2] = 4;
    for (size_t k = 0; k < 4; k++) bytes[at + 8 + k] = char(value >> (8 * k));
  }
}

TEST(Tiff, HeadersThatLieAreRefused) {
  const Folder folder;
  TiffSpec page;
  const std::string tiled = [&] {
    write_tiff(folder, {page});
    return folder.read("test.tif");
  }();
  page.tile = 0;
  write_tiff(folder, {page});
  const std::string strips = folder.read("test.tif");
  struct Lie {
    const std::string& file;
    int tag;
    uint32_t value;
    const char* told;
  };
  const Lie lies[] = {{tiled, TIFFTAG_IMAGEWIDTH, 0, ""},
                      {tiled, TIFFTAG_IMAGEWIDTH, 0xffffffff, ""},
                      {tiled, TIFFTAG_IMAGEWIDTH, 60000, ""},
                      {tiled, TIFFTAG_TILEWIDTH, 1 << 20, "page 1"},
                      {tiled, TIFFTAG_TILELENGTH, 0, ""},
                      {tiled, TIFFTAG_BITSPERSAMPLE, 32, ""},
                      {tiled, TIFFTAG_SAMPLESPERPIXEL, 60000, ""},
                      {tiled, TIFFTAG_COMPRESSION, COMPRESSION_OJPEG, "old-style JPEG"},
                      {tiled, TIFFTAG_COMPRESSION, 34712, "compression 34712 is not read"},
                      {tiled, TIFFTAG_COMPRESSION, COMPRESSION_LZW, "tile 0, 0"},
                      {tiled, TIFFTAG_PHOTOMETRIC, 32844, ""},
                      {strips, TIFFTAG_IMAGELENGTH, 1 << 29, ""},
                      {strips, TIFFTAG_IMAGELENGTH, 1 << 20, ""},
                      {strips, TIFFTAG_COMPRESSION, COMPRESSION_ADOBE_DEFLATE, "strip 0"}};
  for (const Lie& lie : lies) {
    SCOPED_TRACE(testing::Message() << "tag " << lie.tag << " value " << lie.value);
    std::string bytes = lie.file;
    set_entry(bytes, lie.tag, lie.value);
    ASSERT_NE(bytes, lie.file);
    const std::string told = refusal(folder.write("lie.tif", bytes));
    EXPECT_NE(told.find("lie.tif"), std::string::npos) << told;
    EXPECT_NE(told.find(lie.told), std::string::npos) << told;
  }
}

TEST(Tiff, FilesThatAreCutOffAreRefusedAndNothingIsPrinted) {
  const Folder folder;
  TiffSpec page;
  page.compression = COMPRESSION_LZW;
  const std::string whole = [&] {
    write_tiff(folder, {page});
    return folder.read("test.tif");
  }();
  testing::internal::CaptureStderr();
  for (size_t size = 1; size < whole.size(); size += 37)
    EXPECT_NE(refusal(folder.write("cut.tif", whole.substr(0, size))), "") << size;
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(Tiff, TilesThatWereNeverWrittenAreAbsent) {
  const Folder folder;
  TiffSpec page;
  page.width = page.height = 64, page.left_out = 5;
  const std::string file = write_tiff(folder, {page});
  const auto pyramid = open_picture(file);
  EXPECT_EQ(pyramid->fetch({1, 0, 1, 1}).piece, nullptr);
  EXPECT_EQ(pyramid->fetch({1, 0, 1, 1}).hard, 60);
  EXPECT_NE(pyramid->fetch({1, 0, 2, 1}).piece, nullptr);
}

// A picture with a smaller version that is shown while its file is replaced, by a clock that is set
// by hand.
struct Replaced {
  Folder folder;
  double now = 0;
  std::vector<TiffSpec> pages = std::vector<TiffSpec>(2);
  std::string file;
  std::shared_ptr<const PicturePyramid> pyramid;

  Replaced() {
    pages[0].width = 80, pages[0].height = 48;
    file = write_tiff(folder, pages);
    pyramid = load_tiff(file, most_whole_texels, [this] { return now; });
  }
  // Lets another file of these pages take its name, or its place (`in_place`).
  void replace(bool in_place = false) {
    const Folder other;
    write_tiff(other, pages);
    const std::string bytes = other.read("test.tif");
    const std::string made = folder.write(in_place ? "test.tif" : "new.tif", bytes);
    if (!in_place) std::filesystem::rename(made, file);
    // The clock of a file system may stand still for a moment.
    const timespec times[2] = {{1'000'000 + written, 0}, {1'000'000 + written, 0}};
    written++;
    utimensat(AT_FDCWD, file.c_str(), times, 0);
  }
  void fetch() const { pyramid->fetch({1, 0, 0, 0}); }
  void pass_time() {
    for (int i = 0; i < 3; i++) now += 5.5, fetch();
  }
  long written = 0;
};

TEST(Tiff, AFileThatIsReplacedIsReadFromThenOn) {
  for (const bool in_place : {false, true}) {
    Replaced shown_file;
    const Piece before = shown(shown_file.pages[0]);
    for (TiffSpec& page : shown_file.pages)
      page.codes = [](int x, int y, int c) { return 255 - pattern(x, y, c); };
    shown_file.replace(in_place);
    if (!in_place) expect_same(whole_level(*shown_file.pyramid, 0), before);
    shown_file.pass_time();
    for (const int level : {0, 1})
      expect_same(whole_level(*shown_file.pyramid, level), shown(shown_file.pages[size_t(level)]));
  }
}

TEST(Tiff, AFileThatIsReplacedByAnotherPictureStaysOpenAndIsToldOnce) {
  Replaced shown_file;
  const Piece before = shown(shown_file.pages[0]);
  shown_file.pages[0].width = 96;
  testing::internal::CaptureStdout();  // the log goes there before log::start
  shown_file.replace();
  shown_file.pass_time();
  shown_file.pass_time();
  const std::string told = testing::internal::GetCapturedStdout();
  EXPECT_EQ(told.find("was replaced by a picture of other sizes"),
            told.rfind("was replaced by a picture of other sizes"));
  EXPECT_NE(told.find("test.tif"), std::string::npos) << told;
  expect_same(whole_level(*shown_file.pyramid, 0), before);
}

TEST(Tiff, AFileThatIsGoneOrHalfWrittenStaysOpen) {
  Replaced shown_file;
  const Piece before = shown(shown_file.pages[0]);
  const std::string whole = shown_file.folder.read("test.tif");
  std::filesystem::remove(shown_file.file);
  shown_file.pass_time();
  expect_same(whole_level(*shown_file.pyramid, 0), before);
  // Somebody copies another one there, slowly: nobody opens it before it is whole.
  testing::internal::CaptureStdout();
  for (size_t size = 100; size < whole.size(); size += whole.size() / 8) {
    shown_file.folder.write("test.tif", whole.substr(0, size));
    shown_file.now += 5.5;
    shown_file.fetch();
  }
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  expect_same(whole_level(*shown_file.pyramid, 0), before);
}

TEST(Tiff, AChangedDescriptionOfBandsBesideTheFileIsReadFromThenOn) {
  const Folder folder;
  MadeBands made;
  made.value = [](int, int, int band) { return 10000 * (band + 1); };
  const std::string file = write_bands_tiff(folder.file("a.tif"), made);
  const auto describe = [&](const std::string& text) { folder.write("a.bands.json", text); };
  describe(wavelengths_json(3, 450, 100));
  double now = 0;
  const auto pyramid =
      load_tiff(file, most_whole_texels, [&now] { return now; }, {.shown_nm = {450}});
  const auto shown_later = [&] {
    int code = 0;
    for (int i = 0; i < 3; i++, now += 5.5) code = pyramid->fetch({1, 0, 0, 0}).piece->bytes[0];
    return code;
  };
  const int first_band = shown_later();
  testing::internal::CaptureStdout();
  describe("{");
  EXPECT_EQ(shown_later(), first_band);
  EXPECT_NE(testing::internal::GetCapturedStdout().find("a.bands.json"), std::string::npos);
  describe(wavelengths_json(3, 350, 100));
  EXPECT_GT(shown_later(), first_band);
}

TEST(Tiff, APieceThatSomebodyHasIsNotReadAgain) {
  Replaced shown_file;
  const Fetched first = shown_file.pyramid->fetch({1, 0, 1, 0});
  EXPECT_EQ(first.soft, 60) << "and then it is asked for again";
  EXPECT_EQ(shown_file.pyramid->fetch({1, 0, 1, 0}).piece, first.piece);
  shown_file.replace();
  shown_file.pass_time();
  EXPECT_NE(shown_file.pyramid->fetch({1, 0, 1, 0}).piece, first.piece);
}

}  // namespace
}  // namespace wellspring::test
