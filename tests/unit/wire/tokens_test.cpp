// SPDX-License-Identifier: Apache-2.0
// Tokens out of files and the environment, and who has one.
#include "wire/tokens.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>

#include "base/load_error.h"
#include "unit/folder.h"

namespace wellspring::test {
namespace {

const char* variable = "WELLSPRING_TEST_TOKEN";

struct Tokens : testing::Test {
  test::Folder folder;
  std::string file = folder.file("tokens");
  void write(const std::string& text) { folder.write("tokens", text); }
  // Names and secrets, a line each.
  std::string read() {
    std::string all;
    for (const Token& one : read_tokens(file, variable)) all += one.name + "=" + one.secret + "\n";
    return all;
  }
  std::string problem() {
    try {
      read_tokens(file, variable);
    } catch (const LoadError& error) {
      return error.what();
    }
    return "";
  }
};

TEST_F(Tokens, AFileHasOneForAllOrOneForEachKiosk) {
  write(
      "# the house's\n\n  0123456789abcdef \r\nhall 0123456789abcdef0\nhall "
      "left\tfedcba9876543210");
  EXPECT_EQ(read(), "=0123456789abcdef\nhall=0123456789abcdef0\nhall left=fedcba9876543210\n");
}

TEST_F(Tokens, WhatIsWrongIsNamedWithoutTheToken) {
  EXPECT_EQ(problem(), file + ": cannot be read");
  write("# nothing\n");
  EXPECT_EQ(problem(), file + ": holds no token");
  write("0123456789abcdef\nhall secret\n");
  EXPECT_EQ(problem(), file + ": line 2: a token has at least 16 characters");
  write("hall 0123456789abcdef\nyard 0123456789abcdef\n");
  EXPECT_EQ(problem(), file + ": line 2: this token is there already");
  write("hall 0123456789abcdef\n");
  EXPECT_THROW(read_token(file, variable), LoadError) << "the house's own has no name";
  write(
      "0123456789\x01"
      "abcdef\n");
  EXPECT_EQ(problem(), file + ": line 1: a token has no control characters");
  file.clear();
  setenv(variable, "too short", 1);
  EXPECT_EQ(problem(), std::string(variable) + ": a token has at least 16 characters");
}

TEST_F(Tokens, TheEnvironmentIsWipedAndAFileWins) {
  setenv(variable, "one with spaces, long enough", 1);
  const char* value = getenv(variable);
  EXPECT_EQ(read_token("", variable), "one with spaces, long enough");
  EXPECT_EQ(getenv(variable), nullptr);
  EXPECT_EQ(std::strlen(value), 0u) << "as /proc/self/environ would still show it";
  EXPECT_EQ(read_token("", variable), "") << "without any there is none";
  write("0123456789abcdef\n");
  setenv(variable, "another that is not used", 1);
  EXPECT_EQ(read_token(file, variable), "0123456789abcdef");
  EXPECT_EQ(getenv(variable), nullptr);
}

TEST(Token, OnlyTheWholeOfItIsOne) {
  const std::vector<Token> tokens = {{"hall", "0123456789abcdef"}, {"yard", "0123456789abcdeg"}};
  ASSERT_TRUE(find_token(tokens, "0123456789abcdef"));
  EXPECT_EQ(find_token(tokens, "0123456789abcdef")->name, "hall");
  EXPECT_EQ(find_token(tokens, "0123456789abcdeg")->name, "yard");
  for (const char* wrong : {"", "0", "0123456789abcde", "0123456789abcdeff", "0123456789ABCDEF",
                            "hall 0123456789abcdef"})
    EXPECT_FALSE(find_token(tokens, wrong)) << wrong;
  EXPECT_FALSE(find_token({}, "0123456789abcdef"));
  EXPECT_FALSE(is_token("", "")) << "where there is none, nobody has it";
}

TEST(Token, ComesByBearer) {
  EXPECT_EQ(bearer_of("Bearer abc"), "abc");
  EXPECT_EQ(bearer_of("bEARER a b"), "a b");
  for (const char* none : {"", "Bearer", "Bearer ", "Basic abc", "abc", "Bearerabc"})
    EXPECT_EQ(bearer_of(none), "") << none;
}

}  // namespace
}  // namespace wellspring::test
