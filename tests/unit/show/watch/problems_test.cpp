// SPDX-License-Identifier: Apache-2.0
// Mistakes in a watched exhibit's files: told to those who are there and to those who come, and
// taken back.
#include "show/watch/rehearsal.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <atomic>
#include <chrono>
#include <thread>

#include "show/http/report.h"
#include "unit/folder.h"
#include "unit/show/show_stage.h"

namespace wellspring::test {
namespace {

struct Problems : testing::Test, ShowStage {
  void SetUp() override { begin(make_tiny_exhibit(), settings_for("direct")); }
};

TEST_F(Problems, AreToldToAllAndTakenBack) {
  const size_t first = join(32, 32);
  set_problems(show->stage, show->visits, {});
  run(0.1);
  EXPECT_EQ(told("problems", first).size(), 0u) << "nothing was ever wrong";
  set_problems(show->stage, show->visits,
               {{"exhibit.json", "/start", "there is no viewpoint 'dor'"}});
  set_problems(show->stage, show->visits,
               {{"exhibit.json", "/start", "there is no viewpoint 'dor'"}});
  run(0.1);
  ASSERT_EQ(told("problems", first).size(), 1u);
  EXPECT_EQ(
      last("problems", first)["list"][0],
      (nlohmann::json{
          {"file", "exhibit.json"}, {"where", "/start"}, {"what", "there is no viewpoint 'dor'"}}));
  const size_t second = join(32, 32);
  run(0.1);
  EXPECT_EQ(last("problems", second)["list"].size(), 1u);
  EXPECT_EQ(make_report(*show).exhibit_problems, 1u);
  set_problems(show->stage, show->visits, {});
  run(0.1);
  EXPECT_EQ(last("problems", first)["list"].size(), 0u);
  EXPECT_EQ(make_report(*show).exhibit_problems, 0u);
}

TEST_F(Problems, OnlyAWatchedExhibitSaysSoInItsWelcome) {
  const size_t visitor = join(32, 32);
  run(0.1);
  ASSERT_FALSE(last("welcome", visitor).is_null());
  EXPECT_FALSE(last("welcome", visitor).contains("watched"));
  show->settings.watched = true;
  const size_t curator = join(32, 32);
  run(0.1);
  EXPECT_EQ(last("welcome", curator)["watched"], true);
}

TEST(Rehearsal, HandsOverAShowOrItsProblems) {
  test::Folder folder;
  folder.write("exhibit.json", "1");
  std::atomic<int> made = 0;
  auto make = [&]() -> std::unique_ptr<Show> {
    if (made++ == 0)
      throw ExhibitError({{folder.file("exhibit.json"), "line 1", "is wrong"},
                          {folder.file("exhibit.json"), "line 2", "is worth a note", false}});
    return std::make_unique<Show>();
  };
  Rehearsal rehearsal(folder.path.string(), make, true);
  auto wait = [&] {
    std::optional<Rehearsal::Outcome> outcome;
    for (int i = 0; i < 400 && !(outcome = rehearsal.take()); i++)
      std::this_thread::sleep_for(std::chrono::milliseconds(25));
    return outcome;
  };
  folder.write("exhibit.json", "12");
  auto outcome = wait();
  ASSERT_TRUE(outcome);
  EXPECT_FALSE(outcome->show);
  ASSERT_EQ(outcome->problems.size(), 2u) << "a note beside a fault may say what was meant";
  EXPECT_EQ(to_string(outcome->problems[0]), "exhibit.json: line 1: is wrong");
  EXPECT_EQ(to_string(outcome->problems[1]), "exhibit.json: line 2: is worth a note");
  folder.write("exhibit.json", "123");
  outcome = wait();
  ASSERT_TRUE(outcome);
  EXPECT_TRUE(outcome->show);
  EXPECT_TRUE(outcome->problems.empty());
  EXPECT_EQ(made, 2);
}

}  // namespace
}  // namespace wellspring::test
