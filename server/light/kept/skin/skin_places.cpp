// SPDX-License-Identifier: Apache-2.0
// Finds where the light on what moves is kept (light/kept/skin/skin_light.h): places, the triangles
// around them and their neighbours.
#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "base/memory.h"
#include "base/rng.h"
#include "light/kept/skin/skin_light.h"
#include "world/surface.h"

namespace wellspring::light {
namespace {

constexpr float same_normal = 0.8f;    // cosine from which vertices at one position share light
constexpr float one_position = 1e-5f;  // as a share of the largest coordinate
// Weight of the other side of a thin thing. It is lit otherwise, but where no sample can
// find light, as at the root of a strand of hair, its light is better than black.
constexpr float other_side = 0.02f;
// Teeth and strands of hair that lie side by side and face one way: least cosine, and most weight
// in samples.
constexpr float beside_facing = 0.5f, most_beside = 4;
// Share of the most alike neighbour's weight: such neighbours join one group
constexpr float strong = 0.25f;
constexpr int most_levels = 12;
constexpr float most_reach = 0.004f, reach_share = 0.01f;  // metres; share of the root of the area
// Relative difference of light along an edge: for a turn of the normal, for each metre of distance,
// and in any case.
constexpr float by_normal = 1.2f, by_distance = 1 / 0.08f, anyway = 0.02f;

uint64_t hash_of(glm::ivec3 cell) {
  uint64_t xy = uint64_t(uint32_t(cell.x)) << 32 | uint32_t(cell.y);
  return mix64(mix64(xy) ^ uint32_t(cell.z));
}

vec3 unit_or_up(vec3 v) {
  float length2 = dot(v, v);
  return length2 > 1e-25f && std::isfinite(length2) ? v / std::sqrt(length2) : vec3(0, 1, 0);
}

struct Builder {
  const World& world;
  SkinLight& skin;
  std::vector<vec3> position, normal;              // one for each place, at rest, towards its side
  float near = 1;                                  // metres: positions no farther apart are one
  std::unordered_multimap<uint64_t, uint32_t> at;  // places, by position

  bool is_same(uint32_t place, uint32_t instance, vec3 p, vec3 n) const {
    vec3 apart = position[place] - p;
    return dot(apart, apart) <= near * near && dot(normal[place], n) > same_normal &&
           world.object_of(skin.places[place].instance) == world.object_of(instance);
  }

