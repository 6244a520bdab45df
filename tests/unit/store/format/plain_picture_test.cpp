// SPDX-License-Identifier: Apache-2.0
#include "store/format/plain_picture.h"

#include <lcms2.h>
#include <turbojpeg.h>
#include <zlib.h>

#include "store/picture/texels.h"
#include "unit/store/format/pictures.h"

namespace wellspring::test {
namespace {

using namespace store;
using namespace std::string_literals;

std::string big_endian(uint32_t value, int bytes) {
  std::string text;
  for (int i = bytes; i-- > 0;) text += char(value >> (8 * i));
  return text;
}

// Inserts a chunk behind a PNG's head.
std::string with_chunk(std::string png, const std::string& type, const std::string& data) {
  const std::string body = type + data;
  const uint32_t sum =
      uint32_t(crc32(0, reinterpret_cast<const Bytef*>(body.data()), uInt(body.size())));
  return png.insert(33, big_endian(uint32_t(data.size()), 4) + body + big_endian(sum, 4));
}
// Inserts a segment at a JPEG's beginning.
std::string with_segment(std::string jpeg, int marker, const std::string& data) {
  return jpeg.insert(2, "\xff"s + char(marker) + big_endian(uint32_t(data.size() + 2), 2) + data);
}

std::string jpeg_of(int width, int height, const Codes& codes) {
  Image8 image{width, height, {}};
  for (int y = 0; y < height; y++)
    for (int x = 0; x < width; x++)
      for (int c = 0; c < 3; c++) image.rgb.push_back(uint8_t(codes(x, y, c)));
  std::vector<uint8_t> bytes;
  encode_jpeg(image, 98, true, bytes);
  return {bytes.begin(), bytes.end()};
}

std::string exif(int orientation, bool is_big) {
  if (is_big)
    return "MM\0*\0\0\0\x08\0\x02\x01\x00\0\x03\0\0\0\x01\0\0\0\0\x01\x12\0\x03\0\0\0\x01\0"s +
           char(orientation) + "\0\0\0\0\0\0"s;
  return "II*\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0"s + char(orientation) + "\0\0\0\0\0\0\0"s;
}

TEST(PlainPicture, LevelsAreHalvedUntilTheyAreSmall) {
  const Folder folder;
  const auto pyramid = open_picture(folder.write("a.png", png_of(2100, 301, pattern)));
  ASSERT_EQ(pyramid->levels().size(), 5u);
  EXPECT_EQ(pyramid->levels()[1].width, 1050);
  EXPECT_EQ(pyramid->levels()[1].height, 151);
  EXPECT_EQ(pyramid->levels()[4].width, 132);
  const Piece finest = whole_level(*pyramid, 0);
  expect_same(finest, piece_of(2100, 301, pattern));
  expect_same(whole_level(*pyramid, 1), halve(finest));
  expect_same(read_level(*pyramid, 4), halve(halve(halve(halve(finest)))));
  EXPECT_THROW(read_level(*pyramid, 3), std::invalid_argument);
}

TEST(PlainPicture, OneTexelIsAPicture) {
  const Folder folder;
  const auto pyramid = open_picture(folder.write("a.png", png_of(1, 1, pattern)));
  expect_same(read_level(*pyramid, 0), piece_of(1, 1, pattern));
}

TEST(PlainPicture, ExifTurnsAndMirrors) {
  // The stored picture is this one, turned the other way.
  constexpr int wide = 20, high = 12;
  for (int code = 1; code <= 8; code++)
    for (const bool is_big : {false, true}) {
      SCOPED_TRACE(testing::Message() << "orientation " << code << (is_big ? " MM" : " II"));
      const bool swaps = code >= 5;
      const int w = swaps ? high : wide, h = swaps ? wide : high;
      const auto stored = [&](int x, int y, int c) {
        // EXIF names the sides on which row 0 and column 0 are seen.
        const bool right = code == 2 || code == 3, bottom = code == 3 || code == 4;
        int across = right ? w - 1 - x : x, down = bottom ? h - 1 - y : y;
        if (swaps) {
          across = code == 6 || code == 7 ? wide - 1 - y : y;  // row 0 is the right side
          down = code == 7 || code == 8 ? high - 1 - x : x;    // column 0 is the bottom
        }
        return 30 + 8 * across + 4 * down + c;
      };
      const Piece seen =
          piece_of(wide, high, [](int x, int y, int c) { return 30 + 8 * x + 4 * y + c; });
      const Folder folder;
      const std::string tiff = exif(code, is_big);
      const std::string jpeg = with_segment(jpeg_of(w, h, stored), 0xe1, "Exif\0\0"s + tiff);
      expect_same(whole_level(*open_picture(folder.write("a.jpg", jpeg)), 0), seen, 4);
      const std::string png = with_chunk(png_of(w, h, stored), "eXIf", tiff);
      expect_same(whole_level(*open_picture(folder.write("a.png", png)), 0), seen);
    }
}

TEST(PlainPicture, BrokenExifTurnsNothing) {
  const Folder folder;
  const std::string whole = exif(3, false), jpeg = jpeg_of(9, 7, pattern);
  const Piece upright = whole_level(*open_picture(folder.write("a.jpg", jpeg)), 0);
  for (size_t size = 0; size < 18; size++)
    expect_same(
        whole_level(*open_picture(folder.write(
                        "a.jpg", with_segment(jpeg, 0xe1, "Exif\0\0"s + whole.substr(0, size)))),
                    0),
        upright);
  const std::string wild = "II*\0\xff\xff\xff\xff"s + whole.substr(8);
  for (const std::string& broken : {exif(9, false), exif(0, true), wild})
    expect_same(whole_level(*open_picture(folder.write(
                                "a.jpg", with_segment(jpeg, 0xe1, "Exif\0\0"s + broken))),
                            0),
                upright);
}

std::string linear_profile() {
  const cmsCIExyY white = {0.3127, 0.3290, 1};
  const cmsCIExyYTRIPLE primaries = {{0.64, 0.33, 1}, {0.30, 0.60, 1}, {0.15, 0.06, 1}};
  cmsToneCurve* linear = cmsBuildGamma(nullptr, 1);
  cmsToneCurve* curves[] = {linear, linear, linear};
  const cmsHPROFILE profile = cmsCreateRGBProfile(&white, &primaries, curves);
  cmsUInt32Number size = 0;
  cmsSaveProfileToMem(profile, nullptr, &size);
  std::string bytes(size, '\0');
  cmsSaveProfileToMem(profile, bytes.data(), &size);
  cmsCloseProfile(profile);
  cmsFreeToneCurve(linear);
  return bytes;
}

TEST(PlainPicture, ProfilesAreApplied) {
  const Folder folder;
  const auto grey = [](int, int, int) { return 55; };
  const Piece wanted = piece_of(9, 7, [](int, int, int) { return 128; });
  const std::string profile = linear_profile();
  std::string packed(compressBound(profile.size()), '\0');
  uLongf size = packed.size();
  compress(reinterpret_cast<Bytef*>(packed.data()), &size,
           reinterpret_cast<const Bytef*>(profile.data()), profile.size());
  packed.resize(size);
  const std::string png = with_chunk(png_of(9, 7, grey), "iCCP", "linear\0\0"s + packed);
  expect_same(whole_level(*open_picture(folder.write("a.png", png)), 0), wanted, 1);
  // A JPEG has it in parts, in any order.
  std::string jpeg = jpeg_of(9, 7, grey);
  jpeg = with_segment(jpeg, 0xe2, "ICC_PROFILE\0\x01\x02"s + profile.substr(0, 100));
  jpeg = with_segment(jpeg, 0xe2, "ICC_PROFILE\0\x02\x02"s + profile.substr(100));
  expect_same(whole_level(*open_picture(folder.write("a.jpg", jpeg)), 0), wanted, 2);
  const std::string broken = with_chunk(png_of(9, 7, grey), "iCCP", "linear\0\0nothing"s);
  expect_same(whole_level(*open_picture(folder.write("a.png", broken)), 0), piece_of(9, 7, grey));
}

TEST(PlainPicture, InksOfJpegAbsorb) {
  // libjpeg marks the file as Adobe's: 255 is no ink.
  std::vector<uint8_t> inks;
  for (int i = 0; i < 16 * 16; i++) inks.insert(inks.end(), {255, 155, 255, 205});
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  const tjhandle handle = tjInitCompress();
  ASSERT_EQ(
      tjCompress2(handle, inks.data(), 16, 0, 16, TJPF_CMYK, &bytes, &size, TJSAMP_444, 98, 0), 0);
  const Folder folder;
  const std::string jpeg(reinterpret_cast<char*>(bytes), size);
  tjFree(bytes);
  tjDestroy(handle);
  expect_same(whole_level(*open_picture(folder.write("a.jpg", jpeg)), 0),
              piece_of(16, 16, [](int, int, int c) { return c == 1 ? 155 * 205 / 255 : 205; }), 3);
  EXPECT_NE(refusal(folder.write("a.jpg", jpeg.substr(0, size / 2))), "");
}

TEST(PlainPicture, PicturesTooLargeToBeReadWholeAreRefusedBeforeTheyAreUnpacked) {
  const Folder folder;
  for (const auto& [wide, high] : {std::pair(19000, 19000), std::pair(30000, 3)}) {
    std::string png = png_of(1, 1, pattern);
    png.replace(16, 8, big_endian(uint32_t(wide), 4) + big_endian(uint32_t(high), 4));
    const std::string told = refusal(folder.write("bomb.png", png));
    EXPECT_NE(told.find("bomb.png: picture of " + std::to_string(wide) + " x " +
                        std::to_string(high) + " has no smaller versions"),
              std::string::npos)
        << told;
  }
  const std::string file = folder.write("a.png", png_of(10, 10, pattern));
  EXPECT_NO_THROW(load_plain_picture(file, 100));
  EXPECT_THROW(load_plain_picture(file, 99), LoadError);
}

TEST(PlainPicture, OtherFormatsAreRefusedByTheirName) {
  const Folder folder;
  const std::pair<std::string, std::string> files[] = {
      {"\0\0\0\x1c"
       "ftypavif\0\0\0\0"s,
       "AVIF is not read"},
      {"\0\0\0\x1c"
       "ftypheic\0\0\0\0"s,
       "HEIF is not read"},
      {"\0\0\0\x0cjP  \r\n\x87\n"s, "JPEG 2000 is not read"},
      {"GIF89a", "GIF is not read"},
      {"text", "is no picture that is known"},
      {"", "is empty"},
      {"\x89PNG\r\n\x1a\n", "cannot be decoded"},
      {"\xff\xd8\xff", "picture"},
      {"II*\0"s, "is no TIFF"}};
  for (const auto& [bytes, told] : files) {
    const std::string what = refusal(folder.write("a", bytes));
    EXPECT_NE(what.find(folder.file("a")), std::string::npos) << what;
    EXPECT_NE(what.find(told), std::string::npos) << what;
  }
}

TEST(Texels, AveragesAreThoseOfLight) {
  Piece piece{2, 2, {}};
  for (const int code : {255, 0, 0, 255})
    piece.bytes.insert(piece.bytes.end(), {uint8_t(code), uint8_t(code), uint8_t(code), 255});
  const Piece half = halve(piece);
  ASSERT_EQ(half.bytes.size(), 4u);
  EXPECT_EQ(half.bytes[0], 188);  // half of the light
  EXPECT_EQ(half.bytes[3], 255);
  // Transparent texels have no colour.
  piece.bytes[3] = piece.bytes[15] = 0;
  EXPECT_EQ(halve(piece).bytes[0], 0);
  EXPECT_EQ(halve(piece).bytes[3], 128);
}

TEST(Texels, OddSidesAreCoveredEvenly) {
  for (int code = 0; code < 256; code++) {
    const Piece plain = halve(piece_of(5, 3, [&](int, int, int) { return code; }));
    expect_same(plain, piece_of(3, 2, [&](int, int, int) { return code; }));
  }
  // Each of two texels covers one and a half: 1, 1/2 of 0 of three.
  Piece piece = piece_of(3, 1, [](int x, int, int) { return x == 0 ? 255 : 0; });
  const Piece half = halve(piece);
  EXPECT_EQ(half.bytes[0], 213);  // sRGB of 2/3
  EXPECT_EQ(half.bytes[4], 0);
}

}  // namespace
}  // namespace wellspring::test
