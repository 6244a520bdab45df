// SPDX-License-Identifier: Apache-2.0
// Files that are wrong, hostile or broken: each is refused with its place, and none crashes.
#include "unit/world/load/asset.h"
#include "base/rng.h"
#include "world/world.h"

namespace wellspring::test {
namespace {

namespace fs = std::filesystem;

// Loading gives a scene that can be traced, or a LoadError; anything else fails the test.
bool loads(const std::string& path) {
  try {
    Scene scene = load_scene(path);
    for (const Mesh& mesh : scene.meshes) {
      for (const vec3& p : mesh.positions) EXPECT_TRUE(is_finite(p));
      for (const vec3& n : mesh.normals) EXPECT_NEAR(length(n), 1, 1e-3f);
    }
    World world(scene);
    Ray ray{.origin = vec3(0.1f, 0.2f, 5)};
    world.intersect(ray);
    return true;
  } catch (const LoadError& error) {
    EXPECT_FALSE(error.what_.empty());
    EXPECT_EQ(error.file, path);
    return false;
  }
}

TEST(Refuse, FilesThatAreNoFiles) {
  TempFolder folder;
  EXPECT_THROW(load_scene((folder.path() / "none.gltf").string()), LoadError);
  EXPECT_THROW(load_scene(folder.path().string()), LoadError);
  EXPECT_FALSE(loads(folder.write("empty.gltf", "")));
  EXPECT_FALSE(loads(folder.write("text.gltf", "hello")));
  EXPECT_FALSE(loads(folder.write("half.gltf", R"({"asset":{"version":"2.0")")));
  EXPECT_NE(refused("{\"asset\": nonsense}").where.find("byte"), std::string::npos);
}

TEST(Refuse, WrongTypesAndMissingPropertiesNameTheirPlace) {
  auto where = [](auto change) {
    Asset asset = triangle_asset();
    change(asset.root);
    return refused(asset).where;
  };
  EXPECT_EQ(where([](json& r) { r.erase("asset"); }), "");
  EXPECT_EQ(where([](json& r) { r["asset"]["version"] = "1.0"; }), "/asset/version");
  EXPECT_EQ(where([](json& r) { r["asset"]["version"] = 2.0; }), "/asset/version");
  EXPECT_EQ(where([](json& r) { r["asset"]["minVersion"] = "2.1"; }), "/asset/minVersion");
  EXPECT_EQ(where([](json& r) { r["nodes"] = 5; }), "/nodes");
  EXPECT_EQ(where([](json& r) { r["nodes"][0] = nullptr; }), "/nodes/0");
  EXPECT_EQ(where([](json& r) { r["nodes"][0]["mesh"] = "0"; }), "/nodes/0/mesh");
  EXPECT_EQ(where([](json& r) { r["nodes"][0]["mesh"] = 1.5; }), "/nodes/0/mesh");
  EXPECT_EQ(where([](json& r) { r["nodes"][0]["mesh"] = 1; }), "/nodes/0/mesh");
  EXPECT_EQ(where([](json& r) { r["nodes"][0]["scale"] = {1, 1}; }), "/nodes/0/scale");
  EXPECT_EQ(where([](json& r) { r["nodes"][0]["scale"] = {1, "x", 1}; }), "/nodes/0/scale/1");
  EXPECT_EQ(where([](json& r) { r["nodes"][0]["name"] = 3; }), "/nodes/0/name");
  EXPECT_EQ(where([](json& r) { r["nodes"][0]["extensions"] = 3; }), "/nodes/0/extensions");
  EXPECT_EQ(where([](json& r) { r["nodes"][0]["translation"] = {1e30, 0, 0}; }), "/nodes/0");
  EXPECT_EQ(where([](json& r) { r["scene"] = 7; }), "/scene");
  EXPECT_EQ(where([](json& r) { r["meshes"][0].erase("primitives"); }), "/meshes/0");
  EXPECT_EQ(where([](json& r) { r["meshes"][0]["primitives"][0].erase("attributes"); }),
            "/meshes/0/primitives/0");
  EXPECT_EQ(where([](json& r) { r["meshes"][0]["primitives"][0]["attributes"]["a/b~"] = 9; }),
            "/meshes/0/primitives/0/attributes/a~1b~0");
  EXPECT_EQ(where([](json& r) { r["extensionsRequired"] = {"KHR_texture_basisu"}; }),
            "/extensionsRequired/0");
}

TEST(Refuse, RequiredExtensionsAreNamed) {
  for (const char* name : {"KHR_materials_variants", "EXT_texture_avif", "KHR_texture_basisu"}) {
    Asset asset = triangle_asset();
    asset.root["extensionsUsed"] = asset.root["extensionsRequired"] = json::array({name});
    EXPECT_NE(refused(asset).what_.find(name), std::string::npos);
    asset.root.erase("extensionsRequired");
    EXPECT_TRUE(warns_of(load(asset), name));
  }
}

TEST(Refuse, IndicesBeyondTheVertices) {
  for (uint32_t bad : {3u, 255u, 0xffffffffu}) {
    Asset asset = triangle_asset();
    int indices = asset.add_accessor(asset.add_view<uint32_t>({0, 1, bad}), 5125, "SCALAR", 3);
    asset.root["meshes"][0]["primitives"][0]["indices"] = indices;
    LoadError error = refused(asset);
    EXPECT_EQ(error.where, "/meshes/0/primitives/0/indices");
    EXPECT_NE(error.what_.find("element 2"), std::string::npos);
  }
}

TEST(Refuse, AttributesOfOtherLengths) {
  Asset asset = triangle_asset();
  asset.root["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
      asset.add_floats("VEC3", 3, {0, 0, 1, 0, 0, 1});
  EXPECT_EQ(refused(asset).where, "/meshes/0/primitives/0/attributes/NORMAL");
}

TEST(Refuse, NodeCyclesAndSharedChildren) {
  auto tree = [](std::vector<std::vector<int>> children) {
    Asset asset = triangle_asset();
    asset.root["nodes"] = json::array();
    for (const std::vector<int>& list : children)
      asset.root["nodes"].push_back(list.empty() ? json{{"mesh", 0}} : json{{"children", list}});
    asset.root["scenes"] = {{{"nodes", {0}}}};
    return asset;
  };
  EXPECT_EQ(refused(tree({{0}})).where, "/nodes/0/children/0");
  EXPECT_NE(refused(tree({{1}, {2}, {0}})).what_.find("cycle"), std::string::npos);
  EXPECT_NE(refused(tree({{}, {2}, {1}})).what_.find("cycle"), std::string::npos);
  EXPECT_EQ(refused(tree({{1, 2}, {3}, {3}, {}})).where, "/nodes/2/children/0");
  EXPECT_EQ(refused(tree({{1, 1}, {}})).where, "/nodes/0/children/1");
  EXPECT_EQ(triangle_count(load(tree({{1, 2}, {}, {}}))), 2u);
}

TEST(Refuse, DepthOfJsonAndOfNodes) {
  std::string bomb = R"({"asset":{"version":"2.0"},"extras":)";
  LoadError error = refused(bomb + std::string(1'000'000, '['));
  EXPECT_NE(error.what_.find("nested"), std::string::npos);
  std::string deep = bomb + std::string(90, '[') + std::string(90, ']') + "}";
  EXPECT_EQ(triangle_count(load_scene_text(deep)), 0u);
  EXPECT_EQ(triangle_count(load_scene_text(bomb + '"' + std::string(500, '[') + "\\\"\"}")), 0u);

  Asset asset = triangle_asset();  // a chain of nodes is no problem
  asset.root["nodes"] = json::array();
  int depth = 50'000;
  for (int i = 0; i + 1 < depth; i++)
    asset.root["nodes"].push_back({{"children", {i + 1}}, {"translation", {0.001, 0, 0}}});
  asset.root["nodes"].push_back({{"mesh", 0}});
  Scene scene = load(asset);
  EXPECT_NEAR(corner_of(scene, 0, 0, 0).x, 49.999f, 1e-3f);
}

TEST(Refuse, FilesOutsideThePackage) {
  TempFolder folder;
  std::string secret = std::string(36, '\0');
  folder.write("secret.bin", secret);
  folder.write("package/inside.bin", secret);
  folder.write("package/sub/deep.bin", secret);
  folder.write("package2/other.bin", secret);
  fs::create_symlink(folder.path() / "secret.bin", folder.path() / "package/link.bin");
  fs::create_symlink(folder.path() / "package/inside.bin", folder.path() / "package/good.bin");
  fs::create_directory_symlink(folder.path(), folder.path() / "package/up");
  Asset asset = triangle_asset();
  auto with = [&](const std::string& uri) {
    json root = asset.finished(true);
    root["buffers"][0]["uri"] = uri;
    return folder.write("package/test.gltf", root.dump());
  };
  std::string absolute = (folder.path() / "secret.bin").string();
  for (const std::string& uri :
       {std::string("../secret.bin"), std::string("%2e%2e/secret.bin"),
        std::string("%2E%2e%2fsecret.bin"), std::string("sub/../../secret.bin"),
        std::string("..\\secret.bin"), absolute, "file://" + absolute, "%2f" + absolute.substr(1),
        std::string("link.bin"), std::string("up/secret.bin"), std::string("../package2/other.bin"),
        std::string("http://a/b.bin"), std::string("inside.bin%00.png"),
        std::string("inside.bin%0"), std::string("")}) {
    try {
      load_scene(with(uri));
      ADD_FAILURE() << uri;
    } catch (const LoadError& error) {
      EXPECT_EQ(error.where, "/buffers/0/uri") << uri;
      EXPECT_EQ(error.what_.find("no such file"), std::string::npos) << uri;
    }
  }
  for (const char* uri : {"inside.bin", "sub/deep.bin", "./inside.bin", "good.bin"})
    EXPECT_TRUE(loads(with(uri))) << uri;
  EXPECT_FALSE(loads(with("sub")));  // a folder
  EXPECT_FALSE(loads(with("missing.bin")));
  // A wider package allows what the file's own folder does not, up to its own edge.
  SceneLoadOptions wider{.package = (folder.path() / "package").string() + "/"};
  json root = asset.finished(true);
  root["buffers"][0]["uri"] = "deep.bin";
  EXPECT_NO_THROW(load_scene(folder.write("package/sub/test.gltf", root.dump()), wider));
}

TEST(Refuse, BuffersShorterThanTheySay) {
  Asset asset = triangle_asset();
  json root = asset.finished(true);
  root["buffers"][0]["byteLength"] = 1000;
  EXPECT_EQ(refused(root.dump()).where, "/buffers/0/byteLength");
  root["buffers"][0].erase("uri");
  EXPECT_EQ(refused(root.dump()).where, "/buffers/0");
}

TEST(Refuse, GlbContainers) {
  std::string good = triangle_asset().glb();
  TempFolder folder;
  ASSERT_TRUE(loads(folder.write("good.glb", good)));
  auto with_word = [&](size_t offset, uint32_t value) {
    std::string bytes = good;
    std::memcpy(bytes.data() + offset, &value, 4);
    return folder.write("bad.glb", bytes);
  };
  EXPECT_FALSE(loads(with_word(4, 1)));             // version
  EXPECT_FALSE(loads(with_word(8, 0xffffffffu)));   // length beyond the file
  EXPECT_FALSE(loads(with_word(8, 12)));            // no chunk at all
  EXPECT_FALSE(loads(with_word(8, 16)));            // half a chunk header
  EXPECT_FALSE(loads(with_word(12, 0xffffffffu)));  // chunk beyond the file
  EXPECT_FALSE(loads(with_word(12, 0xfffffff4u)));
  EXPECT_FALSE(loads(with_word(16, 0x004e4942)));  // binary first
  for (size_t length = 0; length < good.size(); length += 97)
    EXPECT_FALSE(loads(folder.write("cut.glb", good.substr(0, length)))) << length;
}

TEST(Refuse, FlippedBytesNeverCrash) {
  Asset asset = triangle_asset();
  int indices = asset.add_accessor(asset.add_view<uint8_t>({0, 1, 2, 0}), 5121, "SCALAR", 3);
  asset.root["meshes"][0]["primitives"][0]["indices"] = indices;
  asset.root["materials"] = {{{"pbrMetallicRoughness", {{"baseColorFactor", {1, 0.5, 0, 1}}}}}};
  asset.root["meshes"][0]["primitives"][0]["material"] = 0;
  std::string good = asset.glb();
  TempFolder folder;
  Rng rng(20240229);
  int loaded = 0, tried = 600;
  for (int i = 0; i < tried; i++) {
    std::string bytes = good;
    for (int flips = 1 + int(rng.next() % 3); flips > 0; flips--) {
      size_t place = rng.next() % bytes.size();
      // Half the time another digit or letter, which keeps the JSON readable.
      bytes[place] = rng.next() % 2 ? char("0123456789-.,:e{}[]\""[rng.next() % 21])
                                    : char(bytes[place] ^ (1 << rng.next() % 8));
    }
    loaded += loads(folder.write("flip.glb", bytes));
  }
  EXPECT_GT(loaded, tried / 20);  // so the flips reached beyond the parser
  EXPECT_LT(loaded, tried);
}

// Every number of a file in turn becomes something it should not be.
void mutate(json& value, const json& root, const TempFolder& folder, int& loaded) {
  if (value.is_structured()) {
    for (auto& child : value) mutate(child, root, folder, loaded);
    return;
  }
  json before = value;
  for (const json& other :
       {json(-1), json(0), json(1), json(2147483648.0), json(9007199254740992.0), json(1e300),
        json(0.5), json("x"), json(nullptr), json::array(), json::object()}) {
    value = other;
    loaded += loads(folder.write("mutant.gltf", root.dump()));
  }
  value = before;
}

TEST(Refuse, EveryValueReplaced) {
  Asset asset = triangle_asset();
  int delta = asset.add_floats("VEC3", 3, {0, 0, 1, 0, 0, 1, 0, 0, 1});
  json& primitive = asset.root["meshes"][0]["primitives"][0];
  primitive["targets"] = {{{"POSITION", delta}}};
  primitive["indices"] =
      asset.add_accessor(asset.add_view<uint16_t>({0, 1, 2, 0}), 5123, "SCALAR", 3);
  primitive["attributes"]["JOINTS_0"] =
      asset.add_accessor(asset.add_view(std::vector<uint8_t>(12)), 5121, "VEC4", 3);
  primitive["attributes"]["WEIGHTS_0"] =
      asset.add_floats("VEC4", 4, {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  asset.root["meshes"][0]["weights"] = {0.5};
  asset.root["nodes"][0]["skin"] = 0;
  asset.root["skins"] = {{{"joints", {0}}}};
  asset.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}}};
  asset.add_node({{"camera", 0}, {"rotation", {0, 0, 0, 1}}});
  int times = asset.add_floats("SCALAR", 1, {0, 1});
  int moves = asset.add_floats("VEC3", 3, {0, 0, 0, 1, 1, 1});
  asset.root["animations"] = {
      {{"samplers", {{{"input", times}, {"output", moves}}}},
       {"channels", {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "translation"}}}}}}}};
  json root = asset.finished(true);
  TempFolder folder;
  ASSERT_TRUE(loads(folder.write("good.gltf", root.dump())));
  int loaded = 0;
  mutate(root, root, folder, loaded);
  EXPECT_GT(loaded, 0);
}

}  // namespace
}  // namespace wellspring::test
