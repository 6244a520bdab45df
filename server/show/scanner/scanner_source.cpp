// SPDX-License-Identifier: Apache-2.0
#include "show/scanner/scanner_source.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/parallel.h"
#include "base/rng.h"
#include "frame/tonemap.h"
#include "light/material/bsdf.h"
#include "light/random/warp.h"
#include "world/load/scene_load.h"
#include "world/surface.h"
#include "world/world.h"

namespace wellspring::show {
namespace {

constexpr double lowest = -83 * pi / 180.0;    // radians; below that it sees its own tripod
constexpr double pilot_step = 1.5 * pi / 180;  // radians, of the rays that count what comes back
constexpr float most_grazing = 5;              // times the noise of a surface that is seen squarely
constexpr float beam = 0.0007f;                // radians that the beam is wide
constexpr float least_gap = 0.02f, pulse = 0.6f;  // metres between two surfaces that are mixed
constexpr float half_distance = 8;                // metres at which half of the light comes back
constexpr int sky_rays = 6;                       // rays to the sky for a point's shade
constexpr float ground_light = 0.3f;              // comes from below the horizon, the sky being 1
constexpr int64_t rays_at_once = 1 << 18;

Scene load_scanned(const ScannerFile& file) {
  SceneLoadOptions options;
  options.package = std::filesystem::path(file.file).parent_path().string();
  return load_scene(file.scene, options);
}

struct ScannerScene {
  Scene scene;
  World world;
  explicit ScannerScene(const ScannerFile& file) : scene(load_scanned(file)), world(scene) {}
};

// Holds the rays of a station: rows of the same elevation.
struct ScanGrid {
  double step = 0;  // radians
  int rows() const { return std::max(1, int(std::lround((pi / 2 - lowest) / step))); }
  double elevation(int row) const { return lowest + (row + 0.5) * (pi / 2 - lowest) / rows(); }
  int columns(int row) const {
    return std::max(1, int(std::lround(2 * pi * std::cos(elevation(row)) / step)));
  }
  vec3 direction(int row, int column) const {
    const double up = elevation(row), around = 2 * pi * (column + 0.5) / columns(row);
    return {std::cos(up) * std::cos(around), std::sin(up), std::cos(up) * std::sin(around)};
  }
};

// Sends the rays of a row.
struct RowOfRays {
  std::vector<Ray> rays;
  std::vector<Hit> hits;

  void trace(const ScannerScene& scene, const dvec3& from, float range, const ScanGrid& grid,
             int row) {
    rays.resize(size_t(grid.columns(row))), hits.assign(rays.size(), {});
    for (size_t i = 0; i < rays.size(); i++) {
      rays[i].origin = vec3(from - scene.scene.origin);
      rays[i].direction = grid.direction(row, int(i));
      rays[i].t_max = range;
    }
    scene.world.intersect_many(rays.data(), hits.data(), int(rays.size()));
  }
};

float gauss(Rng& rng) {
  const float radius = std::sqrt(-2 * std::log(1 - rng.uniform()));
  return radius * unit_circle(rng.uniform()).x;
}

// Returns how much of an overcast sky's light a place gets: 1 where nothing stands around it.
float sky_light(const World& world, const Surface& surface, Rng& rng) {
  vec3 tangent, bitangent;
  make_frame_axes(surface.normal, tangent, bitangent);
  float light = 0;
  for (int i = 0; i < sky_rays; i++) {
    const vec2 u((float(i) + rng.uniform()) / sky_rays, rng.uniform());
    const vec3 l = sample_cosine_hemisphere(u);
    const vec3 way = tangent * l.x + bitangent * l.y + surface.normal * l.z;
    Ray ray;
    ray.origin = offset_origin(surface, way), ray.direction = way;
    if (!world.occluded(ray)) light += way.y > 0 ? 1 : ground_light;
  }
  return light / sky_rays;
}

std::array<uint16_t, 3> color_of(vec3 linear) {
  const vec3 c = clamp(linear, 0.0f, 1.0f);
  const Lanes codes = encode_srgb(Lanes{c.x, c.y, c.z}) * 255 + 0.5f;
  return {uint16_t(codes[0]), uint16_t(codes[1]), uint16_t(codes[2])};
}

class StationSource : public PointSource {
 public:
  StationSource(std::shared_ptr<const ScannerScene> scene, const ScannerFile& file, size_t number,
                double step, uint64_t expected)
      : scene_(std::move(scene)), file_(file), station_(file.stations[number]), number_(number) {
    grid_.step = step;
    info_.file = file.file, info_.format = "scanner";
    info_.points = expected;
    info_.fields = {.color = true, .intensity = true, .normal = true};
    info_.stations = {{station_.name, station_.position + dvec3(station_.shift)}};
  }

  bool read(PointBlock& block, size_t most) override {
    block.clear();
    while (block.size() < most && (at_ < batch_.size() || fill())) {
      const size_t end = std::min(batch_.size(), at_ + most - block.size());
      append(batch_, at_, end, block);
      at_ = end;
    }
    return block.size() > 0;
  }

