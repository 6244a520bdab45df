// SPDX-License-Identifier: Apache-2.0
#include "world/raster/raster.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/parallel.h"
#include "base/simd.h"
#include "world/raster/raster_cull.h"
#include "world/raster/raster_edges.h"
#include "world/raster/raster_setup.h"
#include "world/raster/raster_tile.h"
#include "world/world_build.h"

namespace wellspring::world {
namespace {

constexpr int block_clusters = 32;
constexpr int block_bits = 15;  // 32 x 128 triangles, each cut into 6 parts at most

// Holds what one core makes of a few pieces: triangles, and which of them each tile has to draw.
struct Block {
  std::vector<RasterTriangle> triangles;
  std::vector<std::pair<uint32_t, uint32_t>> crossing;  // (tile, triangle)
  std::vector<uint32_t> first;  // each tile's first index in `drawn`, and the end
  std::vector<uint16_t> drawn;
};

// Projects the world to the picture before division: x and y in pixels from its middle, w in
// metres.
struct Camera {
  vec3 eye, right, down, forward;
  explicit Camera(const View& view) : eye(view.position), forward(view.forward) {
    float scale = 0.5f * float(view.height) / view.tan_half_fov;
    right = right_of_middle(view) * scale;
    down = above_middle(view) * -scale;
  }
};

// Transforms the places of corners, eight at a time.
void transform(const Camera& camera, const PlacedMesh& placed, const float* px, const float* py,
               const float* pz, uint32_t count, RasterCorners& out) {
  mat4 m = placed.in_place ? mat4(1) : placed.to_world;
  vec3 shift = vec3(m[3]) - camera.eye;
  for (uint32_t i = 0; i < count; i += lane_count) {
    Lanes x = load_lanes(px + i), y = load_lanes(py + i), z = load_lanes(pz + i);
    if (!placed.in_place) {
      Lanes u = m[0].x * x + m[1].x * y + m[2].x * z, v = m[0].y * x + m[1].y * y + m[2].y * z;
      z = m[0].z * x + m[1].z * y + m[2].z * z;
      x = u, y = v;
    }
    x += shift.x, y += shift.y, z += shift.z;
    auto along = [&](vec3 axis) { return axis.x * x + axis.y * y + axis.z * z; };
    store_lanes(out.x + i, along(camera.right));
    store_lanes(out.y + i, along(camera.down));
    store_lanes(out.w + i, along(camera.forward));
  }
}

}  // namespace

struct Raster::Impl {
  const World& world;
  std::vector<MeshClusters> meshes;        // clusters of the scene's meshes, then of moving ones
  std::vector<MeshNeighbours> neighbours;  // neighbours in the same meshes
  std::vector<uint32_t> mesh_of;           // one for every instance
  std::vector<uint8_t> has_alpha;          // one for every instance
  float near = 0;
  std::vector<RasterPiece> pieces;
  std::vector<Bounds> moving;  // moving_box() of every instance
  std::vector<Block> blocks;   // the first `used` belong to this picture; memory is kept
  size_t used = 0;
  std::vector<TilePixels> tiles;
  std::vector<std::vector<EdgeShare>> edges, border_edges;  // for each tile

