// SPDX-License-Identifier: Apache-2.0
#include "show/http/map_desk.h"

#include <gtest/gtest.h>

#include <condition_variable>
#include <mutex>
#include <nlohmann/json.hpp>

namespace wellspring::test {
namespace {

using nlohmann::json;

Exhibit make_exhibit() {
  Exhibit exhibit;
  exhibit.points.emplace_back().id = "chair";
  Records records;
  for (const char* name : {"wood", "silver", "bird", "tree"})
    records.terms.push_back({TermKind::material, name});
  for (int i = 0; i < 200; i++) {
    Record& record = records.all.emplace_back();
    record.id = record.title = std::to_string(i);
    record.year = 1500 + i;
    record.terms = {uint32_t(i % 2), uint32_t(2 + i / 2 % 2)};
    record.palette = {{dvec3(50, i % 7, 0), 1, "#707070"}};
  }
  auto made = std::make_shared<ExhibitCollection>();
  made->title["en"] = "All";
  made->collection = make_collection(std::move(records));
  for (int i = 0; i < 200; i++) made->points[i] = 0;
  exhibit.collection = std::move(made);
  return exhibit;
}

HttpReply ask(MapDesk& desk, const Exhibit& exhibit,
              const std::map<std::string, std::string>& query) {
  std::mutex mutex;
  std::condition_variable came;
  std::optional<HttpReply> reply;
  const MapQuestion question = read_map_question(query);
  EXPECT_EQ(question.problem, "");
  desk.ask(exhibit, question, std::make_shared<HttpAsker>([&](HttpReply made) {
             std::lock_guard lock(mutex);
             reply = std::move(made);
             came.notify_all();
           }));
  std::unique_lock lock(mutex);
  came.wait(lock, [&] { return reply.has_value(); });
  return *reply;
}

TEST(MapDesk, AMapIsToldAndAStepFromIt) {
  const Exhibit exhibit = make_exhibit();
  MapDesk desk;
  const json first = json::parse(ask(desk, exhibit, {{"shown", "50"}}).body);
  EXPECT_EQ(first["title"]["en"], "All");
  EXPECT_EQ(first["objects"], 200);
  EXPECT_EQ(first["region"], 200);
  ASSERT_EQ(first["items"].size(), 50u);
  EXPECT_EQ(first["items"][0]["object"], "chair");
  EXPECT_EQ(first["items"][0]["colors"], json({"#707070"}));
  EXPECT_GE(first["clusters"].size(), 2u);
  const std::string pivot = std::to_string(first["items"][7]["index"].get<int>());
  const std::map<std::string, std::string> step = {{"shown", "50"}, {"trail", pivot + "@0.8"}};
  const HttpReply next = ask(desk, exhibit, step);
  EXPECT_LT(json::parse(next.body)["region"], 200);
  EXPECT_EQ(ask(desk, exhibit, step).body, next.body);
  const json chosen = json::parse(ask(desk, exhibit, {{"shown", "50"}, {"trail", "c0"}}).body);
  EXPECT_LT(chosen["region"], 200);
}

TEST(MapDesk, AMapThatIsMadeBeforeIsTheOneThatIsAskedFor) {
  const Exhibit exhibit = make_exhibit();
  MapDesk idle, prepared;
  prepared.prepare(Exhibit());
  prepared.prepare(exhibit);
  EXPECT_EQ(ask(prepared, exhibit, {}).body, ask(idle, exhibit, {}).body);
}

TEST(MapDesk, WrongQuestionsAreRefused) {
  for (const auto& [name, value] : std::map<std::string, std::string>{
           {"trail", "12"}, {"shown", "1"}, {"shown", "1501"}, {"shown", "x"}, {"zoom", "2"}})
    EXPECT_NE(read_map_question({{name, value}}).problem, "") << name << value;
  const Exhibit exhibit = make_exhibit();
  MapDesk desk;
  EXPECT_EQ(ask(desk, exhibit, {{"trail", "9999@1"}}).status, 404);
  EXPECT_EQ(ask(desk, exhibit, {{"trail", "c77"}}).status, 404);
}

}  // namespace
}  // namespace wellspring::test
