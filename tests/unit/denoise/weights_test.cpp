// SPDX-License-Identifier: Apache-2.0
#include "denoise/weights.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <random>

#include "base/load_error.h"
#include "tza.h"

namespace wellspring::test {
namespace {

std::string error_of(const std::vector<std::byte>& file) {
  try {
    read_weights(file, "net.tza");
  } catch (const LoadError& error) {
    return error.what();
  }
  return "";
}

TEST(Weights, ReadsHalvesAndFloats) {
  TzaFile file;
  file.add("a.weight", {2, 3, 1, 1}, "oihw", 'h', {0, 1, -2, 0.5f, 65504, 6.1035156e-5f});
  file.add("a.bias", {2}, "x", 'f', {3.25f, -1e-20f});
  Weights weights = read_weights(file.bytes(), "net.tza");
  ASSERT_EQ(weights.size(), 2u);
  EXPECT_EQ(weights["a.weight"].sizes, (std::vector<int>{2, 3, 1, 1}));
  EXPECT_EQ(weights["a.weight"].values, (std::vector<float>{0, 1, -2, 0.5f, 65504, 6.1035156e-5f}));
  EXPECT_EQ(weights["a.bias"].values, (std::vector<float>{3.25f, -1e-20f}));
}

TEST(Weights, ReadsDenormalHalves) {
  TzaFile file;
  file.add_halves("a.bias", {3}, "x", {0x0001, 0x8001, 0x03ff});
  EXPECT_EQ(read_weights(file.bytes(), "net.tza")["a.bias"].values,
            (std::vector<float>{0x1p-24f, -0x1p-24f, 0x1p-14f - 0x1p-24f}));
}

TEST(Weights, RefusesWhatIsWrongAndSaysWhere) {
  TzaFile good;
  good.add("a.bias", {2}, "x", 'f', {1, 2});
  const std::vector<std::byte> bytes = good.bytes();
  EXPECT_EQ(error_of(bytes), "");
  auto with = [&](size_t at, int value) {
    std::vector<std::byte> other = bytes;
    other[at] = std::byte(value);
    return error_of(other);
  };
  const size_t table = good.table_offset(), name = table + 4;
  EXPECT_NE(error_of({}).find("byte 0"), std::string::npos);
  EXPECT_NE(with(0, 0).find("not a file of weights"), std::string::npos);
  EXPECT_NE(with(2, 3).find("version 3"), std::string::npos);
  EXPECT_NE(with(11, 0xff).find("beyond the file's end"), std::string::npos);
  EXPECT_NE(with(table + 3, 0x7f).find("tensors"), std::string::npos);
  EXPECT_NE(with(name + 1, 0x7f).find("ends within its table"), std::string::npos);
  const size_t dimensions = name + 2 + 6;
  EXPECT_NE(with(dimensions, 0).find("0 dimensions"), std::string::npos);
  EXPECT_NE(with(dimensions, 9).find("9 dimensions"), std::string::npos);
  EXPECT_NE(with(dimensions + 4, 0xff).find("size of"), std::string::npos);
  EXPECT_NE(with(dimensions + 5, 'q').find("layout"), std::string::npos);
  EXPECT_NE(with(dimensions + 6, 'd').find("neither of half nor float"), std::string::npos);
  EXPECT_NE(with(dimensions + 7 + 7, 1).find("beyond the file's end"), std::string::npos);
  TzaFile not_finite;
  not_finite.add("a.bias", {2}, "x", 'f', {1, NAN});
  EXPECT_NE(error_of(not_finite.bytes()).find("not finite"), std::string::npos);
  TzaFile twice = good;
  twice.add("a.bias", {2}, "x", 'f', {1, 2});
  EXPECT_NE(error_of(twice.bytes()).find("a second tensor"), std::string::npos);
}

TEST(Weights, SurvivesAnyDamage) {
  TzaFile file;
  file.add("enc_conv0.weight", {4, 9, 3, 3}, "oihw", 'h', std::vector<float>(324, 0.5f));
  file.add("enc_conv0.bias", {4}, "x", 'h', std::vector<float>(4, 0.25f));
  const std::vector<std::byte> good = file.bytes();
  std::mt19937 random(1);
  int refused = 0;
  for (int i = 0; i < 3000; i++) {
    std::vector<std::byte> bad = good;
    if (i % 3 == 0) bad.resize(random() % bad.size());
    else
      for (int k = 0; k < 3; k++) bad[random() % bad.size()] = std::byte(random() & 255);
    std::string error = error_of(bad);
    refused += !error.empty();
    if (!error.empty()) {
      EXPECT_NE(error.find("net.tza"), std::string::npos) << error;
    }
  }
  EXPECT_GT(refused, 1000);
}

TEST(Weights, SaysWhichFileIsMissing) {
  try {
    load_weights("/nowhere/net.tza");
    FAIL();
  } catch (const LoadError& error) {
    EXPECT_EQ(error.file, "/nowhere/net.tza");
  }
}

}  // namespace
}  // namespace wellspring::test
