// SPDX-License-Identifier: Apache-2.0
#include "world/raster.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/lanes.h"
#include "base/parallel.h"
#include "world/bvh_alpha.h"
#include "world/raster_clusters.h"
#include "world/raster_setup.h"
#include "world/raster_tile.h"

namespace wellspring {
namespace {

constexpr int block_clusters = 8;
constexpr int block_bits = 13;  // 8 x 128 triangles, each cut into 6 parts at most

// One cluster of one instance that may be in sight.
struct Piece {
  float depth;  // of its nearest place
  uint32_t instance, cluster;
};

// What one core makes of a few pieces: triangles, and which of them each tile has to draw.
struct Block {
  std::vector<RasterTriangle> triangles;
  std::vector<std::pair<uint32_t, uint32_t>> crossing;  // (tile, triangle)
  std::vector<uint32_t> first;                          // of each tile in `drawn`, and the end
  std::vector<uint16_t> drawn;
};

// World to the picture before division: x and y in pixels from the centre, w in metres.
struct Camera {
  vec3 eye, right, down, forward;
  explicit Camera(const View& view) : eye(view.position), forward(view.forward) {
    float scale = 0.5f * float(view.height) / view.tan_half_fov;
    right = view.right * scale;
    down = view.up * -scale;
  }
};

// Places of eight corners at a time.
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
  std::vector<MeshClusters> meshes;  // of the scene's, then of what moves
  std::vector<uint32_t> mesh_of;     // of every instance
  std::vector<uint8_t> has_alpha;    // of every instance
  float near = 0;
  std::vector<Piece> pieces;
  std::vector<Block> blocks;

