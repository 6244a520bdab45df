// SPDX-License-Identifier: Apache-2.0
// Every file of the corpus goes through its target again, whole, cut off and with bytes changed: so
// what was found once is not found twice, on builds without Clang, too.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "base/rng.h"
#include "fuzz/targets.h"

namespace wellspring::fuzz {
namespace {

struct Corpus : testing::TestWithParam<Target> {};

std::vector<std::filesystem::path> files_of(const std::string& target) {
  std::vector<std::filesystem::path> files;
  const auto folder = std::filesystem::path(WELLSPRING_SOURCE) / "tests/fuzz/corpus" / target;
  if (std::filesystem::is_directory(folder))
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

std::vector<uint8_t> read(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST_P(Corpus, IsReadAgain) {
  const Target& target = GetParam();
  const auto files = files_of(target.name);
  ASSERT_FALSE(files.empty()) << "every target has seeds";
  for (const auto& file : files) {
    SCOPED_TRACE(file.string());
    const std::vector<uint8_t> bytes = read(file);
    EXPECT_NO_THROW(target.run(bytes));
    for (uint64_t i = 0; i < 8 && !bytes.empty(); i++) {
      const uint64_t random = mix64(bytes.size() * 8 + i);
      EXPECT_NO_THROW(target.run(Bytes(bytes).first(random % bytes.size()))) << "cut " << i;
      std::vector<uint8_t> changed = bytes;
      changed[random % bytes.size()] ^= uint8_t(1 + (random >> 32) % 255);
      EXPECT_NO_THROW(target.run(changed)) << "changed " << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Fuzz, Corpus, testing::ValuesIn(targets),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace wellspring::fuzz
