// SPDX-License-Identifier: Apache-2.0
#include "avatar/load/x3d_mesh.h"

#include <algorithm>
#include <cstring>
#include <numeric>
#include <unordered_map>

#include "base/load_error.h"

namespace wellspring::avatar {
namespace {

constexpr size_t max_corners = 6'000'000;

struct Corner {
  int point = 0, normal = -1, uv = -1, color = -1;  // indices into their nodes' arrays; -1: none
};

// Holds polygons as one run of corners.
struct Faces {
  std::vector<Corner> corners;
  std::vector<uint32_t> first{0};  // face f has corners first[f] .. first[f + 1]
  size_t count() const { return first.size() - 1; }
};

vec3 safe_normalize(vec3 v, vec3 otherwise) {
  float length = glm::length(v);
  return length > 1e-20f && std::isfinite(length) ? v / length : otherwise;
}

// Returns the area-weighted normal of any polygon by Newell's method.
vec3 polygon_normal(const Faces& faces, size_t face, const std::vector<vec3>& points) {
  vec3 sum(0);
  uint32_t begin = faces.first[face], end = faces.first[face + 1];
  for (uint32_t i = begin; i < end; i++) {
    vec3 a = points[size_t(faces.corners[i].point)];
    vec3 b = points[size_t(faces.corners[i + 1 < end ? i + 1 : begin].point)];
    sum += vec3((a.y - b.y) * (a.z + b.z), (a.z - b.z) * (a.x + b.x), (a.x - b.x) * (a.y + b.y));
  }
  return sum * 0.5f;
}

// Returns each corner's normal: the mean of the faces around its point that turn away less than the
// crease angle (X3D 4, 11.2.3).
std::vector<vec3> crease_normals(const Faces& faces, const std::vector<vec3>& points,
                                 float crease) {
  size_t count = faces.count();
  std::vector<vec3> area(count), unit(count);
  std::vector<uint32_t> first(points.size() + 1, 0), around(faces.corners.size());
  for (const Corner& corner : faces.corners) first[size_t(corner.point) + 1]++;
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<uint32_t> fill(first.begin(), first.end() - 1);
  for (size_t f = 0; f < count; f++) {
    area[f] = polygon_normal(faces, f, points);
    unit[f] = safe_normalize(area[f], vec3(0, 1, 0));
    for (uint32_t i = faces.first[f]; i < faces.first[f + 1]; i++)
      around[fill[size_t(faces.corners[i].point)]++] = uint32_t(f);
  }
  float limit = std::cos(std::min(crease, pi)) - 1e-5f;
  std::vector<vec3> normals(faces.corners.size());
  for (size_t f = 0; f < count; f++)
    for (uint32_t i = faces.first[f]; i < faces.first[f + 1]; i++) {
      size_t p = size_t(faces.corners[i].point);
      vec3 sum(0);
      // A hub of very many faces would cost their square, so it keeps its face normals.
      if (crease > 0 && first[p + 1] - first[p] <= 512)
        for (uint32_t k = first[p]; k < first[p + 1]; k++)
          if (crease >= pi || dot(unit[around[k]], unit[f]) >= limit) sum += area[around[k]];
      normals[i] = safe_normalize(sum, unit[f]);
    }
  return normals;
}

// Cuts the ears of one polygon, projected along its normal; a rest that cannot be cut (crossing
// edges) becomes a fan.
void cut_polygon(const Faces& faces, size_t face, const std::vector<vec3>& points, bool convex,
                 const std::vector<uint32_t>& vertex_of, std::vector<uvec3>& out) {
  uint32_t begin = faces.first[face], n = faces.first[face + 1] - begin;
  auto emit = [&](uint32_t a, uint32_t b, uint32_t c) {
    uvec3 t(vertex_of[begin + a], vertex_of[begin + b], vertex_of[begin + c]);
    if (t.x != t.y && t.y != t.z && t.z != t.x) out.push_back(t);
  };
  if (n == 3 || convex || n > 1000) {
    for (uint32_t i = 1; i + 1 < n; i++) emit(0, i, i + 1);
    return;
  }
  vec3 normal = safe_normalize(polygon_normal(faces, face, points), vec3(0, 1, 0));
  vec3 axis = std::abs(normal.x) < 0.7f ? vec3(1, 0, 0) : vec3(0, 1, 0);
  vec3 u = normalize(cross(axis, normal)), v = cross(normal, u);
  std::vector<vec2> flat(n);
  std::vector<uint32_t> left(n);
  for (uint32_t i = 0; i < n; i++) {
    vec3 p = points[size_t(faces.corners[begin + i].point)];
    flat[i] = {dot(p, u), dot(p, v)};
    left[i] = i;
  }
  auto area = [](vec2 a, vec2 b, vec2 c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  };
  while (left.size() > 3) {
    size_t m = left.size(), ear = m;
    for (size_t i = 0; i < m && ear == m; i++) {
      vec2 a = flat[left[(i + m - 1) % m]], b = flat[left[i]], c = flat[left[(i + 1) % m]];
      if (area(a, b, c) <= 0) continue;
      bool empty = true;
      for (size_t k = 0; k < m && empty; k++) {
        if (k == i || k == (i + 1) % m || k == (i + m - 1) % m) continue;
        vec2 p = flat[left[k]];
        if (p == a || p == b || p == c) continue;
        empty = !(area(a, b, p) >= 0 && area(b, c, p) >= 0 && area(c, a, p) >= 0);
      }
      if (empty) ear = i;
    }
    if (ear == m) break;
    emit(left[(ear + m - 1) % m], left[ear], left[(ear + 1) % m]);
    left.erase(left.begin() + ptrdiff_t(ear));
  }
  for (size_t i = 1; i + 1 < left.size(); i++) emit(left[0], left[i], left[i + 1]);
}

// Makes the default mapping of X3D 4, 11.2.2: s along the longest side of the bounding box, t along
// the second.
std::vector<vec2> default_uv(const X3dMesh& mesh) {
  vec3 low(INFINITY), high(-INFINITY);
  for (vec3 p : mesh.points) low = glm::min(low, p), high = glm::max(high, p);
  vec3 size = high - low;
  int order[3] = {0, 1, 2};
  std::stable_sort(order, order + 3, [&](int a, int b) { return size[a] > size[b]; });
  float longest = std::max(size[order[0]], 1e-20f);
  std::vector<vec2> uv(mesh.point_of.size());
  for (size_t i = 0; i < uv.size(); i++) {
    vec3 p = (mesh.points[mesh.point_of[i]] - low) / longest;
    uv[i] = {p[order[0]], p[order[1]]};
  }
  return uv;
}

struct MeshReader {
  X3dFile& file;
  const X3dNode& node;
  X3dMesh& mesh;
  size_t dropped = 0;

