// SPDX-License-Identifier: Apache-2.0
// What pages are told of the book and the sounds, and which files they are given.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "show/http/answer.h"
#include "unit/folder.h"
#include "unit/show/show_stage.h"

using namespace wellspring;

using namespace wellspring::test;

namespace {

using nlohmann::json;

Exhibit make_exhibit(const test::Folder& folder) {
  Exhibit exhibit = make_tiny_exhibit();
  BookPage topic;
  topic.id = "well";
  topic.title = {{"en", "The well"}, {"de", "Der Brunnen"}};
  topic.text = {{{"en", "Deep."}}, {{"en", "Old."}}};
  topic.image = "book/well.jpg";
  topic.alt = {{"en", "A well"}};
  BookPage partner;
  partner.id = "guild";
  partner.link = "https://example.org";
  BookPresentation presentation{"p", {{"en", "P"}}, {}};
  presentation.slides.resize(2);
  presentation.slides[0].video = "book/walk.webm";
  presentation.slides[1].text = {{"en", "Words"}};
  presentation.slides[1].seconds = 7;
  exhibit.book = Book{{topic}, {partner}, {presentation}};
  exhibit.sounds = {{"fire", "fire", "", dvec3(1, 2, 3), 0.5, 6}, {"hum", "", "hum.ogg", {}, 1, 8}};
  std::string path = folder.write("well.jpg", "0123456789");
  auto changed = std::filesystem::last_write_time(path).time_since_epoch().count();
  exhibit.files["book/well.jpg"] = {path, "image/jpeg", 10, int64_t(changed), "\"tag\""};
  folder.write("secret.txt", "not named by the book");
  return exhibit;
}

struct Desk {
  test::Folder folder;
  Exhibit exhibit = make_exhibit(folder);
  std::map<std::string, PageFile> pages;
  ReportBoard board;
  HttpReply ask(const std::string& path) {
    AnswerSources sources;
    sources.exhibits = {{&exhibit, &board, {}, nullptr}};
    sources.pages = &pages;
    return answer(sources, {"GET", path, {}, "", "", ""});
  }
};

}  // namespace

TEST(Book, IsDescribedWithAddresses) {
  Desk desk;
  json book = json::parse(desk.ask("/api/v1/exhibits/tiny").body)["book"];
  EXPECT_EQ(book["topics"], json::parse(R"([{"id": "well",
      "title": {"en": "The well", "de": "Der Brunnen"}, "text": [{"en": "Deep."}, {"en": "Old."}],
      "image": "/api/v1/exhibits/tiny/files/book/well.jpg", "alt": {"en": "A well"}}])"));
  EXPECT_EQ(book["partners"][0]["link"], "https://example.org");
  EXPECT_FALSE(book["partners"][0].contains("image"));
  EXPECT_EQ(book["presentations"][0]["slides"], json::parse(R"([
      {"video": "/api/v1/exhibits/tiny/files/book/walk.webm", "seconds": 10},
      {"text": {"en": "Words"}, "seconds": 7}])"));
  desk.exhibit.book.reset();
  EXPECT_TRUE(json::parse(desk.ask("/api/v1/exhibits/tiny").body).at("book").is_null());
}

TEST(Book, OnlyFilesThatItNamesAreGiven) {
  Desk desk;
  const std::string files = "/api/v1/exhibits/tiny/files/";
  HttpReply reply = desk.ask(files + "book/well.jpg");
  EXPECT_EQ(reply.status, 200);
  EXPECT_EQ(reply.content_type, "image/jpeg");
  EXPECT_EQ(reply.headers["ETag"], "\"tag\"");
  ASSERT_TRUE(reply.file);
  EXPECT_EQ(reply.file->path, desk.folder.file("well.jpg"));
  EXPECT_EQ(reply.file->begin, 0u);
  EXPECT_EQ(reply.file->size, 10u);
  for (const char* name :
       {"", "well.jpg", "secret.txt", "book/../secret.txt", "../secret.txt", "/etc/passwd",
        "book/well.jpg/", "book//well.jpg", "./book/well.jpg", "exhibit.json", "book"}) {
    HttpReply refusal = desk.ask(files + name);
    EXPECT_EQ(refusal.status, 404) << name;
    EXPECT_FALSE(refusal.file) << name;
  }
  EXPECT_EQ(desk.ask("/api/v1/exhibits/other/files/book/well.jpg").status, 404);
}

TEST(Book, AFileThatHasChangedIsNotGiven) {
  Desk desk;
  const std::string path = "/api/v1/exhibits/tiny/files/book/well.jpg";
  auto then = std::filesystem::last_write_time(desk.folder.file("well.jpg"));
  desk.folder.write("well.jpg", "9876543210");
  std::filesystem::last_write_time(desk.folder.file("well.jpg"), then + std::chrono::seconds(2));
  EXPECT_EQ(desk.ask(path).status, 404);
  std::filesystem::last_write_time(desk.folder.file("well.jpg"), then);
  EXPECT_EQ(desk.ask(path).status, 200);
  desk.folder.write("well.jpg", "longer than it was");
  std::filesystem::last_write_time(desk.folder.file("well.jpg"), then);
  EXPECT_EQ(desk.ask(path).status, 404);
  std::filesystem::remove(desk.folder.file("well.jpg"));
  EXPECT_EQ(desk.ask(path).status, 404);
}

TEST(Book, WelcomeNamesTheSounds) {
  test::Folder folder;
  ShowStage stage;
  stage.begin(make_exhibit(folder), settings_for("gather"));
  stage.join(64, 48);
  stage.steps(2);
  json sounds;
  for (const std::string& text : stage.browsers[0].texts)
    if (json message = json::parse(text); message["type"] == "welcome") sounds = message["sounds"];
  EXPECT_EQ(sounds, json::parse(R"([
      {"id": "fire", "kind": "fire", "position": [1, 2, 3], "gain": 0.5, "radius": 6},
      {"id": "hum", "file": "/api/v1/exhibits/tiny/files/hum.ogg", "gain": 1, "radius": 8}])"));
}
