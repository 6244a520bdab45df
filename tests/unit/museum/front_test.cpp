// SPDX-License-Identifier: Apache-2.0
// While exhibits are being loaded.
#include "museum/front.h"

#include <gtest/gtest.h>

namespace wellspring::test {
namespace {

const std::map<std::string, PageFile> pages = {
    {"/", {"text/html; charset=utf-8", "the museum", "\"1\""}},
    {"/opening.html", {"text/html; charset=utf-8", "one moment", "\"2\""}},
    {"/style.css", {"text/css; charset=utf-8", "body {}", "\"3\""}},
};

HttpReply answer_to(const std::string& path, const std::string& accept = "*/*") {
  Front front(pages);
  HttpQuestion question{.method = "GET", .path = path, .accept = accept};
  EXPECT_FALSE(front.answer_later(question, nullptr));
  return front.answer(question);
}

TEST(Front, WhoAsksWhileItLoadsIsToldToComeBack) {
  const HttpReply health = answer_to("/healthz");
  EXPECT_EQ(health.status, 503);
  EXPECT_EQ(health.body, R"({"status":"loading"})");
  for (const char* path : {"/", "/api/v1/exhibits", "/api/v1/exhibits/castle/still.jpg", "/no"}) {
    const HttpReply reply = answer_to(path);
    EXPECT_EQ(reply.status, 503) << path;
    EXPECT_TRUE(reply.headers.contains("Retry-After")) << path;
    EXPECT_NE(reply.body.find("loading"), std::string::npos) << path;
  }
  const HttpReply page = answer_to("/e/castle", "text/html,*/*");
  EXPECT_EQ(page.status, 503) << "or browsers would keep it";
  EXPECT_EQ(page.body, "one moment");
  EXPECT_EQ(answer_to("/style.css").body, "body {}");
}

TEST(Front, PeersWaitWithWhatTheyHaveSaid) {
  Front front(pages);
  auto link = std::make_shared<Link>(1, LinkKind::visit, "test");
  link->push_text_in("hello");
  front.join(link);
  std::string reason;
  EXPECT_FALSE(link->close_requested(reason));
  EXPECT_EQ(link->first_heard()->text, "hello");
}

}  // namespace
}  // namespace wellspring::test