  // Adds a polygon unless an index lies out of range.
  void add_face(Faces& faces, const std::vector<Corner>& face) {
    bool good = face.size() >= 3;
    for (const Corner& corner : face)
      good = good && corner.point >= 0 && size_t(corner.point) < mesh.points.size();
    if (!good) {
      dropped += face.size() >= 3;
      return;
    }
    if (faces.corners.size() + face.size() > max_corners)
      throw LoadError(file.path, where(node),
                      "has more than " + std::to_string(max_corners) + " corners");
    faces.corners.insert(faces.corners.end(), face.begin(), face.end());
    faces.first.push_back(uint32_t(faces.corners.size()));
  }

  // Reads the faces of an index list, which are ended by -1, or by fixed counts.
  Faces read_faces(bool& convex) {
    const std::string& type = node.type;
    bool flip = !bool_of(node, "ccw", true);
    bool indexed = type.rfind("Indexed", 0) == 0;
    bool face_set = type == "IndexedFaceSet";
    std::vector<int> index = ints_of(file, node, face_set ? "coordIndex" : "index");
    if (!indexed) {
      index.resize(mesh.points.size());
      std::iota(index.begin(), index.end(), 0);
    }
    Faces faces;
    std::vector<Corner> run;
    auto add = [&](std::vector<Corner> face) {
      if (flip) std::reverse(face.begin(), face.end());
      add_face(faces, face);
    };
    if (face_set) {
      convex = bool_of(node, "convex", true);
      std::vector<int> normal_index = ints_of(file, node, "normalIndex");
      std::vector<int> uv_index = ints_of(file, node, "texCoordIndex");
      std::vector<int> color_index = ints_of(file, node, "colorIndex");
      bool normal_per_vertex = bool_of(node, "normalPerVertex", true);
      bool color_per_vertex = bool_of(node, "colorPerVertex", true);
      int face = 0;
      index.push_back(-1);
      for (size_t i = 0; i < index.size(); i++) {
        if (index[i] < 0) {
          add(run);
          face += !run.empty();
          run.clear();
          continue;
        }
        auto pick = [&](const std::vector<int>& list, size_t at, int otherwise) {
          return list.empty() ? otherwise : at < list.size() ? list[at] : -1;
        };
        Corner corner{index[i], -1, pick(uv_index, i, index[i]), -1};
        corner.normal = normal_per_vertex ? pick(normal_index, i, index[i])
                                          : pick(normal_index, size_t(face), face);
        corner.color = color_per_vertex ? pick(color_index, i, index[i])
                                        : pick(color_index, size_t(face), face);
        run.push_back(corner);
      }
      return faces;
    }
    auto corner = [&](size_t i) { return Corner{index[i], index[i], index[i], index[i]}; };
    if (type.find("Triangle") != std::string::npos && type.find("Strip") == std::string::npos &&
        type.find("Fan") == std::string::npos) {
      for (size_t i = 0; i + 2 < index.size(); i += 3)
        add({corner(i), corner(i + 1), corner(i + 2)});
    } else if (type.find("Quad") != std::string::npos) {
      for (size_t i = 0; i + 3 < index.size(); i += 4)
        add({corner(i), corner(i + 1), corner(i + 2), corner(i + 3)});
    } else {
      bool strip = type.find("Strip") != std::string::npos;
      std::vector<std::pair<size_t, size_t>> runs;
      if (indexed) {
        size_t start = 0;
        for (size_t i = 0; i <= index.size(); i++)
          if (i == index.size() || index[i] < 0) runs.push_back({start, i}), start = i + 1;
      } else {
        size_t start = 0;
        for (int count : ints_of(file, node, strip ? "stripCount" : "fanCount")) {
          size_t stop = std::min(index.size(), start + size_t(std::max(count, 0)));
          runs.push_back({start, stop});
          start = stop;
        }
      }
      for (auto [start, stop] : runs)
        for (size_t i = start; i + 2 < stop; i++) {
          if (!strip) add({corner(start), corner(i + 1), corner(i + 2)});
          else if ((i - start) % 2 == 0) add({corner(i), corner(i + 1), corner(i + 2)});
          else add({corner(i + 1), corner(i), corner(i + 2)});
        }
    }
    return faces;
  }

