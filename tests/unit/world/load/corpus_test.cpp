// SPDX-License-Identifier: Apache-2.0
// Real files: all valid ones load, and each bad one is refused or loads as the policy in
// gltf/file.h says.
#include <algorithm>
#include <map>
#include <sstream>

#include "unit/world/load/asset.h"
#include "world/world.h"

namespace wellspring::test {
namespace {

namespace fs = std::filesystem;

const fs::path data_folder = fs::path(WELLSPRING_DATA) / "1_gltf";

std::vector<std::string> gltf_files(const fs::path& folder) {
  std::vector<std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.path().extension() == ".gltf" || entry.path().extension() == ".glb")
      files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  return files;
}

void check_scene(const Scene& scene) {
  ASSERT_FALSE(scene.materials.empty());
  for (const Mesh& mesh : scene.meshes) {
    size_t count = mesh.positions.size();
    ASSERT_EQ(mesh.normals.size(), count);
    ASSERT_LT(size_t(mesh.material), scene.materials.size());
    for (size_t length :
         {mesh.uv[0].size(), mesh.uv[1].size(), mesh.colors.size(), mesh.tangents.size()})
      ASSERT_TRUE(length == 0 || length == count);
    for (const vec3& p : mesh.positions) ASSERT_TRUE(is_finite(p));
    for (const vec3& n : mesh.normals) ASSERT_NEAR(length(n), 1, 1e-3f);
    for (const uvec3& t : mesh.triangles) ASSERT_LT(std::max({t.x, t.y, t.z}), count);
  }
  for (const Instance& instance : scene.instances) {
    ASSERT_LT(size_t(instance.mesh), scene.meshes.size());
    ASSERT_LT(instance.object, scene.objects.size());
  }
  for (const Texture& texture : scene.textures)
    ASSERT_LT(size_t(texture.image), scene.images.size());
  World world(scene);
  Bounds bounds = scene_bounds(scene);
  Ray ray;  // through the middle of the scene along its diagonal
  ray.origin = bounds.low - (bounds.high - bounds.low);
  ray.direction = normalize(bounds.high - bounds.low + vec3(1e-6f));
  if (triangle_count(scene) > 0) world.intersect(ray);
}

TEST(Corpus, ValidFilesLoad) {
  if (!fs::exists(data_folder)) GTEST_SKIP() << "no corpus at " << data_folder;
  int loaded = 0;
  for (const char* set : {"khronos", "assimp", "castle", "ozz"})
    for (const std::string& file : gltf_files(data_folder / set)) {
      SCOPED_TRACE(file);
      try {
        check_scene(load_scene(file));
        check_scene(load_scene(file, {0.7, ""}));
        loaded++;
      } catch (const LoadError& error) {
        // The only reason a valid file may be refused.
        EXPECT_NE(error.what_.find("needs extension KHR_draco_mesh_compression"), std::string::npos)
            << error.what();
      }
    }
  EXPECT_GT(loaded, 70);
}

// Lists files that the validator calls an error and that yet have one meaning that can be shown
// (gltf/file.h).
const std::map<std::string, const char*> only_odd = {
    {"EMPTY_ENTITY", "an empty list"},
    {"DUPLICATE_ELEMENTS", "an extension listed twice"},
    {"INVALID_JSON", "a byte order mark"},
    {"ACCESSOR_NORMALIZED_INVALID", "floats called normalised"},
    {"UNSATISFIED_DEPENDENCY", "offset without view, skin without mesh"},
    {"UNDECLARED_EXTENSION", ""},
    {"BUFFER_VIEW_INVALID_BYTE_STRIDE", ""},
    {"BUFFER_VIEW_TOO_BIG_BYTE_STRIDE", ""},
    {"BUFFER_VIEW_TARGET_OVERRIDE", ""},
    {"VALUE_MULTIPLE_OF", "a stride that is not a multiple of four"},
    {"MESH_PRIMITIVE_ACCESSOR_UNALIGNED", ""},
    {"MESH_PRIMITIVE_ACCESSOR_WITHOUT_BYTESTRIDE", ""},
    {"MESH_PRIMITIVE_INDICES_ACCESSOR_WITH_BYTESTRIDE", ""},
    {"MESH_PRIMITIVE_POSITION_ACCESSOR_WITHOUT_BOUNDS", ""},
    {"MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_UNSIGNED_INT", "of an attribute of the application's own"},
    {"MESH_PRIMITIVE_INVALID_ATTRIBUTE", ""},
    {"MESH_PRIMITIVE_INDEXED_SEMANTIC_CONTINUITY", ""},
    {"MESH_PRIMITIVE_MORPH_TARGET_NO_BASE_ACCESSOR", ""},
    {"MESH_PRIMITIVES_UNEQUAL_TARGETS_COUNT", ""},
    {"MESH_PRIMITIVE_TOO_FEW_TEXCOORDS", ""},
    {"MESH_INVALID_WEIGHTS_COUNT", ""},
    {"NODE_WEIGHTS_INVALID", ""},
    {"ACCESSOR_NON_CLAMPED", ""},
    {"ACCESSOR_INDEX_PRIMITIVE_RESTART", "an index that is in range all the same"},
    {"ACCESSOR_INVALID_SIGN", ""},
    {"ACCESSOR_VECTOR3_NON_UNIT", ""},
    {"ACCESSOR_INVALID_IBM", "a last row that is not 0 0 0 1"},
    {"ACCESSOR_JOINTS_INDEX_DUPLICATE", ""},
    {"ACCESSOR_JOINTS_INDEX_OOB", "of points, which are not drawn"},
    {"ACCESSOR_WEIGHTS_NEGATIVE", ""},
    {"ACCESSOR_WEIGHTS_NON_NORMALIZED", ""},
    {"ACCESSOR_ANIMATION_SAMPLER_OUTPUT_NON_NORMALIZED_QUATERNION", ""},
    {"ACCESSOR_ANIMATION_INPUT_NEGATIVE", ""},
    {"ACCESSOR_ANIMATION_INPUT_NON_INCREASING", "two keys at the same time: a jump"},
    {"ANIMATION_DUPLICATE_TARGETS", ""},
    {"ANIMATION_CHANNEL_TARGET_NODE_MATRIX", ""},
    {"ANIMATION_CHANNEL_TARGET_NODE_WEIGHTS_NO_MORPHS", ""},
    {"ANIMATION_SAMPLER_INPUT_ACCESSOR_WITHOUT_BOUNDS", ""},
    {"CAMERA_XMAG_YMAG_ZERO", ""},
    {"CAMERA_ZFAR_LEQUAL_ZNEAR", ""},
    {"ONE_OF_MISMATCH", "a camera with both kinds of lens says which it is"},
    {"NODE_MATRIX_NON_TRS", ""},
    {"NODE_SKIN_WITH_NON_SKINNED_MESH", ""},
    {"ROTATION_NON_UNIT", ""},
    {"SCENE_NON_ROOT_NODE", ""},
};

// Lists files that have no errors for the validator and are still refused, and why.
const std::map<std::string, const char*> cannot_be_shown = {
    {"asset/min_version_valid.gltf", "needs glTF 2.1"},
    {"root/named_objects.gltf", "has no data"},  // a shown mesh over a buffer without content
    {"root/unused_objects.gltf", "has no data"},
};

std::vector<std::string> split(const std::string& line, char separator) {
  std::vector<std::string> parts;
  std::stringstream stream(line);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  return parts;
}

TEST(Corpus, ValidatorFilesFollowThePolicy) {
  fs::path folder = data_folder / "bad_validator";
  if (!fs::exists(folder / "EXPECTED.tsv")) GTEST_SKIP() << "no corpus at " << folder;
  std::ifstream table(folder / "EXPECTED.tsv");
  std::string line;
  std::getline(table, line);
  int refused_count = 0, odd_count = 0, valid_count = 0;
  while (std::getline(table, line)) {
    std::vector<std::string> fields = split(line, '\t');
    std::string file = (folder / fields[0]).string(), name = fields[0].substr(15);
    SCOPED_TRACE(name);
    bool has_errors = fields[2] != "0";
    std::vector<std::string> codes =
        has_errors ? split(fields[6], ',') : std::vector<std::string>();
    bool odd =
        std::all_of(codes.begin(), codes.end(), [](auto& c) { return only_odd.count(c) > 0; });
    try {
      check_scene(load_scene(file));
      EXPECT_TRUE(odd) << "loaded in spite of " << fields[6];
      (has_errors ? odd_count : valid_count)++;
    } catch (const LoadError& error) {
      EXPECT_EQ(error.file, file);
      if (auto reason = cannot_be_shown.find(name); reason != cannot_be_shown.end())
        EXPECT_NE(error.what_.find(reason->second), std::string::npos);
      else EXPECT_TRUE(has_errors) << error.what();
      refused_count++;
    }
  }
  EXPECT_GT(refused_count, 60);
  EXPECT_GT(odd_count, 40);
  EXPECT_GT(valid_count, 30);
}

TEST(Corpus, ForeignBadFiles) {
  fs::path folder = data_folder / "bad_assimp";
  if (!fs::exists(folder)) GTEST_SKIP() << "no corpus at " << folder;
  const std::map<std::string, const char*> where = {
      {"Cube.gltf", "/bufferViews/2"},
      {"IndexOutOfRange.gltf", "/meshes/0/primitives/0/indices"},
      {"AllIndicesOutOfRange.gltf", "/meshes/0/primitives/0/indices"},
      {"BoxTextured.gltf", "/buffers/0/uri"},
      {"RecursiveNodes.gltf", "/nodes/0"},
      {"sceneWrongType.gltf", "/scene"},
      {"NoScene.gltf", "/scene"},
      {"badArray.gltf", "/meshes/0/primitives"},
      {"badExtension.gltf",
       "/materials/0/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform"},
      {"badNumber.gltf", "/materials/0/normalTexture"},
      {"badObject.gltf", "/materials/0/pbrMetallicRoughness"},
      {"badString.gltf", "/scenes/0/name"},
      {"badUint.gltf", "/materials/0/pbrMetallicRoughness/baseColorTexture/index"}};
  size_t refused_count = 0;
  for (const std::string& file : gltf_files(folder)) {
    SCOPED_TRACE(file);
    auto expected = where.find(fs::path(file).filename().string());
    try {
      Scene scene = load_scene(file);
      check_scene(scene);
      EXPECT_EQ(expected, where.end()) << "loaded";
      EXPECT_FALSE(scene.warnings.empty());
    } catch (const LoadError& error) {
      ASSERT_NE(expected, where.end()) << error.what();
      EXPECT_EQ(error.where, expected->second) << error.what();
      refused_count++;
    }
  }
  EXPECT_EQ(refused_count, where.size());
  // Files of all other kinds are no glTF, and say so.
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file() && entry.path().extension() != ".gltf" &&
        entry.path().extension() != ".glb") {
      EXPECT_THROW(load_scene(entry.path().string()), LoadError) << entry.path();
    }
}