  explicit Impl(const World& w) : world(w) {}
  void find_pieces(const View& view, const RasterSettings& settings);
  void drop_hidden(const View& view, const RasterView& raster, size_t first);
  void fill_block(Block& block, std::span<const RasterPiece> of, const View& view,
                  const RasterSettings& settings, const RasterView& raster) const;
  const RasterTriangle& triangle_of(uint32_t number) const {
    return blocks[number >> block_bits].triangles[number & ((1u << block_bits) - 1)];
  }
  // Calls body(number) for all triangles of a tile, of blocks from `first` on.
  template <class Body>
  void for_each(int tile, size_t first, const Body& body) const {
    for (size_t b = first; b < used; b++)
      for (uint32_t i = blocks[b].first[size_t(tile)]; i < blocks[b].first[size_t(tile) + 1]; i++)
        body(uint32_t(b) << block_bits | blocks[b].drawn[i]);
  }
  bool draw_opaque(ivec2 corner, int tile, size_t first, const View& view, const RasterView& raster,
                   vec2 offset, TilePixels& pixels) const;
  void draw_veils(ivec2 corner, int tile, const View& view, const RasterView& raster,
                  const RasterSettings& settings, TilePixels& pixels,
                  std::vector<Veil>& veils) const;
  void hand_out(ivec2 corner, const View& view, const RasterView& raster, TilePixels& pixels,
                const std::vector<Veil>& veils,
                const std::function<void(const RasterRun&)>& take) const;
};

Raster::Raster(const World& world) : impl_(std::make_unique<Impl>(world)) {
  Impl& r = *impl_;
  const Scene& scene = world.scene();
  int instances = world.instance_count(), still = int(scene.instances.size());
  int still_meshes = int(scene.meshes.size());
  r.meshes.resize(size_t(still_meshes + instances - still));
  r.neighbours.resize(r.meshes.size());
  parallel_for(int(r.meshes.size()), [&](int i) {
    const Mesh& mesh = i < still_meshes ? scene.meshes[size_t(i)]
                                        : world.mesh_of(uint32_t(still + i - still_meshes));
    if (mesh.stands_in) return;
    MeshClusters& clusters = r.meshes[size_t(i)] = make_clusters(mesh);
    MeshNeighbours& neighbours = r.neighbours[size_t(i)] = find_neighbours(mesh);
    for (uint32_t t : clusters.triangle) {
      clusters.width.push_back(neighbours.width[t]);
      clusters.bar.push_back(neighbours.bar[t]);
    }
    neighbours.width = {}, neighbours.bar = {};
  });
  for (int i = 0; i < instances; i++) {
    uint32_t number = uint32_t(i);
    r.mesh_of.push_back(
        uint32_t(i < still ? scene.instances[size_t(i)].mesh : still_meshes + i - still));
    r.has_alpha.push_back(may_pass(world.mesh_of(number), world.material_of(number)));
  }
  Bounds box = scene_bounds(scene);
  vec3 size = box.high - box.low;
  r.near = is_finite(size) ? 1e-6f * glm::length(size) : 0;
  if (!(r.near > 0)) r.near = 1e-6f;
}
Raster::~Raster() = default;

void Raster::Impl::find_pieces(const View& view, const RasterSettings& settings) {
  auto veils = [&](const PlacedMesh& placed) {
    size_t material = size_t(placed.mesh->material);
    return material < settings.see_through.size() && settings.see_through[material] != 0;
  };
  pieces.clear();
  moving.assign(mesh_of.size(), {});
  for (uint32_t i = 0; i < mesh_of.size(); i++) {
    if (!world.is_visible(i)) continue;
    const PlacedMesh& placed = world.placed(i);
    if (placed.stands_in || (settings.shows == RasterShows::still && placed.moving)) continue;
    if (settings.shows == RasterShows::moving && !placed.moving && !veils(placed)) continue;
    moving[i] = moving_box(placed);
    wellspring::world::find_pieces(view, placed, meshes[mesh_of[i]], i, moving[i],
                                   std::max(near, view.near), pieces);
  }
}

// Removes the pieces from `first` on that are hidden by what has been drawn.
void Raster::Impl::drop_hidden(const View& view, const RasterView& raster, size_t first) {
  parallel_ranges(int(pieces.size() - first), 64, [&](int begin, int end) {
    for (size_t i = first + size_t(begin); i < first + size_t(end); i++) {
      RasterPiece& piece = pieces[i];
      const PlacedMesh& placed = world.placed(piece.instance);
      const Bounds& box = placed.moving
                              ? moving[piece.instance]
                              : meshes[mesh_of[piece.instance]].clusters[piece.cluster].box;
      bool as_it_is = placed.moving || placed.in_place;
      if (is_hidden(view, raster, box, as_it_is ? nullptr : &placed.to_world, tiles))
        piece.depth = INFINITY;
    }
  });
  std::erase_if(pieces, [](const RasterPiece& piece) { return piece.depth == INFINITY; });
}

void Raster::Impl::fill_block(Block& block, std::span<const RasterPiece> of, const View& view,
                              const RasterSettings& settings, const RasterView& raster) const {
  block.triangles.clear();
  block.crossing.clear();
  Camera camera(view);
  RasterCorners corners;
  for (const RasterPiece& piece : of) {
    const PlacedMesh& placed = world.placed(piece.instance);
    const MeshClusters& mesh = meshes[mesh_of[piece.instance]];
    const Cluster& cluster = mesh.clusters[piece.cluster];
    uint32_t c0 = cluster.first_corner, padded = (cluster.corners + 7) / 8 * 8;
    if (placed.moving) {
      float x[256], y[256], z[256];
      for (uint32_t i = 0; i < padded; i++) {
        vec3 place = placed.mesh->positions[mesh.vertex[c0 + i]];
        x[i] = place.x, y[i] = place.y, z[i] = place.z;
      }
      transform(camera, placed, x, y, z, padded, corners);
    } else {
      transform(camera, placed, &mesh.x[c0], &mesh.y[c0], &mesh.z[c0], padded, corners);
    }
    project_corners(raster, int(padded), corners);
    RasterTriangle unfinished{};
    unfinished.instance = piece.instance;
    unfinished.has_alpha = has_alpha[piece.instance];
    unfinished.one_sided = placed.one_sided;
    unfinished.mirrored = placed.mirrored;
    bool as_it_is = placed.moving || placed.in_place;
    float scale = length(camera.right) * (as_it_is ? 1 : length(vec3(placed.to_world[0])));
    size_t material = size_t(placed.mesh->material);
    unfinished.veils = material < settings.see_through.size() ? settings.see_through[material] : 0;
    for (uint32_t t = cluster.first_triangle; t < cluster.first_triangle + cluster.triangles; t++) {
      unfinished.triangle = mesh.triangle[t];
      unfinished.width = scale * mesh.width[t];
      unfinished.bar = mesh.bar[t] != 0;
      std::array<uint8_t, 3> c = mesh.corner[t];
      add_triangle(raster, corners, c[0], c[1], c[2], unfinished, block.triangles);
    }
  }

  int columns = (view.width + tile_width - 1) / tile_width;
  int rows = (view.height + tile_height - 1) / tile_height;
  block.first.assign(size_t(columns * rows) + 1, 0);
  for (uint32_t i = 0; i < block.triangles.size(); i++) {
    const RasterTriangle& t = block.triangles[i];
    for (int y = t.top / tile_height; y <= t.bottom / tile_height; y++)
      for (int x = t.left / tile_width; x <= t.right / tile_width; x++) {
        block.crossing.push_back({uint32_t(y * columns + x), i});
        block.first[size_t(y * columns + x) + 1]++;
      }
  }
  for (size_t i = 1; i < block.first.size(); i++) block.first[i] += block.first[i - 1];
  block.drawn.resize(block.crossing.size());
  std::vector<uint32_t> next(block.first.begin(), block.first.end() - 1);
  for (auto [tile, triangle] : block.crossing) block.drawn[next[tile]++] = uint16_t(triangle);
}

// Draws opaque triangles. True: there are see-through ones.
bool Raster::Impl::draw_opaque(ivec2 corner, int tile, size_t first, const View& view,
                               const RasterView& raster, vec2 offset, TilePixels& pixels) const {
  bool any_veil = false;
  for_each(tile, first, [&](uint32_t number) {
    const RasterTriangle& t = triangle_of(number);
    if (t.veils) {
      any_veil = true;
      return;
    }
    cover(t, raster, corner.x, corner.y, pixels, [&](int place, Lanes depth, unsigned covered) {
      for (unsigned left = t.has_alpha ? covered : 0; left != 0; left &= left - 1) {
        int i = __builtin_ctz(left);
        int x = corner.x + (place + i) % tile_width, y = corner.y + (place + i) / tile_width;
        if (passes(world.scene(), world.placed(t.instance), t.instance, t.triangle,
                   barycentric_at(t, raster, x, y, depth[i]),
                   view_ray(view, float(x) + offset.x, float(y) + offset.y)))
          covered &= ~(1u << i);
      }
      pixels.stale |= 1u << (place / tile_width / TilePixels::square * TilePixels::across +
                             place % tile_width / TilePixels::square);
      LaneMask mask = lanes_of_bits(covered);
      store_lanes(pixels.depth + place, mask ? depth : load_lanes(pixels.depth + place));
      LaneMask numbers;
      std::memcpy(&numbers, pixels.number + place, sizeof numbers);
      numbers = mask ? LaneMask{} + int(number) : numbers;
      std::memcpy(pixels.number + place, &numbers, sizeof numbers);
    });
  });
  return any_veil;
}

void Raster::Impl::draw_veils(ivec2 corner, int tile, const View& view, const RasterView& raster,
                              const RasterSettings& settings, TilePixels& pixels,
                              std::vector<Veil>& veils) const {
  for_each(tile, 0, [&](uint32_t number) {
    const RasterTriangle& t = triangle_of(number);
    if (!t.veils) return;
    bool known = false;
    Veil veil;
    cover(t, raster, corner.x, corner.y, pixels, [&](int place, Lanes depth, unsigned covered) {
      if (veils.empty()) veils.resize(tile_width * tile_height);
      for (; covered != 0; covered &= covered - 1) {
        int i = __builtin_ctz(covered);
        if (!known || t.veils == 2) {
          int x = corner.x + (place + i) % tile_width, y = corner.y + (place + i) / tile_width;
          Ray ray = view_ray(view, float(x) + settings.offset.x, float(y) + settings.offset.y);
          Hit hit;
          hit.t = 1 / (depth[i] * dot(ray.direction, view.forward));
          hit.instance = t.instance;
          hit.triangle = t.triangle;
          hit.barycentric = barycentric_at(t, raster, x, y, depth[i]);
          veil = settings.veil(hit, ray.direction);
          known = true;
        }
        Veil& v = veils[size_t(place + i)];
        v.glow += v.tint * veil.glow;
        v.tint *= veil.tint;
      }
    });
  });
}

void Raster::Impl::hand_out(ivec2 corner, const View& view, const RasterView& raster,
                            TilePixels& pixels, const std::vector<Veil>& veils,
                            const std::function<void(const RasterRun&)>& take) const {
  int columns = std::min(tile_width, view.width - corner.x),
      rows = std::min(tile_height, view.height - corner.y);
  float depth[tile_width + lane_count], u[tile_width + lane_count], v[tile_width + lane_count];
  uint32_t instance[tile_width + lane_count], triangle[tile_width + lane_count];
  uint8_t ends[tile_width];
  for (int y = 0; y < rows; y++) {
    const uint32_t* number = pixels.number + y * tile_width;
    const float* inverse = pixels.depth + y * tile_width;
    int pieces = 0;
    for (int x = 0, end; x < columns; x = end) {
      for (end = x + 1; end < columns && number[end] == number[x];) end++;
      ends[pieces++] = uint8_t(end);
      bool hit = number[x] != no_triangle;
      const RasterTriangle* t = hit ? &triangle_of(number[x]) : nullptr;
      // Between narrow things of one instance there may be gaps.
      bool apart = hit && t->bar && t->width * inverse[x] < thin_width;
      uint16_t kind = apart ? uint16_t(number[x] | TilePixels::thin_kind)
                            : uint16_t((hit ? t->instance : ~0u) & ~TilePixels::thin_kind);
      for (int i = x; i < end; i++) {
        instance[i] = hit ? t->instance : RasterRun::nothing;
        triangle[i] = hit ? t->triangle : 0;
        pixels.kind[y * tile_width + i] = kind;
      }
      if (!hit) {
        std::fill(depth + x, depth + end, std::numeric_limits<float>::infinity());
        std::fill(u + x, u + end, 0.0f), std::fill(v + x, v + end, 0.0f);
        continue;
      }
      constexpr Lanes lane{0, 1, 2, 3, 4, 5, 6, 7};
      float u0 = eval_at(t->u, *t, raster, corner.x + x, corner.y + y);
      float v0 = eval_at(t->v, *t, raster, corner.x + x, corner.y + y);
      for (int i = x; i < end; i += lane_count) {
        Lanes w = 1 / load_lanes(inverse + std::min(i, tile_width - lane_count));
        if (i > tile_width - lane_count)
          for (int k = 0; k < lane_count; k++) w[k] = 1 / inverse[std::min(i + k, tile_width - 1)];
        Lanes along = lane + float(i - x);
        Lanes a = lanes_max(lanes_min((u0 + t->u.y * along) * w, all_lanes(1)), all_lanes(0));
        Lanes b = lanes_max(lanes_min((v0 + t->v.y * along) * w, all_lanes(1)), all_lanes(0));
        Lanes share = 1 / lanes_max(a + b, all_lanes(1));
        store_lanes(depth + i, w);
        store_lanes(u + i, a * share);
        store_lanes(v + i, b * share);
      }
    }
    take({corner.x, corner.y + y, columns, depth, instance, triangle, u, v,
          veils.empty() ? nullptr : &veils[size_t(y) * tile_width], ends, pieces});
  }
}

std::span<const std::vector<EdgeShare>> Raster::edges() const { return impl_->edges; }

Hit hit_of(const RasterRun& run, int i, const View& view, vec2 offset) {
  Hit hit;
  if (run.instance[i] == RasterRun::nothing) return hit;
  Ray ray = view_ray(view, float(run.x + i) + offset.x, float(run.y) + offset.y);
  hit.t = run.depth[i] / dot(ray.direction, view.forward);
  hit.instance = run.instance[i];
  hit.triangle = run.triangle[i];
  hit.barycentric = {run.u[i], run.v[i]};
  return hit;
}

void Raster::draw(const View& view, const RasterSettings& settings,
                  const std::function<void(const RasterRun&)>& take) {
  Impl& r = *impl_;
  r.pieces.clear();
  if (view.width > most_pixels || view.height > most_pixels) return;
  auto steps = [](float x) { return int32_t(std::lrint(x * raster_steps)); };
  RasterView raster{std::max(r.near, view.near), view.width, view.height};
  raster.centre_steps_x = view.width * (raster_steps / 2) - steps(settings.offset.x);
  raster.centre_steps_y = view.height * (raster_steps / 2) - steps(settings.offset.y);
  raster.centre_x = float(raster.centre_steps_x) / raster_steps;
  raster.centre_y = float(raster.centre_steps_y) / raster_steps;
  r.find_pieces(view, settings);
  int columns = (view.width + tile_width - 1) / tile_width;
  int rows = (view.height + tile_height - 1) / tile_height;
  r.tiles.resize(size_t(columns * rows));
  for (auto* lists : {&r.edges, &r.border_edges}) {
    lists->resize(settings.edges ? r.tiles.size() : 0);
    for (std::vector<EdgeShare>& list : *lists) list.clear();
  }
  r.used = 0;
  std::vector<uint8_t> any_veil(r.tiles.size(), 0);
  auto corner_of = [&](int tile) {
    return ivec2(tile % columns * tile_width, tile / columns * tile_height);
  };
  size_t drawn = 0;  // pieces
  auto fill = [&](size_t pieces) {
    size_t first = r.used, more = (pieces - drawn + block_clusters - 1) / block_clusters;
    r.used = first + more;
    if (r.blocks.size() < r.used) r.blocks.resize(r.used);
    parallel_for(int(more), [&](int i) {
      size_t begin = drawn + size_t(i) * block_clusters,
             end = std::min(begin + block_clusters, pieces);
      r.fill_block(r.blocks[first + size_t(i)], std::span(r.pieces).subspan(begin, end - begin),
                   view, settings, raster);
    });
    drawn = pieces;
    return first;
  };
  auto draw_tile = [&](int i, size_t first) {
    any_veil[size_t(i)] |=
        r.draw_opaque(corner_of(i), i, first, view, raster, settings.offset, r.tiles[size_t(i)]);
  };
  fill(put_hiding_first(r.pieces));
  parallel_for(columns * rows, [&](int i) {
    ivec2 corner = corner_of(i);
    r.tiles[size_t(i)].start(std::min(tile_width, view.width - corner.x),
                             std::min(tile_height, view.height - corner.y));
    draw_tile(i, 0);
    r.tiles[size_t(i)].find_all_least();
  });
  r.drop_hidden(view, raster, drawn);
  size_t second = fill(r.pieces.size());
  auto triangle_of = [&r](uint32_t number) { return &r.triangle_of(number); };
  SurfaceWalk walk{r.world, r.neighbours, r.mesh_of,
                   view,    raster,       0.5f * float(view.height) / view.tan_half_fov};
  EdgeFinder<decltype(triangle_of)> finder{walk,    raster,     columns, settings.differ,
                                           r.tiles, triangle_of};
  parallel_for(columns * rows, [&](int i) {
    draw_tile(i, second);
    std::vector<Veil> veils;
    if (any_veil[size_t(i)] && settings.veil)
      r.draw_veils(corner_of(i), i, view, raster, settings, r.tiles[size_t(i)], veils);
    r.hand_out(corner_of(i), view, raster, r.tiles[size_t(i)], veils, take);
    if (settings.edges) finder.find_within(i, r.edges[size_t(i)]);
  });
  if (!settings.edges) return;
  parallel_for(columns * rows, [&](int i) { finder.find_borders(i, r.border_edges[size_t(i)]); });
  for (const std::vector<EdgeShare>& list : r.border_edges)
    for (const EdgeShare& edge : list) {
      int x = int(edge.pixel) % view.width, y = int(edge.pixel) / view.width;
      r.edges[size_t(y / tile_height * columns + x / tile_width)].push_back(edge);
    }
}

}  // namespace wellspring::world
