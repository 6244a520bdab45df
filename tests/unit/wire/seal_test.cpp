// SPDX-License-Identifier: Apache-2.0
#include "wire/tokens.h"

#include <gtest/gtest.h>

#include <barrier>
#include <thread>

#include "base/layers.h"
#include "unit/folder.h"

namespace wellspring::test {
namespace {

TEST(Seal, WhatWasSealedOpensAndNothingElse) {
  const Seal seal, other;
  for (const std::string& text :
       {std::string(), std::string("{\"a\":1}"), std::string("\0\xff\n", 3)}) {
    const std::string sealed = seal.close(text);
    EXPECT_EQ(seal.open(sealed), text);
    EXPECT_FALSE(other.open(sealed)) << "another key";
    EXPECT_EQ(sealed.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz"
                                       "0123456789-_."),
              std::string::npos);
    for (size_t i = 0; i < sealed.size(); i++) {
      std::string changed = sealed;
      changed[i] = changed[i] == 'A' ? 'B' : 'A';
      EXPECT_FALSE(seal.open(changed)) << i;
    }
  }
  for (const char* text : {"", ".", "a", "a.b", "....", "YQ.", ".YQ", "\xff.\xff"})
    EXPECT_FALSE(seal.open(text)) << text;
}

TEST(Seal, TheKeyIsKeptForItsOwnerAlone) {
  test::Folder folder;
  const std::string file = folder.file("new/visits.key");
  const std::string sealed = Seal(file).close("here");
  EXPECT_EQ(Seal(file).open(sealed), "here");
  const auto rights = std::filesystem::status(file).permissions();
  EXPECT_EQ(rights & std::filesystem::perms::all,
            std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
}

TEST(Seal, WhoMakeTheKeyAtTheSameTimeHaveTheSame) {
  test::Folder folder;
  for (int round = 0; round < 100; round++) {
    const std::string file = folder.file("key" + std::to_string(round));
    constexpr int servers = 8;
    std::vector<std::unique_ptr<Seal>> seals(servers);
    std::barrier together(servers);
    {
      std::vector<std::jthread> threads;
      for (auto& seal : seals)
        threads.emplace_back([&] {
          together.arrive_and_wait();
          seal = std::make_unique<Seal>(file);
        });
    }
    const std::string sealed = Seal(file).close("here");
    for (const auto& seal : seals) ASSERT_EQ(seal->open(sealed), "here") << round;
  }
  size_t files = 0;
  for ([[maybe_unused]] const auto& one : std::filesystem::directory_iterator(folder.path)) files++;
  EXPECT_EQ(files, 100u) << "nothing is left beside the keys";
}

TEST(Seal, WithoutAFileThatHoldsAKeyItStillSeals) {
  test::Folder folder;
  const Seal seal(folder.write("short", "abc"));
  EXPECT_EQ(seal.open(seal.close("x")), "x");
  EXPECT_EQ(folder.read("short"), "abc") << "what is there is somebody's";
  const Seal nowhere("/proc/nothing/key");
  EXPECT_EQ(nowhere.open(nowhere.close("x")), "x");
}

TEST(Seal, AnOwnKeyThatWasCutOffIsMadeAnew) {
  test::Folder folder;
  const std::string file = folder.write("visits.key", "half a key");
  const std::string sealed = Seal(file, true).close("here");
  EXPECT_EQ(folder.read("visits.key").size(), 32u);
  EXPECT_EQ(Seal(file).open(sealed), "here") << "the next start has the same";
}

}  // namespace
}  // namespace wellspring::test
