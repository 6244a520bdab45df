// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <functional>
#include <gtest/gtest.h>
#include <map>
#include <zstd.h>

#include "../folder.h"
#include "base/load_error.h"
#include "las_made.h"
#include "scan/las/ept.h"

namespace wellspring::test {
namespace {

constexpr size_t ept_point_bytes = 12 + 2 + 6 + 1 + 8;

// Makes points of a node: x counts from `first` on.
std::string ept_node(int first, int count) {
  std::string bytes(size_t(count) * ept_point_bytes, '\0');
  for (int i = 0; i < count; i++) {
    const size_t at = size_t(i) * ept_point_bytes;
    put_at(bytes, at, glm::ivec3(first + i, 2, -3));
    put_at(bytes, at + 12, uint16_t(first + i));
    put_at(bytes, at + 14, std::array<uint16_t, 3>{uint16_t(first + i), 500, 65535});
    put_at(bytes, at + 20, uint8_t(6));
    put_at(bytes, at + 21, double(first) + 0.25);
  }
  return bytes;
}

std::string pack_zstd(const std::string& bytes) {
  std::string packed(ZSTD_compressBound(bytes.size()), '\0');
  packed.resize(ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), 3));
  return packed;
}

struct MadeEpt {
  Folder folder;
  std::string kind = "binary";
  int points = 10;
  std::map<std::string, std::string> hierarchy{
      {"0-0-0-0", R"({"0-0-0-0": 5, "1-0-0-0": 2, "1-1-0-1": -1, "1-1-1-1": 0})"},
      {"1-1-0-1", R"({"1-1-0-1": 2, "2-3-1-2": 1})"}};
  std::map<std::string, std::string> nodes{{"0-0-0-0", ept_node(0, 5)},
                                           {"1-0-0-0", ept_node(100, 2)},
                                           {"1-1-0-1", ept_node(200, 2)},
                                           {"2-3-1-2", ept_node(300, 1)}};

  void write() const {
    for (const char* name : {"ept-data", "ept-hierarchy"})
      std::filesystem::create_directories(folder.path / name);
    folder.write("ept.json", fmt::format(R"({{"version": "1.0.0", "dataType": "{}",
      "hierarchyType": "json", "points": {}, "bounds": [0, 0, -4, 400, 400, 396],
      "boundsConforming": [5000000, 1, -1, 5000003, 3, 0], "span": 128,
      "srs": {{"wkt": "PROJCS[\"a\",PROJECTION[\"b\"],\n UNIT[\"foot\",0.3048]]"}},
      "schema": [
        {{"name": "X", "type": "signed", "size": 4, "scale": 0.01, "offset": 5000000}},
        {{"name": "Y", "type": "signed", "size": 4, "scale": 0.01}},
        {{"name": "Z", "type": "signed", "size": 4, "scale": 0.5}},
        {{"name": "Intensity", "type": "unsigned", "size": 2}},
        {{"name": "Red", "type": "unsigned", "size": 2}},
        {{"name": "Green", "type": "unsigned", "size": 2}},
        {{"name": "Blue", "type": "unsigned", "size": 2}},
        {{"name": "Classification", "type": "unsigned", "size": 1}},
        {{"name": "GpsTime", "type": "floating", "size": 8}}]}})",
                                         kind, points));
    for (const auto& [name, text] : hierarchy)
      folder.write("ept-hierarchy/" + name + ".json", text);
    for (const auto& [name, bytes] : nodes) {
      const bool is_packed = kind == "zstandard";
      folder.write("ept-data/" + name + (is_packed ? ".zst" : ".bin"),
                   is_packed ? pack_zstd(bytes) : bytes);
    }
  }
  // Returns what the refusal says; empty: it was read.
  std::string refusal() const {
    write();
    try {
      read_all_points(*open_ept(folder.path.string()));
    } catch (const LoadError& error) {
      return error.what();
    }
    return "";
  }
};

}  // namespace

TEST(LasEpt, reads_each_node_once) {
  for (const char* kind : {"binary", "zstandard"})
    for (const size_t at_once : {1, 3, 1000}) {
      MadeEpt made;
      made.kind = kind;
      made.write();
      const auto source = open_ept(made.folder.file("ept.json"));
      EXPECT_EQ(source->info().points, 10u);
      EXPECT_EQ(source->info().unit, 0.3048);
      EXPECT_EQ(source->info().low, dvec3(5000000, 1, -1));
      EXPECT_EQ(source->info().color_max, 0);
      const PointBlock points = read_all_points(*source, at_once);
      ASSERT_EQ(points.size(), 10u);
      EXPECT_EQ(points.intensity, (std::vector<uint16_t>{0, 1, 2, 3, 4, 100, 101, 200, 201, 300}));
      EXPECT_NEAR(points.place[9].x, 5000003, 1e-8);
      EXPECT_EQ(points.place[9].z, -1.5);
      EXPECT_EQ(points.color[6], (std::array<uint16_t, 3>{101, 500, 65535}));
      EXPECT_EQ(points.classification[3], 6);
      EXPECT_EQ(points.time[9], 300.25);
    }
}

