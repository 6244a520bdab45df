// SPDX-License-Identifier: Apache-2.0
#include "kiosk/station/learn.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "base/load_error.h"
#include "benchmark/kiosk/made_objects.h"

namespace wellspring::test {
namespace {

namespace fs = std::filesystem;

struct LearnFolder : testing::Test {
  fs::path folder;
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder = fs::path(testing::TempDir()) / (std::string("station_") + test->name());
    fs::remove_all(folder);
    fs::create_directories(folder / "coin");
  }
  void TearDown() override { fs::remove_all(folder); }
  void photo(const std::string& name, const cv::Mat& picture) const {
    cv::imwrite((folder / name).string(), picture);
  }
  void text(const std::string& name, const std::string& what) const {
    std::ofstream(folder / name) << what;
  }
  std::string place_of_error() const {
    try {
      load_objects(folder.string());
    } catch (const LoadError& error) {
      return error.file.substr(folder.string().size()) + " " + error.where;
    }
    return "none";
  }
};

TEST_F(LearnFolder, objects_are_read_with_their_sides) {
  const cv::Mat face = make_face(1);
  cv::Mat framed;
  cv::copyMakeBorder(face, framed, 50, 60, 70, 80, cv::BORDER_CONSTANT, {250, 250, 250});
  photo("coin/Front-2.png", framed);
  photo("coin/back.jpg", make_face(2));
  text("coin/object.json", R"({"title": {"en": "A coin"}, "class": {"en": "a Roman coin"},
      "size": {"front": [0.02, 0.015]}, "hints": {"turn": {"en": "Flip it"}}})");
  text("notes.txt", "not read");
  const auto objects = load_objects(folder.string());
  ASSERT_EQ(objects.size(), 1u);
  const LearnObject& coin = objects[0];
  EXPECT_EQ(coin.id, "coin");
  EXPECT_EQ(coin.title.at("en"), "A coin");
  EXPECT_EQ(coin.of_class.at("en"), "a Roman coin");
  ASSERT_EQ(coin.photos.size(), 2u);
  EXPECT_EQ(coin.photos[0].side, "front");
  EXPECT_EQ(coin.photos[1].side, "back");
  // The white round it is left out.
  EXPECT_NEAR(coin.photos[0].width, face.cols, 3);
  EXPECT_NEAR(coin.photos[0].height, face.rows, 3);
  EXPECT_TRUE(coin.code.empty());
  const RecognitionTree tree = learn_tree(objects, folder.string()).tree;
  EXPECT_EQ(tree.hints.at("turn").at("en"), "Flip it");
  EXPECT_EQ(tree.hints.at("closer").at("de"), "Bitte etwas näher.");
  size_t models = 0;
  for (size_t i = 0; i < tree.nodes.size(); i++) {
    if (tree.nodes[i].kind != NodeKind::model) continue;
    models++;
    ASSERT_EQ(tree.data[i].views.size(), 2u);
    EXPECT_FLOAT_EQ(tree.data[i].views[0].size.x, 0.02f);
    EXPECT_EQ(tree.data[i].views[1].size.x, 0.f);
  }
  EXPECT_EQ(models, 1u);
}

TEST_F(LearnFolder, faults_are_named) {
  EXPECT_EQ(place_of_error(), "/coin ");  // no photograph
  photo("coin/front.png", make_face(1, 40, 30));
  EXPECT_EQ(place_of_error(), "/coin/front.png ");  // too small
  text("coin/front.png", "no picture");
  EXPECT_EQ(place_of_error(), "/coin/front.png ");
  photo("coin/front.png", make_face(1));
  EXPECT_EQ(place_of_error(), "none");
  for (const auto& [json, where] : {std::pair("{\"title\": 3}", "/title"),
                                    {"{\"size\": [0, 1]}", "/size/0"},
                                    {"{\"titel\": {}}", "/titel"},
                                    {"[", ""}}) {
    text("coin/object.json", json);
    const std::string found = place_of_error();
    EXPECT_TRUE(found.starts_with("/coin/object.json")) << found;
    EXPECT_NE(found.find(where), std::string::npos) << found;
  }
  fs::remove_all(folder / "coin");
  EXPECT_EQ(place_of_error(), " ");
}

TEST(LearnTree, is_balanced) {
  std::vector<LearnObject> objects;
  for (unsigned i = 0; i < 16; i++)
    objects.push_back(make_object(std::to_string(i), {{make_face(200 + i, 320, 240), "front"}}));
  const RecognitionTree tree = learn_tree(std::move(objects), "made").tree;
  auto depth = [&](auto& self, int at) -> int {
    int most = 0;
    for (const int child : tree.nodes[size_t(at)].children)
      most = std::max(most, 1 + self(self, child));
    return most;
  };
  EXPECT_EQ(depth(depth, tree.root), 4);
  EXPECT_EQ(tree.nodes.size(), 31u);
}

}  // namespace
}  // namespace wellspring::test
