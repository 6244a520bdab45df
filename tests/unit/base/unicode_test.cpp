// SPDX-License-Identifier: Apache-2.0
#include "base/unicode.h"

#include <gtest/gtest.h>

namespace wellspring::test {
namespace {

TEST(Unicode, AccentsThatStandApartJoinTheirLetters) {
  EXPECT_EQ(nfc("e\u0301"), "\u00e9");
  EXPECT_EQ(nfc("\u00e9"), "\u00e9");
  EXPECT_EQ(nfc("a\u0323\u0307"), nfc("a\u0307\u0323"));  // their order does not matter
  EXPECT_EQ(nfc("\u1112\u1161\u11ab"), "\ud55c");         // Hangul
  EXPECT_NE(nfc("\ufb01"), "fi");                         // compatibility is another form
}

TEST(Unicode, OtherTextStaysAsItIs) {
  EXPECT_EQ(nfc("plain text"), "plain text");
  EXPECT_EQ(nfc(""), "");
  EXPECT_EQ(nfc("\xff\xfe e"), "\xff\xfe e");  // no UTF-8
}

}  // namespace
}  // namespace wellspring::test