Bounds bounds_of(const char* file, double time) {
  return scene_bounds(load_scene((data_folder / "khronos" / file).string(), {time, ""}));
}

// Figures stand as the pictures that come with them show.
TEST(Corpus, FiguresStandAsTheyShould) {
  if (!fs::exists(data_folder / "khronos")) GTEST_SKIP() << "no corpus at " << data_folder;
  Bounds man = bounds_of("CesiumMan/glTF-Binary/CesiumMan.glb", 0);
  EXPECT_NEAR(man.low.y, 0, 0.01f);
  EXPECT_NEAR(man.high.y, 1.5f, 0.05f);
  EXPECT_NEAR(man.high.z - man.low.z, 1.14f, 0.02f);  // arms stretched out
  Bounds walking = bounds_of("CesiumMan/glTF-Binary/CesiumMan.glb", 0.7);
  EXPECT_NEAR(walking.high.y - walking.low.y, 1.5f, 0.1f);
  EXPECT_LT(walking.high.z - walking.low.z, 0.9f);
  Bounds figure = bounds_of("RiggedFigure/glTF/RiggedFigure.gltf", 0);
  EXPECT_NEAR(figure.low.y, 0, 0.01f);
  EXPECT_NEAR(figure.high.y, 1.45f, 0.05f);
  Bounds robot = bounds_of("BrainStem/glTF-Binary/BrainStem.glb", 0);
  EXPECT_NEAR(robot.low.y, 0, 0.01f);
  EXPECT_NEAR(robot.high.y, 1.83f, 0.05f);
  Bounds cube = bounds_of("AnimatedMorphCube/glTF/AnimatedMorphCube.gltf", 0);
  EXPECT_NEAR(cube.high.y - cube.low.y, 2, 1e-3f);
  Bounds thin = bounds_of("AnimatedMorphCube/glTF/AnimatedMorphCube.gltf", 1.5);
  EXPECT_LT(thin.high.z - thin.low.z, 1.0f);
}

}  // namespace
}  // namespace wellspring::test