  std::vector<vec3> read_normals(const Faces& faces) {
    int normal_node = find_child(file, node, "normal", {"Normal"});
    if (normal_node >= 0) {
      std::vector<vec3> given = points_of(file, file.nodes[size_t(normal_node)], "vector");
      bool per_vertex = bool_of(node, "normalPerVertex", true) || node.type == "IndexedFaceSet";
      std::vector<vec3> normals(faces.corners.size());
      bool good = !given.empty();
      for (size_t f = 0; f < faces.count() && good; f++) {
        vec3 flat = safe_normalize(polygon_normal(faces, f, mesh.points), vec3(0, 1, 0));
        for (uint32_t i = faces.first[f]; i < faces.first[f + 1]; i++) {
          int n = per_vertex ? faces.corners[i].normal : int(f);
          good = good && n >= 0 && size_t(n) < given.size();
          if (good) normals[i] = safe_normalize(given[size_t(n)], flat);
        }
      }
      if (good) return normals;
      warn_once(file.warnings, where(node) + ": too few normals, made from the faces instead");
    }
    float crease = 0;
    if (node.type == "IndexedFaceSet") crease = float_of(file, node, "creaseAngle", 0);
    else if (node.type.rfind("Indexed", 0) == 0 && bool_of(node, "normalPerVertex", true))
      crease = pi;
    return crease_normals(faces, mesh.points, crease);
  }

  // Returns the colours that corners index; empty: there are none, or too few.
  std::vector<vec4> read_colors(const Faces& faces) {
    int color = find_child(file, node, "color", {"Color", "ColorRGBA"});
    if (color < 0) return {};
    const X3dNode& given = file.nodes[size_t(color)];
    std::vector<float> values = floats_of(file, given, "color");
    const size_t step = given.type == "ColorRGBA" ? 4 : 3;
    std::vector<vec4> colors;
    for (size_t i = 0; i + step <= values.size(); i += step)
      colors.push_back(
          glm::clamp(vec4(values[i], values[i + 1], values[i + 2], step == 4 ? values[i + 3] : 1),
                     vec4(0), vec4(1)));
    for (const Corner& corner : faces.corners)
      if (corner.color < 0 || size_t(corner.color) >= colors.size()) {
        warn_once(file.warnings,
                  where(node) + ": too few colours, the material's is shown instead");
        return {};
      }
    return colors;
  }

