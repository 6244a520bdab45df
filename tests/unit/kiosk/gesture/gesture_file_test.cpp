// SPDX-License-Identifier: Apache-2.0
#include "kiosk/gesture/gesture_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/load_error.h"
#include "kiosk/gesture/train.h"
#include "kiosk/gesture/writer.h"

namespace wellspring::test {
namespace {

namespace fs = std::filesystem;

struct GestureFile : testing::Test {
  fs::path folder;
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder = fs::path(testing::TempDir()) / (std::string("gesture_") + test->name());
    fs::remove_all(folder);
    fs::create_directories(folder);
  }
  void TearDown() override { fs::remove_all(folder); }
  std::string write(const std::string& name, const std::string& text) const {
    const std::string file = (folder / name).string();
    std::ofstream(file) << text;
    return file;
  }
};

// The place that the error names; fails where there is none.
template <class Load>
std::string place_of_error(const std::string& file, const Load& load) {
  try {
    load();
  } catch (const LoadError& error) {
    EXPECT_EQ(error.file, file);
    EXPECT_FALSE(error.what_.empty());
    return error.where;
  }
  ADD_FAILURE() << "no error";
  return "none";
}

TEST_F(GestureFile, recordings_are_read_in_the_order_of_their_names) {
  write("b.json", R"({"label": "3", "variant": "x", "places": [[0, 0.5, -0.25], [0.1, 1, 2]]})");
  write("a.json", R"({"places": [[5, 0, 0], [6, 0, 0]]})");
  write("notes.txt", "not read");
  const auto paths = load_recordings(folder.string());
  ASSERT_EQ(paths.size(), 2u);
  EXPECT_EQ(paths[0].label, "");
  EXPECT_EQ(paths[1].label, "3");
  EXPECT_EQ(paths[1].variant, "x");
  EXPECT_EQ(paths[1].places[0].place, vec2(0.5f, -0.25f));
  EXPECT_EQ(paths[1].places[1].time, 0.1);
}

TEST_F(GestureFile, what_is_wrong_with_a_recording_is_named_with_its_place) {
  const std::pair<const char*, const char*> wrong[] = {
      {R"({"label": "3", "places": [[0, 0, 0], [0, 1, 1]]})", "/places/1/0"},
      {R"({"label": "3", "places": [[0, 0, 0], [1, 99, 1]]})", "/places/1/1"},
      {R"({"label": "3", "places": [[0, 0, 0], [1, 1, "x"]]})", "/places/1/2"},
      {R"({"label": "3", "places": [[0, 0], [1, 1, 1]]})", "/places/0"},
      {R"({"label": "3", "places": [[0, 0, 0]]})", "/places"},
      {R"({"label": "3"})", "/places"},
      {R"({"label": 3, "places": [[0, 0, 0], [1, 1, 1]]})", "/label"},
      {R"({"label": "a\nb", "places": [[0, 0, 0], [1, 1, 1]]})", "/label"},
      {"[1, 2", ""},
      {"[]", ""}};
  for (const auto& [text, place] : wrong) {
    const std::string file = write("one.json", text);
    EXPECT_EQ(place_of_error(file, [&] { load_recordings(folder.string()); }), place) << text;
  }
}

TEST_F(GestureFile, a_folder_without_recordings_is_an_error) {
  EXPECT_EQ(place_of_error(folder.string(), [&] { load_recordings(folder.string()); }), "");
  const std::string none = (folder / "none").string();
  EXPECT_EQ(place_of_error(none, [&] { load_recordings(none); }), "");
}

TEST_F(GestureFile, models_come_back_as_they_were) {
  const GestureModels models = train_gestures(write_set(WriterGroup::training, 3, 2, 1));
  const std::string file = (folder / "models.json").string();
  save_gesture_models(models, file);
  const GestureModels again = load_gesture_models(file);
  ASSERT_EQ(again.gestures.size(), models.gestures.size());
  for (size_t g = 0; g < models.gestures.size(); g++) {
    const GestureModel &a = models.gestures[g], &b = again.gestures[g];
    EXPECT_EQ(a.label, b.label);
    EXPECT_EQ(a.variant, b.variant);
    EXPECT_EQ(a.hmm.transition, b.hmm.transition);
    EXPECT_EQ(a.hmm.output, b.hmm.output);
    EXPECT_EQ(a.hmm.ends_in_last, b.hmm.ends_in_last);
    EXPECT_EQ(a.mean, b.mean);
    EXPECT_EQ(a.other_deviation, b.other_deviation);
    EXPECT_EQ(a.least, b.least);
    EXPECT_EQ(a.dwell, b.dwell);
  }
  EXPECT_EQ(again.other.transition, models.other.transition);
  EXPECT_EQ(again.other.output, models.other.output);
}

TEST_F(GestureFile, models_that_are_no_probabilities_are_refused) {
  const std::string file = (folder / "models.json").string();
  save_gesture_models(train_gestures(write_set(WriterGroup::training, 3, 1, 1)), file);
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  auto with = [&](const std::string& from, const std::string& to) {
    std::string changed = text.str();
    const size_t at = changed.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    write("models.json", changed.replace(at, from.size(), to));
    return place_of_error(file, [&] { load_gesture_models(file); });
  };
  EXPECT_EQ(with("\"initial\": [\n    1.0", "\"initial\": [\n    0.5"), "/gestures/0/initial");
  EXPECT_EQ(with("\"deviation\": [", "\"deviation\": [ 0,"), "/gestures/0/deviation");
  EXPECT_EQ(with("\"label\"", "\"name\""), "/gestures/0/label");
  EXPECT_EQ(with("\"other\":", "\"another\":"), "/other");
  EXPECT_EQ(with("\"least\": ", "\"least\": -1"), "/gestures/0/least");
}

}  // namespace
}  // namespace wellspring::test
