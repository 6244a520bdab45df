// SPDX-License-Identifier: Apache-2.0
// A storyteller's figure may be another exhibit's.
#include <gtest/gtest.h>

#include "unit/avatar/figures.h"
#include "unit/show/exhibit/room_package.h"

namespace wellspring::test {
namespace {

struct Lent : RoomPackage {
  Lent() {
    std::filesystem::create_directories(folder.path / "castle");
    folder.write("castle/exhibit.json", "{}");
    folder.write("castle/figure.x3d", small_skin());
    folder.write("outside.x3d", small_skin());
    manifest["storyteller"] = {
        {"figure", "figure.x3d"}, {"figure_from", "castle"}, {"position", {0, 0, 1}}};
  }
  json& storyteller() { return manifest["storyteller"]; }
};

TEST(ExhibitFigures, AFigureIsLentByThePackageBesideThisOne) {
  Lent lent;
  const Exhibit exhibit = lent.read();
  ASSERT_EQ(exhibit.storytellers.size(), 1u) << lent.told();
  EXPECT_FALSE(exhibit.storytellers[0].character.positions.empty()) << lent.told();
  EXPECT_EQ(lent.says("/storyteller/figure", ""), 0) << lent.told();
  EXPECT_EQ(lent.says("/storyteller/figure_from", ""), 0) << lent.told();
}

TEST(ExhibitFigures, OnlyExhibitsLendAndOnlyWhatIsTheirs) {
  Lent lent;
  for (const char* id : {"castel", "..", "../castle", ".", "castle/"}) {
    lent.storyteller()["figure_from"] = id;
    lent.read();
    EXPECT_EQ(lent.says("/storyteller/figure_from", "there is no exhibit"), 1) << id << lent.told();
  }
  lent.storyteller()["figure_from"] = "castle";
  lent.storyteller()["figure"] = "../outside.x3d";
  lent.read();
  EXPECT_EQ(lent.says("/storyteller/figure", "leaves the package's folder"), 1) << lent.told();
  lent.storyteller()["figure"] = "figur.x3d";
  lent.read();
  EXPECT_EQ(lent.says("/storyteller/figure", "did you mean 'figure.x3d'?"), 1) << lent.told();
}

}  // namespace
}  // namespace wellspring::test
