// SPDX-License-Identifier: Apache-2.0
// Changes of a folder's files, told once and only when they lie still.
#include "show/watch/rehearsal.h"

#include <gtest/gtest.h>

#include "base/layers.h"
#include "unit/folder.h"

namespace wellspring::test {
namespace {

TEST(FolderWatch, TellsAChangeOnceWhenTheFilesAreStill) {
  test::Folder folder;
  std::filesystem::create_directory(folder.path / "stories");
  folder.write("stories/well.en.story", "One.");
  FolderWatch watch(folder.path.string());
  EXPECT_FALSE(watch.changed(10));
  folder.write("stories/well.en.story", "One. Two.");
  EXPECT_FALSE(watch.changed(11)) << "it may be half written";
  folder.write("stories/well.en.story", "One. Two. Three.");
  EXPECT_FALSE(watch.changed(11.4));
  EXPECT_FALSE(watch.changed(11.8)) << "still for 0.4 s";
  EXPECT_TRUE(watch.changed(11.95));
  EXPECT_FALSE(watch.changed(20)) << "once";
  std::filesystem::remove(folder.path / "stories" / "well.en.story");
  EXPECT_FALSE(watch.changed(21));
  EXPECT_TRUE(watch.changed(22)) << "a file that is gone is a change";
}

TEST(FolderWatch, SeesAFileOfTheSameSizeByItsTime) {
  test::Folder folder;
  const std::string file = folder.write("exhibit.json", "{1}");
  FolderWatch watch(folder.path.string());
  std::filesystem::last_write_time(
      file, std::filesystem::last_write_time(file) + std::chrono::seconds(2));
  EXPECT_FALSE(watch.changed(1));
  EXPECT_TRUE(watch.changed(2));
}

TEST(FolderWatch, LooksOverWhatEditorsLeave) {
  test::Folder folder;
  FolderWatch watch(folder.path.string());
  folder.write(".exhibit.json.swp", "x");
  folder.write("exhibit.json~", "x");
  std::filesystem::create_directory(folder.path / ".git");
  folder.write(".git/index", "x");
  EXPECT_FALSE(watch.changed(1));
  EXPECT_FALSE(watch.changed(2));
}

TEST(FolderWatch, AFolderThatIsGoneForAMomentIsNoChange) {
  test::Folder folder;
  const std::filesystem::path inner = folder.path / "a", aside = folder.path / "b";
  std::filesystem::create_directory(inner);
  folder.write("a/exhibit.json", "x");
  FolderWatch watch(inner.string());
  std::filesystem::rename(inner, aside);
  EXPECT_FALSE(watch.changed(1));
  std::filesystem::rename(aside, inner);
  EXPECT_FALSE(watch.changed(1.2));
  EXPECT_FALSE(watch.changed(3));
}

}  // namespace
}  // namespace wellspring::test
