// SPDX-License-Identifier: Apache-2.0
// An exhibit of a model: what is made, that it is good, and what is refused.
#include "show/proposal/new_exhibit.h"

#include <gtest/gtest.h>

#include "base/load_error.h"
#include "show/exhibit/exhibit_objects.h"
#include "unit/show/exhibit/room_package.h"
#include "world/view.h"

namespace wellspring::test {
namespace {

struct Made {
  Folder folder;
  Exhibit exhibit;
  std::vector<Problem> problems;
  json manifest;

  explicit Made(const Asset& asset) {
    folder.write("model.gltf", asset.gltf());
    NewExhibit made = make_new_exhibit(folder.file("content"), "mine", folder.file("model.gltf"));
    exhibit = read_exhibit(made.folder, problems);
    World world(exhibit.scene);
    check_places(exhibit, world, problems);
    check_light(exhibit, world, problems);
    manifest = json::parse(folder.read("content/mine/exhibit.json"));
  }
  std::string told() const {
    std::string all;
    for (const Problem& problem : problems) all += to_string(problem) + "\n";
    return all;
  }
};

TEST(NewExhibit, ARoomIsSeenFromInsideAtEyeHeight) {
  Made made(room_asset());
  EXPECT_EQ(made.told(), "");
  ASSERT_GE(made.exhibit.viewpoints.size(), 2u);
  EXPECT_LE(made.exhibit.viewpoints.size(), 5u);
  for (const ExhibitViewpoint& one : made.exhibit.viewpoints) {
    const dvec3 p = one.view.position;
    EXPECT_TRUE(std::abs(p.x) < 3.6 && std::abs(p.z) < 2.6) << p.x << " " << p.z;
    EXPECT_NEAR(p.y, 1.65, 1e-3) << "on the floor, not on the table";
  }
  EXPECT_TRUE(made.exhibit.walk.has_value());
  EXPECT_FALSE(made.manifest.contains("scale"));
  EXPECT_EQ(made.manifest["exposure"], "auto");
  EXPECT_FALSE(made.manifest["environment"].contains("sky")) << "its own lamp is enough";
}

TEST(NewExhibit, AnObjectIsSeenFromOutsideUnderASky) {
  Asset asset;
  add_box(asset, "Block", {1, 0, 1}, {2, 1.5f, 1.7f}, false);
  Made made(asset);
  EXPECT_EQ(made.told(), "");
  ASSERT_GE(made.exhibit.viewpoints.size(), 2u);
  EXPECT_FALSE(made.exhibit.walk.has_value());
  EXPECT_TRUE(made.manifest["environment"].contains("sky"));
  for (const ExhibitViewpoint& one : made.exhibit.viewpoints) {
    View view = make_view(made.exhibit.scene, one.view.position, one.view.yaw, one.view.pitch,
                          one.view.fov, 400, 300);
    for (int corner = 0; corner < 8; corner++) {
      Projected at =
          project_point(view, {corner & 1 ? 2 : 1, corner & 2 ? 1.5f : 0, corner & 4 ? 1.7f : 1});
      EXPECT_TRUE(at.depth > 0 && at.x > 0 && at.x < 400 && at.y > 0 && at.y < 300)
          << one.view.name;
    }
  }
}

// A picture that hangs with its one side towards -z, and the lid of a box that shows its top alone.
TEST(NewExhibit, SidesFromWhichNothingIsSeenAreNoViews) {
  for (bool lying : {false, true}) {
    Asset asset;
    const int at = lying ? asset.add_floats("VEC3", 3, {0, 0, 0, 0, 0, 1, 1, 0, 0})
                         : asset.add_floats("VEC3", 3, {0, 0, 0, 0, 1, 0, 1, 0, 0});
    const int mesh = asset.add_mesh({{"attributes", {{"POSITION", at}}}});
    asset.add_node({{"name", "Sheet"}, {"mesh", mesh}});
    Made made(asset);
    EXPECT_EQ(made.told(), "");
    EXPECT_EQ(made.exhibit.viewpoints.size(), 3u);
    for (const ExhibitViewpoint& one : made.exhibit.viewpoints)
      EXPECT_TRUE(lying ? one.view.position.y > 0 : one.view.position.z < 0) << one.view.name;
  }
}

TEST(NewExhibit, MillimetresBecomeMetres) {
  Asset asset;
  add_box(asset, "Room", vec3(-4000, 0, -3000), vec3(4000, 3000, 3000), true);
  Made made(asset);
  EXPECT_EQ(made.told(), "");
  EXPECT_TRUE(made.exhibit.walk.has_value());
  Bounds box = scene_bounds(made.exhibit.scene);
  EXPECT_NEAR(box.high.x, 4, 1e-3);
}

TEST(NewExhibit, WhatMovesPlaysByItself) {
  Asset asset = room_asset();
  add_clip(asset, "Lift", 1, {0, 0.4f, 0}, true);
  add_clip(asset, "Lift more", 1, {0, 0.8f, 0}, true);  // the same node's
  add_clip(asset, "Lamp", 2, {1, 0, 0}, true);          // nothing is seen of that
  Made made(asset);
  EXPECT_EQ(made.told(), "");
  ASSERT_EQ(made.manifest["animations"].size(), 1u);
  EXPECT_EQ(made.manifest["animations"][0]["clip"], "Lift");
}

TEST(NewExhibit, AModelOfWhichAllMovesIsAnExhibitToo) {
  Asset asset;
  add_box(asset, "Block", {1, 0, 1}, {2, 1.5f, 1.7f}, false);
  add_clip(asset, "Turn", 0, {0, 0.4f, 0}, true);
  Made made(asset);
  EXPECT_EQ(made.told(), "");
  take_movers(made.exhibit);
  EXPECT_EQ(made.exhibit.movers.size(), 1u);
  EXPECT_TRUE(made.exhibit.scene.instances.empty());
}

TEST(NewExhibit, AClosedRoomWithoutLightGetsLamps) {
  Made made(room_asset(0));
  EXPECT_EQ(made.told(), "");
  EXPECT_FALSE(made.exhibit.scene.lights.empty());
  EXPECT_TRUE(made.manifest.contains("scenes"));
}

TEST(NewExhibit, ItsFilesComeAlong) {
  Folder folder;
  Asset asset = room_asset();
  json root = asset.finished(false);
  root["buffers"][0]["uri"] = "data/room%20one.bin";
  std::filesystem::create_directories(folder.path / "data");
  folder.write("data/room one.bin", asset.bytes);
  folder.write("model.gltf", root.dump());
  make_new_exhibit(folder.file("content"), "mine", folder.file("model.gltf"));
  EXPECT_EQ(folder.read("content/mine/data/room one.bin"), asset.bytes);
  std::vector<Problem> problems;
  EXPECT_EQ(triangle_count(read_exhibit(folder.file("content/mine"), problems).scene), 24u);
}

TEST(NewExhibit, WhatCannotBeIsRefusedAndLeavesNothing) {
  Folder folder;
  const std::string content = folder.file("content");
  folder.write("model.gltf", room_asset().gltf());
  folder.write("bad.gltf", "{");
  folder.write("empty.gltf", R"({"asset": {"version": "2.0"}})");
  const std::string model = folder.file("model.gltf");
  for (const char* id : {"", "..", "a/b", ".hidden"})
    EXPECT_THROW(make_new_exhibit(content, id, model), LoadError) << id;
  for (const char* name : {"bad.gltf", "empty.gltf", "none.gltf"})
    EXPECT_THROW(make_new_exhibit(content, "mine", folder.file(name)), LoadError) << name;
  EXPECT_FALSE(std::filesystem::exists(folder.path / "content" / "mine"));
  make_new_exhibit(content, "mine", model);
  const std::string before = folder.read("content/mine/exhibit.json");
  EXPECT_THROW(make_new_exhibit(content, "mine", model), LoadError);
  EXPECT_EQ(folder.read("content/mine/exhibit.json"), before);
}

}  // namespace
}  // namespace wellspring::test
