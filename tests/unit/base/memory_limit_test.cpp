// SPDX-License-Identifier: Apache-2.0
#include "base/memory.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "unit/folder.h"

namespace wellspring::test {
namespace {

TEST(MemoryLimit, IsTheLeastOfAllGroupsThatHoldTheProcess) {
  const test::Folder folder;
  const std::string root = folder.path.string();
  std::filesystem::create_directories(root + "/system.slice/a.service");
  const auto bound = [&](const std::string& group, const std::string& text) {
    std::ofstream(root + group + "/memory.max") << text << "\n";
  };
  const std::string member = "0::/system.slice/a.service\n";
  EXPECT_EQ(memory_bound(member, root), 0);
  bound("/system.slice/a.service", "max");
  EXPECT_EQ(memory_bound(member, root), 0);
  bound("/system.slice", "4294967296");
  EXPECT_EQ(memory_bound(member, root), 4294967296.0);
  bound("/system.slice/a.service", "1000");
  EXPECT_EQ(memory_bound(member, root), 1000);
  EXPECT_EQ(memory_bound("5:memory:/system.slice\n", root), 0);
  EXPECT_GT(usable_memory(), 1e6);
}

}  // namespace
}  // namespace wellspring::test