  uint32_t add_vertex(uint32_t instance, uint32_t vertex, bool back) {
    const Mesh& mesh = world.mesh_of(instance);
    vec3 p = mesh.positions[vertex], n = unit_or_up(mesh.normals[vertex]) * (back ? -1.0f : 1.0f);
    // Cells are twice as wide as `near`, so that only eight can hold the same position.
    bool known = is_finite(p);
    glm::ivec3 low(0);
    if (known) low = glm::ivec3(floor(p / (2 * near) - 0.5f));
    for (int k = 0; known && k < 8; k++) {
      auto [begin, end] = at.equal_range(hash_of(low + glm::ivec3(k & 1, k >> 1 & 1, k >> 2)));
      for (auto it = begin; it != end; ++it)
        if (is_same(it->second, instance, p, n)) return it->second;
    }
    uint32_t place = uint32_t(skin.places.size());
    skin.places.push_back({instance, vertex, back, 0});
    position.push_back(p), normal.push_back(n);
    if (known) at.emplace(hash_of(glm::ivec3(floor(p / (2 * near)))), place);
    return place;
  }
};

// Returns the largest coordinate of what moves.
float extent_of(const World& world, uint32_t first) {
  float extent = 0;
  for (uint32_t i = first; i < uint32_t(world.instance_count()); i++)
    for (vec3 p : world.mesh_of(i).positions)
      if (is_finite(p)) extent = std::max(extent, max_component(abs(p)));
  return extent;
}

using Pair = std::pair<uint32_t, uint32_t>;
struct Neighbours {
  Pair places;
  bool joined = true;  // by a triangle; else they are only near
};

float alike(const Builder& b, const Neighbours& edge) {
  auto [here, there] = edge.places;
  const SkinPlace &from = b.skin.places[here], &to = b.skin.places[there];
  const float facing = dot(b.normal[here], b.normal[there]);
  if (from.back != to.back || !(edge.joined || facing > beside_facing)) return other_side;
  vec3 d = b.position[here] - b.position[there], turn = b.normal[here] - b.normal[there];
  float differs = anyway * anyway + by_normal * by_normal * dot(turn, turn) +
                  by_distance * by_distance * dot(d, d);
  if (!std::isfinite(differs)) return 0;
  return edge.joined ? 1 / differs : std::min(1 / differs, most_beside);
}

// Joins places that are near but not connected. Strands of hair and teeth are connected with
// nothing: they are lit as those beside them, and places that no sample can reach take the light of
// what is near.
void join_near(const Builder& b, float reach, std::vector<Neighbours>& pairs) {
  if (!(reach > 0)) return;
  std::unordered_map<uint64_t, uint32_t> last;  // last place in each cell
  for (uint32_t i = 0; i < uint32_t(b.position.size()); i++) {
    if (!is_finite(b.position[i])) continue;
    auto [at, first] = last.try_emplace(hash_of(glm::ivec3(floor(b.position[i] / reach))), i);
    uint32_t before = std::exchange(at->second, i);
    if (first) continue;
    pairs.push_back({{i, before}, false}), pairs.push_back({{before, i}, false});
  }
}

// Adds the edges both ways, each once.
void add_edges(const Builder& b, std::vector<Neighbours>& pairs, SkinLight& skin) {
  std::sort(pairs.begin(), pairs.end(), [](const Neighbours& a, const Neighbours& b) {
    return std::pair(a.places, !a.joined) < std::pair(b.places, !b.joined);
  });
  auto same = [](const Neighbours& a, const Neighbours& b) { return a.places == b.places; };
  pairs.erase(std::unique(pairs.begin(), pairs.end(), same), pairs.end());
  skin.first_edge.assign(skin.places.size() + 1, 0);
  skin.edges.reserve(pairs.size());
  for (const Neighbours& edge : pairs) {
    float likeness = alike(b, edge);
    if (!(likeness > 0)) continue;
    skin.edges.push_back({edge.places.second, likeness});
    skin.first_edge[edge.places.first + 1]++;
  }
  for (size_t i = 0; i < skin.places.size(); i++) skin.first_edge[i + 1] += skin.first_edge[i];
}

void add_corners(const std::vector<std::pair<uint32_t, SkinCorner>>& around, SkinLight& skin) {
  skin.first_corner.assign(skin.places.size() + 1, 0);
  for (const auto& [place, corner] : around) skin.first_corner[place + 1]++;
  for (size_t i = 0; i < skin.places.size(); i++) skin.first_corner[i + 1] += skin.first_corner[i];
  std::vector<uint32_t> next(skin.first_corner.begin(), skin.first_corner.end() - 1);
  skin.corners.resize(around.size());
  for (const auto& [place, corner] : around) skin.corners[next[place]++] = corner;
}

// Groups each place of a level with those of its neighbours that are most like it.
std::vector<uint32_t> group(std::span<const uint32_t> first_edge, std::span<const SkinEdge> edges,
                            uint32_t& groups) {
  constexpr uint32_t none = 0xffffffffu;
  const size_t count = first_edge.size() - 1;
  std::vector<uint32_t> parent(count, none);
  auto around = [&](size_t i) {
    return edges.subspan(first_edge[i], first_edge[i + 1] - first_edge[i]);
  };
  groups = 0;
  for (size_t i = 0; i < count; i++) {
    float most = 0;
    for (const SkinEdge& e : around(i)) most = std::max(most, e.alike);
    bool alone = parent[i] == none;
    for (const SkinEdge& e : around(i)) alone &= parent[e.place] == none || e.alike < strong * most;
    if (!alone) continue;
    parent[i] = groups;
    for (const SkinEdge& e : around(i))
      if (e.alike >= strong * most && parent[e.place] == none) parent[e.place] = groups;
    groups++;
  }
  for (size_t i = 0; i < count; i++) {
    if (parent[i] != none) continue;
    float most = 0;
    for (const SkinEdge& e : around(i))
      if (parent[e.place] != none && e.alike > most) most = e.alike, parent[i] = parent[e.place];
    if (parent[i] == none) parent[i] = groups++;
  }
  return parent;
}

SkinLevel make_level(std::span<const uint32_t> first_edge, std::span<const SkinEdge> edges) {
  SkinLevel level;
  uint32_t groups = 0;
  level.parent = group(first_edge, edges, groups);
  std::vector<std::pair<Pair, float>> between;
  for (uint32_t i = 0; i + 1 < uint32_t(first_edge.size()); i++)
    for (uint32_t e = first_edge[i]; e < first_edge[i + 1]; e++) {
      Pair pair{level.parent[i], level.parent[edges[e].place]};
      if (pair.first != pair.second) between.push_back({pair, edges[e].alike});
    }
  std::sort(between.begin(), between.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  level.first_edge.assign(groups + 1, 0);
  for (size_t k = 0; k < between.size(); k++) {
    auto [pair, likeness] = between[k];
    if (k > 0 && between[k - 1].first == pair) {
      level.edges.back().alike += likeness;
      continue;
    }
    level.edges.push_back({pair.second, likeness});
    level.first_edge[pair.first + 1]++;
  }
  for (size_t i = 0; i < groups; i++) level.first_edge[i + 1] += level.first_edge[i];
  return level;
}

void add_levels(SkinLight& skin) {
  std::span<const uint32_t> first_edge = skin.first_edge;
  std::span<const SkinEdge> edges = skin.edges;
  skin.levels.reserve(most_levels);
  while (!edges.empty() && int(skin.levels.size()) < most_levels) {
    skin.levels.push_back(make_level(first_edge, edges));
    first_edge = skin.levels.back().first_edge, edges = skin.levels.back().edges;
  }
}

void find_pieces(SkinLight& skin) {
  constexpr uint32_t none = 0xffffffffu;
  skin.piece.assign(skin.places.size(), none);
  std::vector<uint32_t> reached;
  for (uint32_t from = 0; from < uint32_t(skin.places.size()); from++) {
    if (skin.piece[from] != none) continue;
    uint32_t piece = uint32_t(skin.pieces++);
    skin.piece[from] = piece;
    reached.assign(1, from);
    while (!reached.empty()) {
      uint32_t i = reached.back();
      reached.pop_back();
      for (uint32_t e = skin.first_edge[i]; e < skin.first_edge[i + 1]; e++) {
        uint32_t next = skin.edges[e].place;
        if (skin.piece[next] == none) skin.piece[next] = piece, reached.push_back(next);
      }
    }
  }
}

}  // namespace

SkinLight make_skin_light(const World& world) {
  SkinLight skin;
  Builder b{world, skin, {}, {}, 1, {}};
  uint32_t instances = uint32_t(world.instance_count());
  skin.first_instance = instances;
  for (uint32_t i = instances; i > 0 && world.is_moving(i - 1); i--) skin.first_instance = i - 1;
  b.near = std::max(one_position * extent_of(world, skin.first_instance), 1e-30f);
  std::vector<std::pair<uint32_t, SkinCorner>> around;
  std::vector<Neighbours> pairs;
  double all = 0;
  for (uint32_t i = skin.first_instance; i < instances; i++) {
    const Mesh& mesh = world.mesh_of(i);
    uint32_t first = uint32_t(skin.front.size()), count = uint32_t(mesh.positions.size());
    skin.first_vertex.push_back(first);
    for (uint32_t v = 0; v < count; v++) skin.front.push_back(b.add_vertex(i, v, false));
    bool two_sided = world.material_of(i).double_sided;
    for (uint32_t v = 0; v < count; v++) {
      uint32_t front = skin.front[first + v];
      skin.back.push_back(two_sided ? b.add_vertex(i, v, true) : front);
      if (two_sided) pairs.push_back({{front, skin.back.back()}});
      if (two_sided) pairs.push_back({{skin.back.back(), front}});
    }
    for (uint32_t t = 0; t < uint32_t(mesh.triangles.size()); t++) {
      float area = 0;
      eval_face(world, i, t, &area);
      if (!std::isfinite(area)) area = 0;
      all += double(area);
      for (int side = 0; side < (two_sided ? 2 : 1); side++)
        for (uint32_t c = 0; c < 3; c++) {
          const std::vector<uint32_t>& of = side ? skin.back : skin.front;
          uint32_t here = of[first + mesh.triangles[t][int(c)]],
                   next = of[first + mesh.triangles[t][int(c + 1) % 3]];
          skin.places[here].area += area / 3;
          around.push_back({here, {i, t, c}});
          if (here == next) continue;
          pairs.push_back({{here, next}}), pairs.push_back({{next, here}});
        }
    }
  }
  skin.first_vertex.push_back(uint32_t(skin.front.size()));
  skin.reach = std::min(most_reach, reach_share * float(std::sqrt(all)));
  join_near(b, skin.reach, pairs);
  add_edges(b, pairs, skin);
  add_corners(around, skin);
  add_levels(skin);
  find_pieces(skin);
  skin.history.resize(skin.places.size());
  skin.light.assign(skin.places.size(), vec4(0));
  skin.slope.assign(skin.places.size(), vec4(0));
  skin.usual_area = float(all / double(std::max<size_t>(skin.places.size(), 1)));
  return skin;
}

size_t memory_bytes(const SkinLight& skin) {
  size_t bytes = bytes_of(skin.first_vertex, skin.front, skin.back, skin.places, skin.first_corner,
                          skin.first_edge, skin.corners, skin.edges, skin.piece, skin.history,
                          skin.light, skin.slope);
  for (const SkinLevel& level : skin.levels)
    bytes += bytes_of(level.parent, level.first_edge, level.edges);
  return bytes;
}

}  // namespace wellspring::light
