// SPDX-License-Identifier: Apache-2.0
#include "show/http/pages.h"

#include <gtest/gtest.h>

#include <set>

#include "unit/show/tiny_exhibit.h"

namespace wellspring::test {
namespace {

HttpReply take_along(const std::string& address, std::map<std::string, std::string> query = {}) {
  HttpQuestion question{.query = std::move(query)};
  return answer_qr(make_tiny_exhibit(), address, question);
}

TEST(TakeAlong, TheCodeIsThatOfTheAddressTheStoryAndTheLanguage) {
  const HttpReply reply = take_along("https://m.example", {{"story", "tale"}, {"lang", "sk"}});
  EXPECT_EQ(reply.status, 200);
  EXPECT_EQ(reply.content_type, "image/svg+xml");
  EXPECT_EQ(reply.body, draw_qr_code("https://m.example/e/tiny?story=tale&lang=sk"));
  EXPECT_EQ(take_along("https://m.example", {{"lang", "a&b\"<"}}).body,
            draw_qr_code("https://m.example/e/tiny?lang=a%26b%22%3C"));
  EXPECT_EQ(take_along("https://m.example").body, draw_qr_code("https://m.example/e/tiny"));
}

TEST(TakeAlong, NoAddressOrNoSuchStoryIsNotFound) {
  EXPECT_EQ(take_along("").status, 404);
  EXPECT_NE(take_along("").body.find("no_address"), std::string::npos);
  EXPECT_EQ(take_along("https://m.example", {{"story", "nothing\""}}).status, 404);
}

// Three finder patterns, and a quiet zone all round.
TEST(TakeAlong, ThePictureIsAQrCode) {
  const std::string svg = draw_qr_code("https://m.example/e/tiny?story=tale&lang=sk");
  int side = 0;
  ASSERT_EQ(
      sscanf(svg.c_str(), "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %d", &side), 1);
  EXPECT_EQ((side - 8 - 17) % 4, 0) << "a version's size";
  std::set<std::pair<int, int>> black;
  for (size_t at = svg.find('M', svg.find("<path d=")); at != std::string::npos;
       at = svg.find('M', at + 1)) {
    int x = 0, y = 0;
    ASSERT_EQ(sscanf(svg.c_str() + at, "M%d,%dh1v1h-1z", &x, &y), 2);
    EXPECT_TRUE(x >= 4 && y >= 4 && x < side - 4 && y < side - 4);
    black.insert({x - 4, y - 4});
  }
  const int code = side - 8;
  for (auto [left, top] : {std::pair(0, 0), std::pair(code - 7, 0), std::pair(0, code - 7)})
    for (int y = 0; y < 7; y++)
      for (int x = 0; x < 7; x++) {
        const int ring = std::max(std::abs(x - 3), std::abs(y - 3));
        EXPECT_EQ(black.contains({left + x, top + y}), ring != 2) << left << " " << top;
      }
  EXPECT_THROW(draw_qr_code(std::string(5000, 'x')), std::length_error);
}

}  // namespace
}  // namespace wellspring::test
