// SPDX-License-Identifier: Apache-2.0
#include "gltf/primitive.h"

#include <algorithm>

#include "gltf/data.h"

namespace wellspring::gltf {
namespace {

std::vector<uvec3> read_triangles(File& file, const json& primitive, const std::string& where,
                                  size_t vertex_count) {
  int64_t mode = integer(primitive, "mode", 4);
  if (mode < 4) {
    warn(file, where, "points and lines are not drawn");
    return {};
  }
  const json* indices = find(primitive, "indices");
  const int64_t corners =
      indices ? form_of(file, indices->get<size_t>()).count : int64_t(vertex_count);
  const size_t count = size_t(mode == 4 ? corners / 3 : std::max<int64_t>(corners - 2, 0));
  if (count == 0) warn(file, where, "a primitive without triangles");
  if (mode == 4 && corners % 3 != 0)
    warn(file, where, "the number of indices is not a multiple of three; the rest is ignored");
  if ((file.triangles_made += int64_t(count)) > triangles_limit)
    refuse_beyond(file, where, triangles_limit, "triangles in all", fewer_triangles);
  std::vector<uint32_t> list;
  if (indices) {
    list = read_integers(file, indices->get<size_t>());
    for (size_t i = 0; i < list.size(); i++)
      if (list[i] >= vertex_count)
        refuse(file, where + "/indices",
               "element " + std::to_string(i) + " is vertex " + std::to_string(list[i]) + " of " +
                   std::to_string(vertex_count));
  } else {
    list.resize(vertex_count);
    for (size_t i = 0; i < vertex_count; i++) list[i] = uint32_t(i);
  }
  std::vector<uvec3> triangles;
  triangles.reserve(count);
  for (size_t i = 0; i < count; i++) {
    uvec3 t;  // section 3.7.2.1: the order keeps the winding
    if (mode == 4) t = {list[3 * i], list[3 * i + 1], list[3 * i + 2]};
    else if (mode == 5) t = {list[i], list[i + 1 + i % 2], list[i + 2 - i % 2]};
    else t = {list[i + 1], list[i + 2], list[0]};
    if (t.x != t.y && t.y != t.z && t.z != t.x) triangles.push_back(t);
  }
  if (triangles.size() < count / 2) triangles.shrink_to_fit();
  return triangles;
}

// Keeps only vertices that a triangle uses: exporters let many primitives share one long list.
void choose_vertices(File& file, const std::string& where, size_t vertex_count, Corners& corners) {
  constexpr uint32_t unseen = 0xffffffffu;
  std::vector<uint32_t>& renamed = file.renamed;
  if (renamed.size() < vertex_count) renamed.resize(vertex_count, unseen);
  for (uvec3& triangle : corners.triangles)
    for (int corner = 0; corner < 3; corner++) {
      uint32_t& name = renamed[triangle[corner]];
      if (name == unseen) {
        name = uint32_t(corners.used.size());
        corners.used.push_back(triangle[corner]);
      }
      triangle[corner] = name;
    }
  for (uint32_t vertex : corners.used) renamed[vertex] = unseen;
  if ((file.vertices_made += int64_t(corners.used.size())) > vertices_limit)
    refuse_beyond(file, where, vertices_limit, "vertices in all", fewer_vertices);
}

}  // namespace

Corners read_corners(File& file, const json& primitive, const std::string& where,
                     size_t vertex_count) {
  Corners corners;
  corners.triangles = read_triangles(file, primitive, where, vertex_count);
  choose_vertices(file, where, vertex_count, corners);
  return corners;
}

}  // namespace wellspring::gltf
