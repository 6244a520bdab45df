// SPDX-License-Identifier: Apache-2.0
// The node of a skinned mesh does not move it, but decides which side is its front (glTF 2.0
// section 3.7.4).
#include <gtest/gtest.h>

#include "unit/world/load/asset.h"

namespace wellspring::test {
namespace {

struct Nodes {
  std::vector<float> armature{1, 1, 1};  // scale of the node above the joint
  std::vector<float> mesh{1, 1, 1};      // scale of the mesh's own node
  bool mesh_below = true;                // the mesh's node hangs on the armature, too
  bool normals = true, tangents = false;
};

// A triangle that faces +Z, on one joint.
Scene load_skin(const Nodes& nodes) {
  Asset asset;
  json attributes;
  attributes["POSITION"] = asset.add_floats("VEC3", 3, {0, 0, 0, 1, 0, 0, 0, 1, 0});
  attributes["TEXCOORD_0"] = asset.add_floats("VEC2", 2, {0, 1, 1, 1, 0, 0});
  if (nodes.normals)
    attributes["NORMAL"] = asset.add_floats("VEC3", 3, {0, 0, 1, 0, 0, 1, 0, 0, 1});
  if (nodes.tangents)
    attributes["TANGENT"] = asset.add_floats("VEC4", 4, {1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1});
  attributes["JOINTS_0"] =
      asset.add_accessor(asset.add_view(std::vector<uint8_t>(12, 0)), 5121, "VEC4", 3);
  attributes["WEIGHTS_0"] = asset.add_floats("VEC4", 4, {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  asset.root["materials"] = {
      {{"extensions", {{"KHR_materials_anisotropy", {{"anisotropyStrength", 0.5}}}}}}};
  asset.add_mesh({{"attributes", attributes}, {"material", 0}});
  asset.root["skins"] = {{{"joints", {1}}}};
  json children = {1};
  if (nodes.mesh_below) children.push_back(2);
  asset.add_node({{"children", children}, {"scale", nodes.armature}});
  asset.root["nodes"].push_back({{"name", "joint"}});
  const json mesh = {{"mesh", 0}, {"skin", 0}, {"scale", nodes.mesh}};
  if (nodes.mesh_below) asset.root["nodes"].push_back(mesh);
  else asset.add_node(mesh);
  return load(asset);
}

vec3 face_of(const Scene& scene) {
  const Mesh& mesh = scene.meshes.front();
  const uvec3 t = mesh.triangles.front();
  return normalize(
      cross(mesh.positions[t.y] - mesh.positions[t.x], mesh.positions[t.z] - mesh.positions[t.x]));
}

TEST(MirroredSkin, FacesTheViewerWhereItsMirrorImageWould) {
  EXPECT_EQ(face_of(load_skin({})), vec3(0, 0, 1));
  EXPECT_EQ(face_of(load_skin({.armature = {-1, 1, 1}})), vec3(0, 0, 1));
  EXPECT_EQ(face_of(load_skin({.armature = {-1, 1, -1}})), vec3(0, 0, -1));  // half a turn
  EXPECT_EQ(face_of(load_skin({.armature = {-1, 1, 1}, .normals = false})), vec3(0, 0, 1));
}

TEST(MirroredSkin, ItsOwnNodeDecidesWhereverItsJointsAre) {
  EXPECT_EQ(face_of(load_skin({.mesh = {-1, 1, 1}})), vec3(0, 0, -1));
  EXPECT_EQ(face_of(load_skin({.armature = {-1, 1, 1}, .mesh = {1, -1, 1}})), vec3(0, 0, -1));
  EXPECT_EQ(face_of(load_skin({.armature = {-1, 1, 1}, .mesh_below = false})), vec3(0, 0, -1));
}

TEST(MirroredSkin, NormalsStayOutside) {
  for (bool given : {true, false})
    for (float x : {1.0f, -1.0f}) {
      const Scene scene = load_skin({.armature = {x, 1, 1}, .normals = given});
      for (const vec3& n : scene.meshes.front().normals) EXPECT_EQ(n, vec3(0, 0, 1)) << x;
    }
}

// Up in the picture stays up: along +Y, whichever way u runs.
TEST(MirroredSkin, BitangentsAreMirroredToo) {
  for (bool given : {true, false})
    for (float x : {1.0f, -1.0f}) {
      const Scene scene = load_skin({.armature = {x, 1, 1}, .tangents = given});
      const Mesh& mesh = scene.meshes.front();
      ASSERT_FALSE(mesh.tangents.empty());
      const vec3 tangent(mesh.tangents[0]);
      EXPECT_NEAR(tangent.x, x, 1e-6f);
      EXPECT_NEAR((cross(mesh.normals[0], tangent) * mesh.tangents[0].w).y, 1, 1e-6f) << x << given;
    }
}

}  // namespace
}  // namespace wellspring::test
