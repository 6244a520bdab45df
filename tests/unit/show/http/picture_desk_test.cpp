// SPDX-License-Identifier: Apache-2.0
#include "show/http/picture_desk.h"

#include <gtest/gtest.h>

#include <condition_variable>
#include <mutex>
#include <optional>

#include "show/exhibit/exhibit_collection.h"

namespace wellspring::test {
namespace {

// Nobody listens there.
constexpr const char* nobody = "http://127.0.0.1:1/picture.jpg";

TEST(PictureDesk, PathsNameARecord) {
  EXPECT_EQ(read_picture_path("/collection/pictures/12"), 12u);
  for (const char* path : {"/collection/pictures/", "/collection/pictures/-1",
                           "/collection/pictures/1x", "/collection/pictures/1/2",
                           "/collection/pictures/99999999999999999999999", "/collection", ""})
    EXPECT_FALSE(read_picture_path(path)) << path;
}

TEST(PictureDesk, OnlyHostsThatAreAllowedAreAsked) {
  Exhibit exhibit;
  EXPECT_EQ(collection_picture(exhibit, 0), "");
  auto made = std::make_shared<ExhibitCollection>();
  for (const char* picture : {"https://good.example/1.jpg", "https://other.example/1.jpg", ""})
    made->collection.records.all.emplace_back().picture = picture;
  exhibit.collection = made;
  exhibit.allowed_hosts = {"good.example"};
  EXPECT_EQ(collection_picture(exhibit, 0), "https://good.example/1.jpg");
  for (const size_t record : {1, 2, 3}) EXPECT_EQ(collection_picture(exhibit, record), "");
}

TEST(PictureDesk, AMuseumThatDoesNotAnswerIsTold) {
  PictureDesk desk;
  std::mutex mutex;
  std::condition_variable came;
  std::optional<HttpReply> reply;
  desk.ask(nobody, {"127.0.0.1:1"}, std::make_shared<HttpAsker>([&](HttpReply made) {
             std::lock_guard lock(mutex);
             reply = std::move(made);
             came.notify_all();
           }));
  std::unique_lock lock(mutex);
  came.wait(lock, [&] { return reply.has_value(); });
  EXPECT_EQ(reply->status, 502);
  EXPECT_EQ(reply->headers["Cache-Control"], "no-store");
}

}  // namespace
}  // namespace wellspring::test