  explicit Impl(const World& w) : world(w) {}
  void find_pieces(const View& view);
  void fill_block(int number, const View& view, const RasterSettings& settings,
                  const RasterView& raster);
  void draw_tile(int tile_x, int tile_y, int tile, const View& view, const RasterView& raster,
                 const RasterSettings& settings,
                 const std::function<void(const RasterRun&)>& take) const;
};

Raster::Raster(const World& world) : impl_(std::make_unique<Impl>(world)) {
  Impl& r = *impl_;
  const Scene& scene = world.scene();
  int instances = world.instance_count(), still = int(scene.instances.size());
  int still_meshes = int(scene.meshes.size());
  r.meshes.resize(size_t(still_meshes + instances - still));
  parallel_for(int(r.meshes.size()), [&](int i) {
    r.meshes[size_t(i)] =
        make_clusters(i < still_meshes ? scene.meshes[size_t(i)]
                                       : world.mesh_of(uint32_t(still + i - still_meshes)));
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

// All pieces that the visible cone touches, the nearest first.
void Raster::Impl::find_pieces(const View& view) {
  pieces.clear();
  float up = view.tan_half_fov, side = up * float(view.width) / float(view.height);
  float up_norm = 1 / std::sqrt(1 + up * up), side_norm = 1 / std::sqrt(1 + side * side);
  for (uint32_t i = 0; i < mesh_of.size(); i++) {
    const PlacedMesh& placed = world.placed(i);
    const MeshClusters& mesh = meshes[mesh_of[i]];
    if (!world.is_visible(i)) continue;
    if (placed.moving) {  // its clusters are not where they were: drawn wherever they are
      for (uint32_t k = 0; k < mesh.clusters.size(); k++) pieces.push_back({0, i, k});
      continue;
    }
    float scale = 1;
    if (!placed.in_place) {
      float row = 0;  // no length grows by more than the root of the sum of squares
      for (int k = 0; k < 3; k++) row += dot(vec3(placed.to_world[k]), vec3(placed.to_world[k]));
      scale = std::sqrt(row);
    }
    for (uint32_t k = 0; k < mesh.clusters.size(); k++) {
      const Cluster& cluster = mesh.clusters[k];
      vec3 centre =
          placed.in_place ? cluster.centre : vec3(placed.to_world * vec4(cluster.centre, 1));
      vec3 d = centre - view.position;
      float radius = cluster.radius * scale * 1.001f + near, w = dot(d, view.forward);
      if (w < -radius) continue;
      if ((std::abs(dot(d, view.right)) - side * w) * side_norm > radius) continue;
      if ((std::abs(dot(d, view.up)) - up * w) * up_norm > radius) continue;
      pieces.push_back({w - radius, i, k});
    }
  }
  std::sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) {
    return a.depth != b.depth         ? a.depth < b.depth
           : a.instance != b.instance ? a.instance < b.instance
                                      : a.cluster < b.cluster;
  });
}

void Raster::Impl::fill_block(int number, const View& view, const RasterSettings& settings,
                              const RasterView& raster) {
  Block& block = blocks[size_t(number)];
  block.triangles.clear();
  block.crossing.clear();
  Camera camera(view);
  RasterCorners corners;
  size_t first = size_t(number) * block_clusters,
         end = std::min(first + block_clusters, pieces.size());
  for (size_t p = first; p < end; p++) {
    const PlacedMesh& placed = world.placed(pieces[p].instance);
    const MeshClusters& mesh = meshes[mesh_of[pieces[p].instance]];
    const Cluster& cluster = mesh.clusters[pieces[p].cluster];
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
    unfinished.instance = pieces[p].instance;
    unfinished.has_alpha = has_alpha[pieces[p].instance];
    size_t material = size_t(placed.mesh->material);
    unfinished.veils = material < settings.see_through.size() ? settings.see_through[material] : 0;
    for (uint32_t t = cluster.first_triangle; t < cluster.first_triangle + cluster.triangles; t++) {
      unfinished.triangle = mesh.triangle[t];
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

void Raster::Impl::draw_tile(int tile_x, int tile_y, int tile, const View& view,
                             const RasterView& raster, const RasterSettings& settings,
                             const std::function<void(const RasterRun&)>& take) const {
  TilePixels pixels;
  std::fill(std::begin(pixels.depth), std::end(pixels.depth), 0.0f);
  std::fill(std::begin(pixels.number), std::end(pixels.number), no_triangle);
  auto triangle_of = [&](uint32_t number) -> const RasterTriangle& {
    return blocks[number >> block_bits].triangles[number & ((1u << block_bits) - 1)];
  };
  std::fill(std::begin(pixels.least), std::end(pixels.least), 0.0f);
  vec2 offset = settings.offset;
  bool any_veil = false;
  auto for_each = [&](const auto& body) {
    for (uint32_t b = 0; b < blocks.size(); b++)
      for (uint32_t i = blocks[b].first[size_t(tile)]; i < blocks[b].first[size_t(tile) + 1]; i++)
        body(b << block_bits | blocks[b].drawn[i]);
  };
  for_each([&](uint32_t number) {
    const RasterTriangle& t = triangle_of(number);
    if (t.veils) {
      any_veil = true;
      return;
    }
    cover(t, raster, tile_x, tile_y, pixels, [&](int place, Lanes depth, unsigned covered) {
      for (unsigned left = t.has_alpha ? covered : 0; left != 0; left &= left - 1) {
        int i = __builtin_ctz(left);
        int x = tile_x + (place + i) % tile_width, y = tile_y + (place + i) / tile_width;
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
  std::vector<Veil> veils;
  if (any_veil && settings.veil) {
    for_each([&](uint32_t number) {
      const RasterTriangle& t = triangle_of(number);
      if (!t.veils) return;
      bool known = false;
      Veil veil;
      cover(t, raster, tile_x, tile_y, pixels, [&](int place, Lanes depth, unsigned covered) {
        if (veils.empty()) veils.resize(tile_width * tile_height);
        for (; covered != 0; covered &= covered - 1) {
          int i = __builtin_ctz(covered);
          if (!known || t.veils == 2) {
            int x = tile_x + (place + i) % tile_width, y = tile_y + (place + i) / tile_width;
            Ray ray = view_ray(view, float(x) + offset.x, float(y) + offset.y);
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

  int columns = std::min(tile_width, view.width - tile_x),
      rows = std::min(tile_height, view.height - tile_y);
  float depth[tile_width + lane_count], u[tile_width + lane_count], v[tile_width + lane_count];
  uint32_t instance[tile_width + lane_count], triangle[tile_width + lane_count];
  for (int y = 0; y < rows; y++) {
    const uint32_t* number = pixels.number + y * tile_width;
    const float* inverse = pixels.depth + y * tile_width;
    for (int x = 0, end; x < columns; x = end) {
      for (end = x + 1; end < columns && number[end] == number[x];) end++;
      bool hit = number[x] != no_triangle;
      const RasterTriangle* t = hit ? &triangle_of(number[x]) : nullptr;
      for (int i = x; i < end; i++) {
        instance[i] = hit ? t->instance : RasterRun::nothing;
        triangle[i] = hit ? t->triangle : 0;
      }
      if (!hit) {
        std::fill(depth + x, depth + end, std::numeric_limits<float>::infinity());
        std::fill(u + x, u + end, 0.0f), std::fill(v + x, v + end, 0.0f);
        continue;
      }
      constexpr Lanes lane{0, 1, 2, 3, 4, 5, 6, 7};
      float u0 = eval_at(t->u, *t, raster, tile_x + x, tile_y + y);
      float v0 = eval_at(t->v, *t, raster, tile_x + x, tile_y + y);
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
    take({tile_x, tile_y + y, columns, depth, instance, triangle, u, v,
          veils.empty() ? nullptr : &veils[size_t(y) * tile_width]});
  }
}

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
  if (view.width > most_pixels || view.height > most_pixels) return;
  Impl& r = *impl_;
  auto steps = [](float x) { return int32_t(std::lrint(x * raster_steps)); };
  RasterView raster{r.near, view.width, view.height};
  raster.centre_steps_x = view.width * (raster_steps / 2) - steps(settings.offset.x);
  raster.centre_steps_y = view.height * (raster_steps / 2) - steps(settings.offset.y);
  raster.centre_x = float(raster.centre_steps_x) / raster_steps;
  raster.centre_y = float(raster.centre_steps_y) / raster_steps;
  r.find_pieces(view);
  r.blocks.resize((r.pieces.size() + block_clusters - 1) / block_clusters);
  parallel_for(int(r.blocks.size()), [&](int i) { r.fill_block(i, view, settings, raster); });
  int columns = (view.width + tile_width - 1) / tile_width;
  int rows = (view.height + tile_height - 1) / tile_height;
  parallel_for(columns * rows, [&](int i) {
    r.draw_tile(i % columns * tile_width, i / columns * tile_height, i, view, raster, settings,
                take);
  });
}

}  // namespace wellspring
