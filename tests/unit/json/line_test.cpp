// SPDX-License-Identifier: Apache-2.0
#include "json/text.h"

#include <gtest/gtest.h>

namespace wellspring::test {
namespace {

TEST(JsonLine, IsWhereTheNameOfAValueStands) {
  const std::string text =
      "{\n\"a\": 1,\n\"list\": [7,\n 8\n,\n{\"b\":\n\n[true, {\"c\": null}]}],\n\"a\":\n2}\n";
  const std::pair<const char*, int> places[] = {
      {"", 1},        {"/list", 3},     {"/list/0", 3},     {"/list/1", 4},
      {"/list/2", 6}, {"/list/2/b", 6}, {"/list/2/b/0", 8}, {"/list/2/b/1/c", 8},
      {"/a", 9},      {"/list/3", 0},   {"/b", 0}};
  for (const auto& [place, line] : places) EXPECT_EQ(find_json_line(text, place), line) << place;
}

TEST(JsonLine, OfWhatIsNoJsonIsUnknown) {
  for (const char* text : {"", "{", "[1,", "\xff"}) EXPECT_EQ(find_json_line(text, "/a"), 0);
}

}  // namespace
}  // namespace wellspring::test
