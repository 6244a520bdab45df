// SPDX-License-Identifier: Apache-2.0
#include "museum/upkeep.h"

#include <gtest/gtest.h>

#include "base/layers.h"
#include "unit/folder.h"

namespace wellspring::test {
namespace {

TEST(Disks, OnlyOnesWithoutRoomAreFull) {
  const test::Folder folder;
  EXPECT_TRUE(Disks(folder.file("a/b/cache"), "").full().empty()) << "not there yet";
  // Some systems have such a disk without a free byte.
  if (std::filesystem::exists("/proc/self") && std::filesystem::space("/proc/self").available == 0)
    EXPECT_EQ(Disks("", "/proc/self").full(), std::vector<std::string>{"/proc/self"});
}

}  // namespace
}  // namespace wellspring::test
