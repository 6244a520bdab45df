// SPDX-License-Identifier: Apache-2.0
#include "show/exhibit/fingerprint.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "unit/folder.h"

namespace wellspring {
namespace {

namespace fs = std::filesystem;

TEST(Fingerprint, ChangesWithAnyFilesNameSizeOrTime) {
  test::Folder folder;
  const std::string path = folder.path.string();
  auto write = [&](const char* name, const char* text) {
    fs::create_directories((folder.path / name).parent_path());
    std::ofstream(folder.path / name) << text;
  };
  write("exhibit.json", "{}");
  write("figures/anna.x3d", "<X3D/>");
  const uint64_t first = exhibit_fingerprint(path);
  EXPECT_EQ(exhibit_fingerprint(path), first);
  auto written = fs::last_write_time(folder.path / "exhibit.json");
  fs::last_write_time(folder.path / "exhibit.json", written + std::chrono::seconds(1));
  EXPECT_NE(exhibit_fingerprint(path), first) << "a newer file";
  fs::last_write_time(folder.path / "exhibit.json", written);
  EXPECT_EQ(exhibit_fingerprint(path), first);
  fs::rename(folder.path / "figures/anna.x3d", folder.path / "figures/otto.x3d");
  EXPECT_NE(exhibit_fingerprint(path), first) << "another name";
  fs::rename(folder.path / "figures/otto.x3d", folder.path / "figures/anna.x3d");
  write("scene.glb", "more");
  EXPECT_NE(exhibit_fingerprint(path), first) << "one more";
}

TEST(Fingerprint, NoFolderIsNoError) { EXPECT_NO_THROW(exhibit_fingerprint("/no/such/folder")); }

}  // namespace
}  // namespace wellspring
