// SPDX-License-Identifier: Apache-2.0
#include "base/write_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <unistd.h>

#include <chrono>

#include "unit/folder.h"

namespace wellspring::test {
namespace {

TEST(WriteFile, WhatWasLeftUnfinishedIsTakenAwayUnlessSomebodyWritesIt) {
  const test::Folder folder;
  std::filesystem::create_directories(folder.path / "speech");
  const auto put = [&](const std::string& name, bool old = true) {
    folder.write(name, "1234567890");
    if (old)
      std::filesystem::last_write_time(
          folder.path / name,
          std::filesystem::file_time_type::clock::now() - std::chrono::hours(1));
  };
  for (const char* left : {"castle.bake.part77-0", "speech/a.wav.part1-12"}) put(left);
  const std::vector<std::string> stay = {"castle.bake", "castle.partners", "a.part",
                                         "b.part7",     "c.part7-x",       ".part7-1"};
  for (const std::string& name : stay) put(name);
  put("new.bake.part77-1", false);
  put("locked.bake.part77-2");
  const int writer = open(folder.file("locked.bake.part77-2").c_str(), O_RDWR | O_CLOEXEC);
  ASSERT_EQ(flock(writer, LOCK_EX), 0);
  const Unfinished removed = remove_unfinished(folder.path.string());
  EXPECT_EQ(removed.files, 2u);
  EXPECT_EQ(removed.bytes, 20u);
  for (const std::string& name : stay) EXPECT_TRUE(std::filesystem::exists(folder.path / name));
  EXPECT_TRUE(std::filesystem::exists(folder.path / "new.bake.part77-1"));
  EXPECT_TRUE(std::filesystem::exists(folder.path / "locked.bake.part77-2"));
  close(writer);
  EXPECT_EQ(remove_unfinished(folder.path.string()).files, 1u);
  EXPECT_EQ(remove_unfinished(folder.file("nowhere")).files, 0u);
}

}  // namespace
}  // namespace wellspring::test
