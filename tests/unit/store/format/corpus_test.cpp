// SPDX-License-Identifier: Apache-2.0
// Real files: museums' pyramids, the test files of image servers and viewers.
#include <algorithm>
#include <cmath>

#include "store/picture/texels.h"
#include "unit/store/format/pictures.h"

namespace wellspring::test {
namespace {

using namespace store;
namespace fs = std::filesystem;

struct PictureCorpus : testing::Test {
  fs::path root = fs::path(WELLSPRING_DATA) / "10_exhibits" / "pictures";
  void SetUp() override {
    if (!fs::exists(root)) GTEST_SKIP() << "no corpus at " << root;
  }
  std::string at(const std::string& name) const { return (root / name).string(); }
  std::vector<std::string> files(const std::string& folder) const {
    std::vector<std::string> found;
    for (const auto& entry : fs::recursive_directory_iterator(root / folder))
      if (entry.is_regular_file()) found.push_back(entry.path().string());
    std::ranges::sort(found);
    return found;
  }
};

// Returns the mean difference of colours.
double difference(const Piece& a, const Piece& b) {
  if (a.width != b.width || a.height != b.height) return 255;
  double sum = 0;
  for (size_t i = 0; i < a.bytes.size(); i++) sum += std::abs(a.bytes[i] - b.bytes[i]);
  return sum / double(a.bytes.size());
}

// Returns the picture in 4 x 4 means of codes.
std::vector<double> means(const Piece& piece) {
  std::vector<double> sums(64), counts(64);
  for (int y = 0; y < piece.height; y++)
    for (int x = 0; x < piece.width; x++)
      for (int c = 0; c < 4; c++) {
        const size_t cell = size_t((y * 4 / piece.height * 4 + x * 4 / piece.width) * 4 + c);
        sums[cell] += piece.bytes[(size_t(y) * size_t(piece.width) + size_t(x)) * 4 + size_t(c)];
        counts[cell]++;
      }
  for (size_t i = 0; i < 64; i++) sums[i] /= counts[i];
  return sums;
}

TEST_F(PictureCorpus, EveryTileOfAPyramidIsThereAndLevelsShowOnePicture) {
  const std::pair<const char*, std::vector<int64_t>> pyramids[] = {
      {"adoration", {3101, 3875, 5}},
      {"cosmographia_1467/ImageProperties.xml", {6732, 4938, 6}},
      {"dollhouse", {6421, 4877, 6}},
      {"deepzoom_iiif/zoomify", {1000, 1000, 3}},
      {"deepzoom_iiif/tall.dzi", {500, 2000, 12}},
      {"deepzoom_iiif/wide.dzi", {2000, 500, 12}},
      {"deepzoom_iiif/testpattern.dzi", {1000, 1000, 11}},
      {"deepzoom_iiif/testpattern.xml", {1000, 1000, 11}},
      {"deepzoom_iiif/iiif_1_1_tiled", {775, 1024, 6}},
      {"deepzoom_iiif/iiif_3_0_tiled/info.json", {775, 1024, 4}},
      {"deepzoom_iiif/iiif_1_1_no_tiles_255", {255, 212, 2}},
      {"deepzoom_iiif/iiif_1_1_no_tiles_384", {384, 319, 2}}};
  for (const auto& [name, about] : pyramids) {
    SCOPED_TRACE(name);
    const auto pyramid = open_picture(at(name));
    const auto& levels = pyramid->levels();
    ASSERT_EQ(levels.size(), size_t(about[2]));
    EXPECT_EQ(levels[0].width, about[0]);
    EXPECT_EQ(levels[0].height, about[1]);
    std::vector<double> finest;
    for (size_t i = 0; i < levels.size(); i++) {
      for (int row = 0; row < levels[i].rows(); row++)
        for (int column = 0; column < levels[i].columns(); column++)
          ASSERT_NE(pyramid->fetch({1, int(i), uint32_t(column), uint32_t(row)}).piece, nullptr)
              << i << ": " << column << ", " << row;
      if (std::min(levels[i].width, levels[i].height) < 100) continue;
      const std::vector<double> seen = means(whole_level(*pyramid, int(i)));
      if (finest.empty()) finest = seen;
      for (size_t k = 0; k < seen.size(); k++) ASSERT_NEAR(seen[k], finest[k], 9) << i;
    }
  }
}

TEST_F(PictureCorpus, TheSamePictureIsReadFromEachVersionOfIiif) {
  const Piece first = whole_level(*open_picture(at("deepzoom_iiif/iiif_1_1_tiled")), 0);
  for (const char* other : {"deepzoom_iiif/iiif_2_0_tiled", "deepzoom_iiif/iiif_3_0_tiled"})
    EXPECT_LT(difference(whole_level(*open_picture(at(other)), 0), first), 1) << other;
}

TEST_F(PictureCorpus, InfosAreReadOrRefusedAsTheirNamesSay) {
  int good = 0, bad = 0;
  for (const std::string& file : files("iiif_info")) {
    const std::string name = fs::path(file).filename().string();
    if (!name.ends_with(".json")) continue;
    SCOPED_TRACE(file);
    if (name.find("bad") == name.npos) {
      EXPECT_NO_THROW(open_picture(file));
      good++;
    } else {
      EXPECT_THROW(open_picture(file), LoadError);
      bad++;
    }
  }
  EXPECT_GT(good, 15);
  EXPECT_GT(bad, 10);
  EXPECT_NE(refusal(at("iiif_info/info_json_1_0/info_ex1.xml")).find("only its info.json"),
            std::string::npos);
  EXPECT_NE(refusal(at("iiif_info/red-19000x19000.png")).find("19000 x 19000"), std::string::npos);
  EXPECT_NE(refusal(at("rti_ptm/info.json")), "");
}

TEST_F(PictureCorpus, TiffsOfEachCodingShowOnePicture) {
  // JPEG loses little; libtiff's test files of one picture are named by their coding.
  const Piece first =
      whole_level(*open_picture(at("image_server/tif-rgb-1res-64x56x8-striped-zip.tif")), 0);
  int read = 0;
  for (const std::string& file : files("image_server")) {
    const std::string name = fs::path(file).filename().string();
    if (!name.starts_with("tif-rgb")) continue;
    SCOPED_TRACE(name);
    const Piece piece = whole_level(*open_picture(file), 0);
    EXPECT_LT(difference(piece, first), name.find("jpeg") == name.npos ? 0.5 : 8);
    read++;
  }
  EXPECT_GT(read, 30);
  EXPECT_EQ(open_picture(at("image_server/tif-rgb-3res-64x56x16-tiled-uncompressed.tif"))
                ->levels()
                .size(),
            3u);
  const auto scans = open_picture(at("image_server/tif-bw-9image.tif"));
  EXPECT_EQ(scans->levels()[0].height, 2170);  // eight more pages are as large
}

TEST_F(PictureCorpus, PicturesOf16BitsAreThoseOf8) {
  const auto level = [&](const std::string& name) {
    return whole_level(*open_picture(at(name)), 0);
  };
  for (const std::string kind : {"rgb", "rgba"})
    EXPECT_LT(difference(level("image_server/png-" + kind + "-64x56x16.png"),
                         level("image_server/png-" + kind + "-64x56x8.png")),
              0.5);
}

TEST_F(PictureCorpus, TurnedAndMirroredPhotographsLookTheSame) {
  const auto distance = [](const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0;
    for (size_t i = 0; i < a.size(); i++) sum += std::abs(a[i] - b[i]);
    return sum / double(a.size());
  };
  const auto photograph = [&](int code) {
    return whole_level(*open_picture(at("tiff_edges/rotation/" + std::to_string(code) + ".jpg")),
                       0);
  };
  const Piece wanted = photograph(1);
  for (int i = 2; i <= 8; i++) {
    SCOPED_TRACE(i);
    const Piece found = photograph(i);  // from the fifth on they are smaller
    EXPECT_LT(found.width, found.height);
    const double right = distance(means(found), means(wanted));
    for (const int wrong : {2, 3, 4})
      EXPECT_LT(3 * right, distance(means(turn(found, {wrong})), means(wanted))) << wrong;
  }
}

TEST_F(PictureCorpus, SlidesAreReadWithoutTheirLabels) {
  const auto slide = open_picture(at("tiff_edges/CMU-1-Small-Region.svs"));
  ASSERT_EQ(slide->levels().size(), 5u);
  EXPECT_EQ(slide->levels()[0].width, 2220);
  EXPECT_EQ(slide->levels()[0].tile_width, 240);
  const std::vector<double> fine = means(whole_level(*slide, 0)),
                            coarse = means(whole_level(*slide, 2));
  for (size_t k = 0; k < fine.size(); k++) EXPECT_NEAR(fine[k], coarse[k], 9);
}

TEST_F(PictureCorpus, EveryOtherFileIsReadOrRefusedByName) {
  for (const char* folder : {"image_server", "tiff_edges"})
    for (const std::string& file : files(folder)) {
      SCOPED_TRACE(file);
      const std::string told = refusal(file);
      const std::string end = fs::path(file).extension().string();
      if (told.empty()) {
        EXPECT_TRUE(end == ".tif" || end == ".jpg" || end == ".png" || end == ".svs");
        continue;
      }
      EXPECT_EQ(told.find(file), 0u);
      EXPECT_TRUE(end != ".png" && (end != ".jpg" || file.ends_with("truncated.jpg"))) << told;
      EXPECT_EQ(end == ".tif", told.find("old-style JPEG") != std::string::npos) << told;
    }
  EXPECT_NE(refusal(at("tiff_edges/17000x17000.avif")).find("AVIF is not read"), std::string::npos);
}

}  // namespace
}  // namespace wellspring::test
