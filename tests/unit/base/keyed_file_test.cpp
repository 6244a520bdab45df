// SPDX-License-Identifier: Apache-2.0
#include "base/write_file.h"

#include <gtest/gtest.h>

#include "unit/folder.h"

namespace wellspring::test {
namespace {

constexpr uint64_t format = 0x1234, key = 4711;

struct KeyedFiles : testing::Test {
  test::Folder folder;
  std::string file = folder.file("deep/kept"), bytes = "before";
  KeyedFile read(uint64_t wanted = key) { return read_keyed(file, format, wanted, bytes); }
};

TEST_F(KeyedFiles, GiveBackWhatWasWritten) {
  for (const std::string& content :
       {std::string(), std::string("x"), std::string(1003, 'y'), std::string("\0\xff\n\r", 4)}) {
    ASSERT_TRUE(write_keyed(file, format, key, content));
    EXPECT_EQ(read(), KeyedFile::read);
    EXPECT_EQ(bytes, content);
    EXPECT_EQ(read(any_key), KeyedFile::read);
  }
}

TEST_F(KeyedFiles, SayWhyTheyAreNotRead) {
  EXPECT_EQ(read(), KeyedFile::missing);
  ASSERT_TRUE(write_keyed(file, format, key, "content"));
  EXPECT_EQ(read(key + 1), KeyedFile::another_key);
  EXPECT_EQ(read_keyed(file, format + 1, key, bytes), KeyedFile::damaged);
  EXPECT_EQ(bytes, "before");
  file = folder.path.string();
  EXPECT_NE(read(), KeyedFile::read) << "a folder";
}

TEST_F(KeyedFiles, CannotBeWrittenWhereAFileIsInTheWay) {
  folder.write("deep", "a file");
  EXPECT_FALSE(write_keyed(file, format, key, "content"));
}

TEST_F(KeyedFiles, AreReplacedAsAWhole) {
  ASSERT_TRUE(write_keyed(file, format, key, std::string(100, 'a')));
  ASSERT_TRUE(write_keyed(file, format, key + 1, "b"));
  EXPECT_EQ(read(), KeyedFile::another_key);
  EXPECT_EQ(read(key + 1), KeyedFile::read);
  EXPECT_EQ(bytes, "b");
}

TEST_F(KeyedFiles, EveryDamagedByteIsNoticed) {
  ASSERT_TRUE(write_keyed(file, format, key, "thirteen byte"));
  const std::string whole = folder.read("deep/kept");
  ASSERT_EQ(whole.size(), 24u + 13);
  for (size_t i = 0; i < whole.size(); i++)
    for (int bit : {0, 7}) {
      std::string damaged = whole;
      damaged[i] = char(damaged[i] ^ (1 << bit));
      folder.write("deep/kept", damaged);
      const bool in_key = i >= 8 && i < 16;
      EXPECT_EQ(read(), in_key ? KeyedFile::another_key : KeyedFile::damaged) << i;
    }
  EXPECT_EQ(bytes, "before");
}

TEST_F(KeyedFiles, EveryOtherLengthIsNoticed) {
  ASSERT_TRUE(write_keyed(file, format, key, std::string(13, '\0')));
  const std::string whole = folder.read("deep/kept");
  for (size_t size = 0; size < whole.size() + 9; size++) {
    if (size == whole.size()) continue;
    std::string other = whole;
    other.resize(size);  // with zeros
    folder.write("deep/kept", other);
    EXPECT_EQ(read(), KeyedFile::damaged) << size;
  }
}

TEST(KeyedFileFields, AreReadInTheOrderTheyWereWritten) {
  PutBytes put;
  put.value(7);
  put.array(std::vector<double>{1, 2, 3});
  put.array(std::vector<uint8_t>{});
  put.value(uint8_t(9));
  TakeBytes take{put.bytes};
  int number = 0;
  uint8_t last = 0;
  std::vector<double> numbers;
  std::vector<uint8_t> none{1};
  take.value(number), take.array(numbers), take.array(none);
  EXPECT_FALSE(take.complete());
  take.value(last);
  EXPECT_TRUE(take.complete());
  EXPECT_EQ(number, 7);
  EXPECT_EQ(numbers, (std::vector<double>{1, 2, 3}));
  EXPECT_TRUE(none.empty());
  EXPECT_EQ(last, 9);
  take.value(number);  // beyond the end
  EXPECT_FALSE(take.good);
}

// A length that the bytes do not hold takes no memory.
TEST(KeyedFileFields, ALengthThatIsALieIsNotBelieved) {
  for (uint64_t count : {uint64_t(2), uint64_t(1) << 27, uint64_t(1) << 60, ~uint64_t(0)}) {
    PutBytes put;
    put.value(count);
    put.value(1.0);
    TakeBytes take{put.bytes};
    std::vector<double> numbers;
    take.array(numbers);
    EXPECT_FALSE(take.good) << count;
    EXPECT_TRUE(numbers.empty());
  }
}

TEST(KeyedFile, ADamagedOneIsNamedOnceAndOneOfAnotherFormatIsNot) {
  const test::Folder folder;
  const std::string file = folder.file("light.grid"), other = folder.file("other.grid");
  ASSERT_TRUE(write_keyed(file, 1, 2, "some light"));
  ASSERT_TRUE(write_keyed(other, 7, 2, "some light"));
  std::string bytes = folder.read("light.grid");
  bytes.back() ^= 1;
  folder.write("light.grid", bytes);
  const size_t before = damaged_files().size();
  for (int i = 0; i < 2; i++) EXPECT_EQ(read_keyed(file, 1, 2, bytes), KeyedFile::damaged);
  EXPECT_EQ(read_keyed(other, 1, 2, bytes), KeyedFile::damaged);
  ASSERT_EQ(damaged_files().size(), before + 1);
  EXPECT_EQ(damaged_files().back(), file);
}

}  // namespace
}  // namespace wellspring::test