 private:
  static void append(const PointBlock& from, size_t begin, size_t end, PointBlock& to) {
    const auto add = [&](const auto& column, auto& into) {
      into.insert(into.end(), column.begin() + ptrdiff_t(begin), column.begin() + ptrdiff_t(end));
    };
    add(from.place, to.place), add(from.color, to.color);
    add(from.intensity, to.intensity), add(from.normal, to.normal);
  }

  // Scans the next rows. False: there are none.
  bool fill() {
    batch_.clear(), at_ = 0;
    const int begin = row_;
    for (int64_t rays = 0; row_ < grid_.rows() && rays < rays_at_once; row_++)
      rays += grid_.columns(row_);
    if (begin == row_) return false;
    std::vector<PointBlock> rows(size_t(row_ - begin));
    parallel_each(int(rows.size()), [&](int i) { scan_row(begin + i, rows[size_t(i)]); });
    for (const PointBlock& row : rows) append(row, 0, row.size(), batch_);
    return true;
  }

  void scan_row(int row, PointBlock& to) const {
    RowOfRays traced;
    traced.trace(*scene_, station_.position, file_.range, grid_, row);
    for (size_t i = 0; i < traced.hits.size(); i++) {
      if (!traced.hits[i].valid()) continue;
      Rng rng(sample_seed(file_.seed, uint32_t(i), uint32_t(row), uint32_t(number_)));
      add_point(traced, i, rng, to);
    }
  }

  void add_point(const RowOfRays& row, size_t i, Rng& rng, PointBlock& to) const {
    const Ray& ray = row.rays[i];
    const Hit& hit = row.hits[i];
    const Surface surface = eval_surface(scene_->world, ray, hit);
    const float cosine = std::abs(dot(surface.geometric_normal, ray.direction));
    float distance = hit.t;
    if (const size_t beside = (i + 1) % row.hits.size(); row.hits[beside].valid()) {
      const float other = row.hits[beside].t;
      const vec3 across = row.rays[beside].direction * other - ray.direction * hit.t;
      const bool is_edge = std::abs(dot(surface.geometric_normal, across)) > least_gap;
      if (is_edge && std::abs(other - hit.t) < pulse && rng.uniform() < beam / float(grid_.step))
        distance = glm::mix(hit.t, other, rng.uniform());
    }
    distance += file_.noise * std::min(most_grazing, 1 / std::max(cosine, 0.01f)) * gauss(rng);
    vec3 color = surface.base_color;
    if (file_.shade > 0)
      color *= glm::mix(1.0f, sky_light(scene_->world, surface, rng), file_.shade);
    const float back = luminance(surface.base_color) * cosine /
                       (1 + hit.t * hit.t / (half_distance * half_distance));
    const double c = std::cos(station_.turn), s = std::sin(station_.turn);
    const dvec3 way = dvec3(ray.direction) * double(distance);
    to.place.push_back(station_.position + dvec3(station_.shift) +
                       dvec3(c * way.x + s * way.z, way.y, c * way.z - s * way.x));
    to.color.push_back(color_of(color));
    to.intensity.push_back(uint16_t(65535 * glm::clamp(back, 0.0f, 1.0f)));
    to.normal.push_back(surface.geometric_normal);
  }

  const std::shared_ptr<const ScannerScene> scene_;
  const ScannerFile file_;
  const ScannerStation station_;
  const size_t number_;
  ScanGrid grid_;
  int row_ = 0;       // the next to be scanned
  PointBlock batch_;  // points of the rows before
  size_t at_ = 0;     // the next of them to be given
};

// Returns how many rays of a coarse grid come back from each station.
std::vector<double> count_returns(const ScannerScene& scene, const ScannerFile& file) {
  std::vector<double> counts(file.stations.size());
  const ScanGrid grid{pilot_step};
  parallel_each(int(counts.size()), [&](int i) {
    RowOfRays traced;
    for (int row = 0; row < grid.rows(); row++) {
      traced.trace(scene, file.stations[size_t(i)].position, file.range, grid, row);
      counts[size_t(i)] += double(std::ranges::count_if(traced.hits, &Hit::valid));
    }
  });
  return counts;
}

}  // namespace

std::vector<TreeSource> open_scanner(const ScannerFile& file, uint64_t most_points) {
  const auto scene = std::make_shared<const ScannerScene>(file);
  const std::vector<double> counts = count_returns(*scene, file);
  double all = 0;
  for (const double count : counts) all += count;
  const double share = double(std::min(most_points, file.points)) / std::max(all, 1.0);
  std::vector<TreeSource> sources;
  for (size_t i = 0; i < counts.size(); i++) {
    const uint64_t expected = uint64_t(counts[i] * share);
    sources.push_back({file.file, [=] {
                         return std::make_unique<StationSource>(
                             scene, file, i, pilot_step / std::sqrt(share), expected);
                       }});
  }
  return sources;
}

PointBounds scanned_bounds(const ScannerFile& file) {
  const Scene scene = load_scanned(file);
  const Bounds bounds = scene_bounds(scene);
  return {dvec3(bounds.low) + scene.origin, dvec3(bounds.high) + scene.origin};
}

}  // namespace wellspring::show
