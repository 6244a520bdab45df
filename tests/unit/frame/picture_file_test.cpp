// SPDX-License-Identifier: Apache-2.0
#include "frame/picture_file.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>

#include "base/load_error.h"
#include "image/image.h"
#include "unit/frame/tonemap_color.h"

namespace wellspring::test {
namespace {

namespace fs = std::filesystem;

// A folder of its own for each test, removed afterwards.
struct PictureFile : testing::Test {
  fs::path folder = fs::temp_directory_path() / ("wellspring_picture_" + std::to_string(getpid()));
  PictureFile() { fs::create_directories(folder); }
  ~PictureFile() override { fs::remove_all(folder); }
  std::string path(const char* name) const { return (folder / name).string(); }
};

Frame make_frame() {
  Frame frame{.width = 5, .height = 3};
  for (int i = 0; i < 15; i++) {
    frame.color.push_back(vec3(float(i) * 0.1f, 1e-6f * float(i), 1e4f + float(i)));
    frame.depth.push_back(float(i));
  }
  return frame;
}

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write_bytes(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

TEST_F(PictureFile, LinearFormatsKeepEveryBit) {
  Frame frame = make_frame();
  frame.color[3].y = std::numeric_limits<float>::infinity();
  for (const char* name : {"a.pfm", "a.exr", "A.EXR"}) {
    save_picture(path(name), frame, {5.0f});  // exposure does not touch linear pictures
    Frame back = load_linear_picture(path(name));
    ASSERT_EQ(back.width, 5) << name;
    ASSERT_EQ(back.height, 3) << name;
    EXPECT_EQ(back.color, frame.color) << name;
  }
}

TEST_F(PictureFile, PfmIsBottomRowFirst) {
  save_picture(path("a.pfm"), make_frame(), {});
  std::string bytes = bytes_of(path("a.pfm"));
  std::string header = "PF\n5 3\n-1.0\n";
  ASSERT_EQ(bytes.substr(0, header.size()), header);
  float first;
  std::memcpy(&first, bytes.data() + header.size(), 4);
  EXPECT_FLOAT_EQ(first, 1.0f);  // pixel (0, 2)
}

TEST_F(PictureFile, BigEndianAndGreyPfmAreRead) {
  write_bytes(path("grey.pfm"),
              std::string("Pf\n2 1\n1.0\n") + std::string("\x3f\x80\0\0\x40\0\0\0", 8));
  Frame frame = load_linear_picture(path("grey.pfm"));
  EXPECT_EQ(frame.color, (std::vector<vec3>{vec3(1), vec3(2)}));
}

TEST_F(PictureFile, EightBitFormatsAreToneMapped) {
  Frame frame = make_frame();
  for (vec3& c : frame.color) c = vec3(0.5f, 0.25f, 0.1f);
  save_picture(path("a.png"), frame, {2.0f});
  save_picture(path("a.jpg"), frame, {2.0f});
  EXPECT_EQ(bytes_of(path("a.png")).substr(1, 3), "PNG");
  std::string jpeg = bytes_of(path("a.jpg"));
  Image8 image = decode_jpeg({reinterpret_cast<const uint8_t*>(jpeg.data()), jpeg.size()}, "a.jpg");
  vec3 expected = test::tonemap_color(frame.color[0], {2.0f}) * 255.0f;
  for (int c = 0; c < 3; c++) EXPECT_NEAR(image.rgb[size_t(c)], expected[c], 4);
}

TEST_F(PictureFile, OnlyKnownNamesAreTaken) {
  for (const char* name : {"a.png", "b.JPG", "x/y.jpeg", "c.pfm", "d.exr"})
    EXPECT_TRUE(is_picture_name(name));
  for (const char* name : {"", "png", "a.png/b", "a.gif", "a.", ".d/x"})
    EXPECT_FALSE(is_picture_name(name));
  EXPECT_THROW(save_picture(path("a.gif"), make_frame(), {}), LoadError);
  EXPECT_THROW(save_picture(path("a.png"), Frame{}, {}), LoadError);
}

TEST_F(PictureFile, AFailedWriteLeavesNothingBehind) {
  EXPECT_THROW(save_picture(path("missing/a.png"), make_frame(), {}), LoadError);
  fs::create_directory(folder / "taken.png");
  write_bytes(path("taken.png/inside"), "x");
  EXPECT_THROW(save_picture(path("taken.png"), make_frame(), {}), LoadError);
  size_t files = 0;
  for ([[maybe_unused]] const auto& entry : fs::directory_iterator(folder)) files++;
  EXPECT_EQ(files, 1u);
}

TEST_F(PictureFile, DamagedLinearPicturesAreRefused) {
  save_picture(path("good.exr"), make_frame(), {});
  std::string exr = bytes_of(path("good.exr"));
  std::string damaged = exr;
  for (size_t i = 0; i < damaged.size(); i += 7) damaged[i] = char(damaged[i] ^ 0x5a);
  std::pair<const char*, std::string> cases[] = {{"empty.pfm", ""},
                                                 {"magic.pfm", "P6\n1 1\n255\nabc"},
                                                 {"short.pfm", "PF\n4 4\n-1.0\nabc"},
                                                 {"huge.pfm", "PF\n2000000000 2000000000\n-1.0\n"},
                                                 {"negative.pfm", "PF\n-4 4\n-1.0\n"},
                                                 {"scale.pfm", "PF\n1 1\nnan\n000000000000"},
                                                 {"empty.exr", ""},
                                                 {"noise.exr", std::string(500, 'x')},
                                                 {"cut.exr", exr.substr(0, exr.size() / 2)},
                                                 {"damaged.exr", damaged}};
  for (const auto& [name, bytes] : cases) {
    write_bytes(path(name), bytes);
    try {
      load_linear_picture(path(name));
      ADD_FAILURE() << name << " was accepted";
    } catch (const LoadError& error) {
      EXPECT_EQ(error.file, path(name));
    }
  }
  EXPECT_THROW(load_linear_picture(path("absent.exr")), LoadError);
  EXPECT_THROW(load_linear_picture(path("good.png")), LoadError);
}

// Before anything of that size is made: what is refused is named.
TEST_F(PictureFile, SizesThatAnExrFileOnlyClaimsAreRefused) {
  save_picture(path("good.exr"), make_frame(), {});
  // The file has room for the table of many rows.
  const std::string exr = bytes_of(path("good.exr")) + std::string(20'000, '\0');
  // Writes these numbers `skip` bytes behind a name and its type.
  auto claims = [&](const std::string& name, size_t skip, std::vector<int32_t> numbers) {
    std::string bytes = exr;
    const size_t at = bytes.find(name) + name.size() + skip;
    std::memcpy(bytes.data() + at, numbers.data(), numbers.size() * sizeof(int32_t));
    write_bytes(path("claims.exr"), bytes);
    try {
      load_linear_picture(path("claims.exr"));
    } catch (const LoadError& error) {
      return error.where + ": " + error.what_;
    }
    return std::string("accepted");
  };
  const std::string channels("channels\0chlist\0", 16), window("dataWindow\0box2i\0", 17);
  EXPECT_EQ(claims(channels, 0, {2'000'000'000}),
            "byte 24: an attribute of 2000000000 bytes is cut off");
  EXPECT_EQ(claims(window, 4, {0, 0, 16383, 16383}),
            "dataWindow: picture must have at most 64 million pixels");
  EXPECT_EQ(claims(window, 4, {-(1 << 29), 0, 4 - (1 << 29), 2}),
            "dataWindow: begins more than a million pixels from 0");
  EXPECT_EQ(claims(window, 4, {0, 0, 4, 2}), "accepted");
}

// OpenEXR reads values of its types by what stands in them, not by the size that is said.
TEST_F(PictureFile, AttributesOfAnExrFileThatAreNotOfTheirTypeAreRefused) {
  save_picture(path("good.exr"), make_frame(), {});
  const std::string exr = bytes_of(path("good.exr"));
  auto with = [&](const std::string& type, const std::string& value) {
    const char size[4] = {char(value.size())};
    std::string attribute = std::string("x") + '\0' + type + '\0' + std::string(size, 4) + value;
    write_bytes(path("with.exr"), exr.substr(0, 8) + attribute + exr.substr(8));
    try {
      load_linear_picture(path("with.exr"));
    } catch (const LoadError& error) {
      // The header is read; its table of rows was not moved.
      if (error.what_.find("Unexpected data block") != std::string::npos) return std::string();
      return error.where + ": " + error.what_;
    }
    return std::string("accepted");
  };
  const std::string zeros(40, '\0'), many("\xff\xff\xff\x7f", 4), two("\x02\0\0\0", 4);
  EXPECT_EQ(with("v3f", zeros.substr(0, 8)), "byte 14: an attribute of 8 bytes is no v3f");
  EXPECT_EQ(with("v3f", zeros.substr(0, 12)), "");
  EXPECT_EQ(with("stringvector", many + "ab"),
            "byte 23: an attribute of 6 bytes is no stringvector");
  EXPECT_EQ(with("stringvector", two + "ab"), "");
  EXPECT_EQ(with("preview", many + many), "byte 18: an attribute of 8 bytes is no preview");
  EXPECT_EQ(with("preview", two + two + zeros.substr(0, 16)), "");
  EXPECT_EQ(with("chlist", "G"), "byte 17: an attribute of 1 bytes is no chlist");
  EXPECT_EQ(with("chlist", std::string("G", 2) + zeros.substr(0, 17)), "");
  EXPECT_EQ(with("floatvector", "12345"), "byte 22: an attribute of 5 bytes is no floatvector");
  EXPECT_EQ(with("of mine", "12345"), "");
}

TEST(PictureCorpus, MitsubaReferencesAreRead) {
  fs::path folder = fs::path(WELLSPRING_DATA) / "6_reference";
  if (!fs::exists(folder)) GTEST_SKIP() << "no reference pictures beside the checkout";
  int count = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.path().extension() != ".exr" || count == 12) continue;
    Frame frame = load_linear_picture(entry.path().string());
    double sum = 0;
    for (vec3 c : frame.color) sum += luminance(c);
    EXPECT_TRUE(std::isfinite(sum)) << entry.path();
    count++;
  }
  EXPECT_GT(count, 0);
}

}  // namespace
}  // namespace wellspring::test