TEST(LasEpt, reads_nodes_of_laz_files) {
  if (scans_folder().empty()) GTEST_SKIP() << "WELLSPRING_DATA has no 10_exhibits/scans";
  const std::filesystem::path laz = scans_folder() / "pdal/apps/simple.laz";
  MadeEpt made;
  made.kind = "laszip";
  made.points = 2130;
  made.hierarchy = {{"0-0-0-0", R"({"0-0-0-0": 1065, "1-0-0-1": 1065})"}};
  made.write();
  for (const char* name : {"0-0-0-0", "1-0-0-1"})
    std::filesystem::copy_file(laz, made.folder.path / "ept-data" / (std::string(name) + ".laz"));
  const auto source = open_ept(made.folder.path.string());
  EXPECT_TRUE(source->info().fields.color);
  const PointBlock points = read_all_points(*source);
  ASSERT_EQ(points.size(), 2130u);
  EXPECT_EQ(points.color.size(), 2130u);
  EXPECT_EQ(points.place[0], points.place[1065]);
  made.points = 2129;
  made.hierarchy = {{"0-0-0-0", R"({"0-0-0-0": 1064, "1-0-0-1": 1065})"}};
  EXPECT_NE(made.refusal().find("promises 1065 points, the tree says 1064"), std::string::npos);
}

TEST(LasEpt, trees_that_go_in_circles_are_refused) {
  const auto refusal = [](std::map<std::string, std::string> hierarchy) {
    MadeEpt made;
    made.hierarchy = std::move(hierarchy);
    return made.refusal();
  };
  EXPECT_NE(refusal({{"0-0-0-0", R"({"0-0-0-0": -1})"}}).find("refers to itself"),
            std::string::npos);
  EXPECT_NE(
      refusal({{"0-0-0-0", R"({"0-0-0-0": 5, "1-1-0-1": -1})"}, {"1-1-0-1", R"({"1-1-0-1": -1})"}})
          .find("refers to itself"),
      std::string::npos);
  EXPECT_NE(refusal({{"0-0-0-0", R"({"0-0-0-0": 5, "1-1-0-1": -1})"},
                     {"1-1-0-1", R"({"1-1-0-1": 2, "0-0-0-0": 5})"}})
                .find("does not lie below 1-1-0-1"),
            std::string::npos);
  EXPECT_NE(refusal({{"0-0-0-0", R"({"0-0-0-0": 5, "1-1-0-1": 2, "2-3-1-2": -1})"},
                     {"2-3-1-2", R"({"2-3-1-2": 1})"},
                     {"1-1-0-1", R"({"1-1-0-1": 2})"}}),
            "");
  EXPECT_NE(refusal({{"0-0-0-0", R"({"0-0-0-0": 3, "1-1-0-1": 2, "1-1-0-1 ": 2})"}})
                .find("is no node's name"),
            std::string::npos);
  EXPECT_NE(refusal({{"0-0-0-0", R"({"0-0-0-0": 3, "2-1-0-1": -1, "1-0-0-0": -1})"},
                     {"1-0-0-0", R"({"1-0-0-0": 3, "2-1-0-1": 3})"},
                     {"2-1-0-1", R"({"2-1-0-1": 3})"}})
                .find("appears twice"),
            std::string::npos);
}

TEST(LasEpt, lying_counts_are_refused) {
  const auto refusal = [](const std::function<void(MadeEpt&)>& change) {
    MadeEpt made;
    change(made);
    return made.refusal();
  };
  EXPECT_EQ(refusal([](MadeEpt&) {}), "");
  EXPECT_NE(refusal([](MadeEpt& made) { made.points = 11; }).find("says 11, the nodes have 10"),
            std::string::npos);
  EXPECT_NE(refusal([](MadeEpt& made) { made.points = 9; }).find("one too many"),
            std::string::npos);
  EXPECT_NE(refusal([](MadeEpt& made) {
              made.hierarchy["1-1-0-1"] = R"({"1-1-0-1": 2, "2-3-1-2": 5000000000})";
            }).find("has 5000000000 points"),
            std::string::npos);
  EXPECT_NE(refusal([](MadeEpt& made) {
              made.hierarchy["1-1-0-1"] = R"({"1-1-0-1": 2, "2-3-1-2": -7})";
            }),
            "");
  EXPECT_NE(refusal([](MadeEpt& made) { made.hierarchy.erase("1-1-0-1"); }), "");
  EXPECT_NE(refusal([](MadeEpt& made) { made.nodes.erase("2-3-1-2"); }), "");
  for (const char* kind : {"binary", "zstandard"})
    for (const int count : {1, 3}) {
      const std::string said = refusal([&](MadeEpt& made) {
        made.kind = kind;
        made.nodes["1-0-0-0"] = ept_node(100, count);
      });
      EXPECT_NE(said.find("1-0-0-0"), std::string::npos) << said;
    }
  EXPECT_NE(refusal([](MadeEpt& made) {
              made.kind = "zstandard";
              made.write();
              made.nodes.clear();
              made.folder.write("ept-data/0-0-0-0.zst", "no frame at all");
            }).find("is not packed by Zstandard"),
            std::string::npos);
}

TEST(LasEpt, a_damaged_description_is_refused) {
  const Folder folder;
  EXPECT_THROW(open_ept(folder.path.string()), LoadError);
  for (
      const char* text :
      {"[]", "{}", R"({"dataType": "binary", "points": 1})",
       R"({"dataType": "paper", "points": 1, "schema": [{"name": "X", "type": "signed", "size": 4}]})",
       R"({"dataType": "binary", "points": 1, "schema": [{"name": "X", "type": "float", "size": 3}]})",
       R"({"dataType": "binary", "points": -1, "schema": [{"name": "X", "type": "float", "size": 4}]})"}) {
    folder.write("ept.json", text);
    EXPECT_THROW(open_ept(folder.path.string()), LoadError) << text;
  }
}

}  // namespace wellspring::test