  void read() {
    int coordinate = find_child(file, node, "coord", {"Coordinate", "CoordinateDouble"});
    if (coordinate < 0) {
      warn_once(file.warnings, where(node) + ": has no Coordinate");
      return;
    }
    mesh.coordinate = coordinate;
    mesh.points = points_of(file, file.nodes[size_t(coordinate)], "point");
    mesh.solid = bool_of(node, "solid", true);
    bool convex = true;
    Faces faces = read_faces(convex);
    if (dropped)
      warn_once(file.warnings, where(node) + ": " + std::to_string(dropped) +
                                   " faces with an index out of range are left out");
    std::vector<vec3> normals = read_normals(faces);
    std::vector<vec2> given_uv;
    int uv_node =
        find_child(file, node, "texCoord", {"TextureCoordinate", "MultiTextureCoordinate"});
    if (uv_node >= 0 && file.nodes[size_t(uv_node)].type == "MultiTextureCoordinate")
      uv_node = find_child(file, file.nodes[size_t(uv_node)], "texCoord", {"TextureCoordinate"});
    if (uv_node >= 0 && file.nodes[size_t(uv_node)].type == "TextureCoordinate") {
      std::vector<float> v = floats_of(file, file.nodes[size_t(uv_node)], "point");
      for (size_t i = 0; i + 1 < v.size(); i += 2) given_uv.push_back({v[i], v[i + 1]});
    }
    if (uv_node >= 0 && given_uv.empty())
      warn_once(file.warnings, where(node) + ": texture coordinates of type " +
                                   file.nodes[size_t(uv_node)].type +
                                   " are not used, X3D's own are made instead");
    weld(faces, normals, given_uv, read_colors(faces), convex);
    if (given_uv.empty()) mesh.uv = default_uv(mesh);
  }

