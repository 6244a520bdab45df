// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <limits>

#include "base/load_error.h"
#include "compare_solids.h"
#include "volume/compare/mesh_file.h"

namespace wellspring::test {
namespace {

SurfaceMesh read_mesh_of(const std::string& bytes, const std::string& ending) {
  const std::string file = "/tmp/wellspring_mesh_" + std::to_string(getpid()) + ending;
  std::ofstream(file, std::ios::binary) << bytes;
  try {
    SurfaceMesh mesh = read_mesh_file(file, 0.001);
    unlink(file.c_str());
    return mesh;
  } catch (...) {
    unlink(file.c_str());
    throw;
  }
}

template <class Number>
void put(std::string& bytes, Number number, bool swapped = false) {
  std::string raw(reinterpret_cast<const char*>(&number), sizeof number);
  if (swapped) std::reverse(raw.begin(), raw.end());
  bytes += raw;
}

std::string binary_stl(uint32_t count, uint32_t promised) {
  std::string bytes = "solid, but binary";
  bytes.resize(80, ' ');
  put(bytes, promised);
  for (uint32_t i = 0; i < count; i++) {
    for (float number : {0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 2.f, 0.f, 0.f, 0.f, 3.f, float(i)})
      put(bytes, number);
    put(bytes, uint16_t(0));
  }
  return bytes;
}

TEST(CompareMeshFile, StlOfBothKindsIsRead) {
  const SurfaceMesh binary = read_mesh_of(binary_stl(2, 2), ".stl");
  ASSERT_EQ(binary.triangles.size(), 2u);
  EXPECT_EQ(binary.positions.size(), 4u);  // welded
  EXPECT_EQ(binary.positions[2], dvec3(0, 0.003, 0));
  const SurfaceMesh text = read_mesh_of(
      "solid a b\nfacet normal 0 0 1\n outer loop\n  vertex 0 0 0\n  vertex 2e0 +0 0\n  vertex 0 3 "
      "-1.5\n endloop\nendfacet\nendsolid a b\n",
      ".STL");
  ASSERT_EQ(text.triangles.size(), 1u);
  EXPECT_EQ(text.positions[2], dvec3(0, 0.003, -0.0015));
}

TEST(CompareMeshFile, PlyOfAllKindsIsRead) {
  const std::string elements =
      "comment made by hand\nelement vertex 4\nproperty float x\nproperty uchar red\nproperty "
      "float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\n"
      "element edge 0\nproperty int a\nend_header\n";
  for (const std::string form : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    std::string bytes = "ply\nformat " + form + " 1.0\n" + elements;
    if (form == "ascii") {
      bytes += "0 9 0 0\n1 9 0 0\n1 9 1 0\n0 9 1 0.5\n4 0 1 2 3\n";
    } else {
      const bool big = form == "binary_big_endian";
      for (const auto& [x, y, z] : {std::tuple{0.f, 0.f, 0.f}, std::tuple{1.f, 0.f, 0.f},
                                    std::tuple{1.f, 1.f, 0.f}, std::tuple{0.f, 1.f, 0.5f}}) {
        put(bytes, x, big), put(bytes, uint8_t(9)), put(bytes, y, big), put(bytes, z, big);
      }
      put(bytes, uint8_t(4));
      for (int i = 0; i < 4; i++) put(bytes, i, big);
    }
    const SurfaceMesh mesh = read_mesh_of(bytes, ".ply");
    ASSERT_EQ(mesh.triangles.size(), 2u) << form;
    EXPECT_EQ(mesh.triangles[1], uvec3(0, 2, 3));
    EXPECT_EQ(mesh.positions[3], dvec3(0, 0.001, 0.0005));
  }
}

TEST(CompareMeshFile, WrongFilesAreNamed) {
  const std::string header = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n";
  const std::string face = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  for (const auto& [bytes, ending] :
       {std::pair{std::string(), ".stl"},
        {std::string("PK\3\4"), ".stl"},
        {binary_stl(1, 2), ".stl"},
        {"\1" + binary_stl(1, 4000000000u).substr(1), ".stl"},
        {std::string("solid\nvertex 1 2 x\n"), ".stl"},
        {std::string("solid\nvertex 1 2 3\n"), ".stl"},
        {std::string("solid\nendsolid\n"), ".stl"},
        {std::string("ply\n"), ".ply"},
        {std::string("plx\n"), ".ply"},
        {header + face + "0\n1\n2\n3 0 1 7\n", ".ply"},
        {header + face + "0\n1\n2\n3 0 1 -1\n", ".ply"},
        {header + face + "0\n1\n2\n99999999 0\n", ".ply"},
        {header + face + "0\n1\n", ".ply"},
        {std::string("ply\nformat ascii 1.0\nelement vertex 99999999999999\nproperty float x\n") +
             face + "0\n",
         ".ply"}})
    EXPECT_THROW(read_mesh_of(bytes, ending), LoadError) << bytes.substr(0, 120);
  EXPECT_THROW(read_mesh_file("/nowhere.stl", 1), LoadError);
}

TEST(CompareMeshFile, NamesTellTheKind) {
  EXPECT_TRUE(is_mesh_file("a/b.STL"));
  EXPECT_TRUE(is_mesh_file("b.ply"));
  EXPECT_FALSE(is_mesh_file("stl"));
  EXPECT_FALSE(is_mesh_file("b.glb"));
}

TEST(CompareMesh, ACubesCornersHaveNormalsThatNoCutChanges) {
  for (int squares : {1, 3}) {
    const SurfaceMesh mesh = box_mesh(dvec3(0), dvec3(6), squares);
    EXPECT_EQ(mesh.positions.size(), size_t(squares == 1 ? 8 : 56));
    for (size_t i = 0; i < mesh.positions.size(); i++) {
      if (mesh.positions[i] != dvec3(0)) continue;
      for (int axis = 0; axis < 3; axis++)
        EXPECT_NEAR(mesh.normals[i][axis], -1 / std::sqrt(3.0), 1e-6);
    }
  }
}

TEST(CompareMesh, PointsCoverTheAreaEvenly) {
  const SurfaceMesh mesh = box_mesh(dvec3(0), dvec3(10), 1);
  const auto points = triangle_points(mesh, 0.5 * solid_voxel, 1'000'000);
  double area = 0;
  dvec3 middle(0);
  for (const SurfacePoint& point : points) area += point.area, middle += point.position;
  EXPECT_NEAR(area, 600e-6, 1e-9);
  EXPECT_LT(glm::distance(middle / double(points.size()), dvec3(5) * solid_voxel), 1e-9);
  EXPECT_EQ(points.size(), 12u * 29 * 29);
  EXPECT_LE(triangle_points(mesh, 0.5 * solid_voxel, 500).size(), 500u);
  EXPECT_EQ(triangle_points(mesh, 0.5 * solid_voxel, 1).size(), 12u);
}

TEST(CompareMesh, WhatHasNoAreaHasNoPoints) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  SurfaceMesh mesh{{dvec3(0), dvec3(1, 0, 0), dvec3(2, 0, 0), dvec3(none, 0, 0), dvec3(0, 1e300, 0),
                    dvec3(1e300, 0, 0), dvec3(0, 1, 0)},
                   {},
                   {{0, 1, 2}, {0, 0, 1}, {0, 1, 3}, {0, 4, 5}, {0, 1, 6}}};
  weld(mesh);
  EXPECT_EQ(flat_triangles(mesh), 4u);
  EXPECT_EQ(triangle_points(mesh, 10, 100).size(), 1u);
  const auto vertices = vertex_points(mesh);
  EXPECT_EQ(vertices[0].normal, vec3(0, 0, 1));
  EXPECT_EQ(vertices[2].normal, vec3(0));
  EXPECT_TRUE(triangle_points({}, 1, 1).empty());
}

TEST(CompareMesh, VerticesThatAreNotThereAreRefused) {
  SurfaceMesh mesh{{dvec3(0), dvec3(1, 0, 0)}, {}, {{0, 1, 2}}};
  EXPECT_THROW(weld(mesh), std::invalid_argument);
}

}  // namespace
}  // namespace wellspring::test