  void weld(const Faces& faces, const std::vector<vec3>& normals, const std::vector<vec2>& given_uv,
            const std::vector<vec4>& colors, bool convex) {
    struct Key {
      uint32_t word[10];
      bool operator==(const Key& other) const {
        return std::memcmp(word, other.word, sizeof word) == 0;
      }
    };
    struct Hash {
      size_t operator()(const Key& key) const {
        uint64_t h = 0x9e3779b97f4a7c15ull;
        for (uint32_t w : key.word) h = (h ^ w) * 0x100000001b3ull ^ (h >> 29);
        return size_t(h);
      }
    };
    std::unordered_map<Key, uint32_t, Hash> vertices;
    std::vector<uint32_t> vertex_of(faces.corners.size());
    for (size_t i = 0; i < faces.corners.size(); i++) {
      const Corner& corner = faces.corners[i];
      vec2 uv(0);
      if (corner.uv >= 0 && size_t(corner.uv) < given_uv.size()) uv = given_uv[size_t(corner.uv)];
      vec3 n = glm::round(normals[i] *
                          4096.0f);  // normals of one smooth surface differ in their last bits
      int32_t q[3] = {int32_t(n.x), int32_t(n.y), int32_t(n.z)};
      Key key{};
      key.word[0] = uint32_t(corner.point);
      std::memcpy(&key.word[1], q, 12);
      std::memcpy(&key.word[4], &uv, 8);
      if (!colors.empty()) std::memcpy(&key.word[6], &colors[size_t(corner.color)], 16);
      auto [place, added] = vertices.emplace(key, uint32_t(mesh.point_of.size()));
      if (added) {
        mesh.point_of.push_back(uint32_t(corner.point));
        mesh.normals.push_back(normals[i]);
        if (!given_uv.empty()) mesh.uv.push_back(uv);
        if (!colors.empty()) mesh.colors.push_back(colors[size_t(corner.color)]);
      }
      vertex_of[i] = place->second;
    }
    for (size_t f = 0; f < faces.count(); f++)
      cut_polygon(faces, f, mesh.points, convex, vertex_of, mesh.triangles);
  }
};

}  // namespace

X3dMesh make_x3d_mesh(X3dFile& file, int geometry) {
  const X3dNode& node = file.nodes[size_t(geometry)];
  X3dMesh mesh;
  for (const char* type : {"Box", "Sphere", "Cylinder", "Cone"})
    if (node.type == type) return make_x3d_primitive(file, node);
  for (const char* type :
       {"IndexedFaceSet", "IndexedTriangleSet", "TriangleSet", "IndexedTriangleStripSet",
        "TriangleStripSet", "IndexedTriangleFanSet", "TriangleFanSet", "IndexedQuadSet", "QuadSet"})
    if (node.type == type) {
      MeshReader{file, node, mesh}.read();
      return mesh;
    }
  return mesh;
}

// Makes Box, Sphere, Cylinder and Cone of X3D 4, clause 13.

namespace {

constexpr int around = 24, along = 12;

// This is a point (radius, y, normal_r, normal_y) of the profile of a surface of revolution about
// +Y.
struct ProfilePoint {
  float radius, y, normal_radius, normal_y, t;
};

void add_vertex(X3dMesh& mesh, vec3 position, vec3 normal, vec2 uv) {
  mesh.point_of.push_back(uint32_t(mesh.points.size()));
  mesh.points.push_back(position);
  mesh.normals.push_back(normal);
  mesh.uv.push_back(uv);
}

// Revolves a profile, which runs from low to high so that the outside is the front.
void revolve(X3dMesh& mesh, const std::vector<ProfilePoint>& profile) {
  uint32_t first = uint32_t(mesh.points.size()), columns = around + 1;
  for (const ProfilePoint& p : profile)
    for (int i = 0; i <= around; i++) {
      float angle = 2 * pi * float(i) / around;  // starts at the back, as textures do
      vec3 out(-std::sin(angle), 0, -std::cos(angle));
      vec3 normal = out * p.normal_radius + vec3(0, p.normal_y, 0);
      add_vertex(mesh, out * p.radius + vec3(0, p.y, 0), normal, {float(i) / around, p.t});
    }
  for (uint32_t row = 0; row + 1 < profile.size(); row++)
    for (uint32_t i = 0; i < uint32_t(around); i++) {
      uint32_t a = first + row * columns + i, b = a + 1, c = a + columns, d = c + 1;
      if (profile[row].radius > 0) mesh.triangles.push_back({a, b, d});
      if (profile[row + 1].radius > 0) mesh.triangles.push_back({a, d, c});
    }
}

}  // namespace

X3dMesh make_x3d_primitive(const X3dFile& file, const X3dNode& node) {
  X3dMesh mesh;
  mesh.solid = bool_of(node, "solid", true);
  if (node.type == "Box") {
    vec3 half = 0.5f * glm::abs(vec3_of(file, node, "size", vec3(2)));
    for (int axis = 0; axis < 3; axis++)
      for (float side : {-1.0f, 1.0f}) {
        vec3 n(0), u(0), v(0);
        n[axis] = side;
        u[(axis + 1) % 3] = side;
        v[(axis + 2) % 3] = 1;
        uint32_t first = uint32_t(mesh.points.size());
        for (vec2 c : {vec2(-1, -1), vec2(1, -1), vec2(1, 1), vec2(-1, 1)})
          add_vertex(mesh, (n + u * c.x + v * c.y) * half, n, c * 0.5f + 0.5f);
        mesh.triangles.push_back({first, first + 1, first + 2});
        mesh.triangles.push_back({first, first + 2, first + 3});
      }
    return mesh;
  }
  std::vector<ProfilePoint> side;
  float radius = std::abs(float_of(file, node, node.type == "Cone" ? "bottomRadius" : "radius", 1));
  float half = 0.5f * std::abs(float_of(file, node, "height", 2));
  if (node.type == "Sphere") {
    for (int i = 0; i <= along; i++) {
      float t = float(i) / along, angle = (t - 0.5f) * pi;
      float c = i == 0 || i == along ? 0 : std::cos(angle), s = std::sin(angle);
      side.push_back({radius * c, radius * s, c, s, t});
    }
    revolve(mesh, side);
    return mesh;
  }
  bool cone = node.type == "Cone";
  float slope = glm::length(vec2(2 * half, radius)), top_radius = cone ? 0 : radius;
  float normal_radius = cone && slope > 0 ? 2 * half / slope : 1;
  float normal_y = cone && slope > 0 ? radius / slope : 0;
  if (bool_of(node, "side", true))
    revolve(mesh, {{radius, -half, normal_radius, normal_y, 0},
                   {top_radius, half, normal_radius, normal_y, 1}});
  if (bool_of(node, "bottom", true))
    revolve(mesh, {{0, -half, 0, -1, 0}, {radius, -half, 0, -1, 1}});
  if (!cone && bool_of(node, "top", true))
    revolve(mesh, {{radius, half, 0, 1, 0}, {0, half, 0, 1, 1}});
  return mesh;
}

}  // namespace wellspring::avatar
