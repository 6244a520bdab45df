// SPDX-License-Identifier: Apache-2.0
#include "volume/nebula/cubes.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>
#include <vector>

#include "base/load_error.h"
#include "base/parallel.h"
#include "base/simd.h"

namespace wellspring::volume {

namespace {

constexpr double most_bytes = 2e9;
constexpr double dark = 1e-4;  // parts of the brightest ring's light that need no depth

// Holds a map's light with a border, so that four neighbours can always be read.
struct RingTable {
  int radial, axial;
  float per_radius, per_height, half_length, radius;
  std::vector<HalfLanes> light;  // radial + 1 by axial + 2

  explicit RingTable(const RingMap& map)
      : radial(map.grid.radial),
        axial(map.grid.axial),
        per_radius(float(1 / map.grid.thickness())),
        per_height(float(1 / map.grid.slab())),
        half_length(float(map.grid.half_length)),
        radius(float(map.grid.radius)),
        light(size_t(radial + 1) * size_t(axial + 2)) {
    for (int m = 0; m < axial + 2; ++m)
      for (int k = 0; k <= radial; ++k) {
        const int from = map.grid.index(std::min(k, radial - 1), std::clamp(m - 1, 0, axial - 1));
        light[size_t(m) * size_t(radial + 1) + size_t(k)] =
            __builtin_convertvector(map.light[size_t(from)], HalfLanes);
      }
  }
  // Returns the light at a place, interpolated between the middles of rings; 0 outside.
  HalfLanes at(float distance, float height) const {
    if (distance >= radius || std::abs(height) >= half_length) return HalfLanes{};
    const float k = std::max(0.0f, distance * per_radius - 0.5f),
                m = (height + half_length) * per_height + 0.5f;
    const int k0 = std::min(int(k), radial - 1), m0 = std::min(int(m), axial);
    const float kf = k - float(k0), mf = m - float(m0);
    const HalfLanes* low = &light[size_t(m0) * size_t(radial + 1) + size_t(k0)];
    const HalfLanes* high = low + radial + 1;
    const HalfLanes a = low[0] + kf * (low[1] - low[0]), b = high[0] + kf * (high[1] - high[0]);
    return a + mf * (b - a);
  }
};

// Returns half the depth that holds every ring with light.
double half_depth(const RingMap& map, double tilt) {
  double brightest = 0, half = 0;
  for (const ColorLanes light : map.light)
    brightest = std::max(brightest, std::max(light[0], std::max(light[1], light[2])));
  for (int m = 0; m < map.grid.axial; ++m)
    for (int k = 0; k < map.grid.radial; ++k) {
      const ColorLanes light = map.light[size_t(map.grid.index(k, m))];
      if (!(std::max(light[0], std::max(light[1], light[2])) > dark * brightest)) continue;
      const double slab = map.grid.slab(), height = std::abs(m * slab - map.grid.half_length);
      const double farthest = std::max(height, std::abs((m + 1) * slab - map.grid.half_length));
      half = std::max(half, farthest * std::abs(std::sin(tilt)) +
                                (k + 1) * map.grid.thickness() * std::cos(tilt));
    }
  return half;
}

// Holds the voxels of a row of pixels: those of a pixel follow one another.
struct VoxelRow {
  int width, depth;
  std::vector<HalfLanes> light;
};

void fill_row(const RingTable& table, const PictureAxis& axis, double tilt, int y, VoxelRow& row) {
  const float c = float(std::cos(tilt)), s = float(std::sin(tilt));
  for (int x = 0; x < row.width; ++x) {
    const glm::dvec2 place = axis.along_and_beside({x + 0.5, y + 0.5});
    const float along = float(place.x), beside = float(place.y);
    HalfLanes* voxel = &row.light[size_t(x) * size_t(row.depth)];
    for (int z = 0; z < row.depth; ++z) {
      const float nearer = 0.5f * float(row.depth - 1) - float(z);
      const float across = nearer * c - along * s, height = along * c + nearer * s;
      voxel[z] = table.at(std::sqrt(beside * beside + across * across), height);
    }
  }
}

// Multiplies a row's voxels so that each pixel's sum is its value. Returns unreached pixels and
// light.
CubeReport correct_row(const image::LinearImage& picture, int y, VoxelRow& row) {
  CubeReport report;
  for (int x = 0; x < row.width; ++x) {
    HalfLanes* voxel = &row.light[size_t(x) * size_t(row.depth)];
    ColorLanes sum{};
    for (int z = 0; z < row.depth; ++z) sum += __builtin_convertvector(voxel[z], ColorLanes);
    const vec3 color = picture.color[size_t(y) * size_t(picture.width) + size_t(x)];
    HalfLanes factor{};
    bool missed = false;
    for (int c = 0; c < 3; ++c) {
      // A sum that is nearly nothing would overflow the factor.
      if (sum[c] > 1e-30) factor[c] = float(std::min(double(color[c]) / sum[c], 1e30));
      else if (color[c] > 0) missed = true, report.unreached_light += double(color[c]);
    }
    report.unreached_pixels += missed;
    for (int z = 0; z < row.depth; ++z) voxel[z] *= factor;
  }
  return report;
}

template <class Sample>
void store_row(const VoxelRow& row, float step, glm::ivec3 size, int y, std::byte* bytes) {
  constexpr bool whole = std::is_integral_v<Sample>;
  std::vector<HalfLanes> carried(size_t(row.width), HalfLanes{});
  std::vector<Sample> line(size_t(row.width) * 3);
  for (int z = 0; z < row.depth; ++z) {
    for (int x = 0; x < row.width; ++x) {
      const HalfLanes light = row.light[size_t(x) * size_t(row.depth) + size_t(z)];
      for (int c = 0; c < 3; ++c) {
        Sample& sample = line[size_t(3 * x + c)];
        if constexpr (whole) {
          // The rest that rounding took is given to the next voxel of the pixel.
          const float wanted = light[c] / step + carried[size_t(x)][c];
          sample =
              Sample(std::clamp(wanted + 0.5f, 0.0f, float(std::numeric_limits<Sample>::max())));
          carried[size_t(x)][c] = wanted - float(sample);
        } else {
          sample = light[c];
        }
      }
    }
    const size_t at = (size_t(z) * size_t(size.y) + size_t(y)) * size_t(size.x) * 3;
    std::memcpy(bytes + at * sizeof(Sample), line.data(), line.size() * sizeof(Sample));
  }
}

// Calls act(y, row) for every row of pixels with its corrected voxels.
template <class Act>
void each_row(const RingMap& map, const PictureAxis& axis, double tilt,
              const image::LinearImage& picture, bool correct, int depth, CubeReport& report,
              const Act& act) {
  const RingTable table(map);
  std::vector<CubeReport> rows(size_t(picture.height));
  parallel_ranges(picture.height, 4, [&](int begin, int end) {
    VoxelRow row{picture.width, depth, {}};
    row.light.resize(size_t(row.width) * size_t(depth));
    for (int y = begin; y < end; ++y) {
      fill_row(table, axis, tilt, y, row);
      if (correct) rows[size_t(y)] = correct_row(picture, y, row);
      act(y, row);
    }
  });
  report.unreached_pixels = 0, report.unreached_light = 0;
  for (const CubeReport& row : rows) {
    report.unreached_pixels += row.unreached_pixels;
    report.unreached_light += row.unreached_light;
  }
}

template <class Sample>
image::LinearImage sum_samples(const Volume& volume) {
  const glm::ivec3 size = volume.size;
  const auto* samples = reinterpret_cast<const Sample*>(volume.bytes.get());
  image::LinearImage shown{size.x + size.z, size.y, {}};
  shown.color.resize(size_t(shown.width) * size_t(shown.height));
  parallel_for(size.y, [&](int y) {
    std::vector<double> front(size_t(size.x) * 3);
    vec3* row = &shown.color[size_t(y) * size_t(shown.width)];
    for (int z = 0; z < size.z; ++z) {
      const Sample* line = samples + (size_t(z) * size_t(size.y) + size_t(y)) * front.size();
      for (size_t i = 0; i < front.size(); ++i) front[i] += double(line[i]);
      glm::dvec3 side(0);
      for (int x = 0; x < size.x; ++x)
        side += glm::dvec3(line[3 * x], line[3 * x + 1], line[3 * x + 2]);
      row[size.x + z] = vec3(side * volume.slope);
    }
    for (int x = 0; x < size.x; ++x)
      for (int c = 0; c < 3; ++c) row[x][c] = float(front[size_t(3 * x + c)] * volume.slope);
  });
  return shown;
}

void measure_reprojection(const Volume& volume, const image::LinearImage& picture,
                          CubeReport& report) {
  const image::LinearImage shown = show_cubes(volume);
  double brightest = 0, light = 0, most = 0;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      const vec3 color = picture.color[size_t(y) * size_t(picture.width) + size_t(x)],
                 seen = shown.color[size_t(y) * size_t(shown.width) + size_t(x)];
      for (int c = 0; c < 3; ++c) {
        brightest = std::max(brightest, double(color[c])), light += double(color[c]);
        if (seen[c] > 0) most = std::max(most, std::abs(double(seen[c]) - double(color[c])));
      }
    }
  report.reprojection_error = brightest > 0 ? most / brightest : 0;
  if (light > 0) report.unreached_light /= light;
}

}  // namespace

Volume fill_cubes(const RingMap& map, const PictureAxis& axis, double tilt,
                  const image::LinearImage& picture, const CubeSettings& settings,
                  CubeReport& report) {
  const int depth = 2 * std::max(1, int(std::ceil(std::min(half_depth(map, tilt), 1e6))));
  Volume volume;
  volume.size = {picture.width, picture.height, depth};
  volume.channels = 3, volume.kind = settings.kind;
  const double bytes = double(picture.width) * picture.height * depth * 3 * bytes_of(volume.kind);
  if (bytes > most_bytes) throw LoadError("nebula", "", "would be a volume of more than 2 GB");
  const double step = settings.width_metres / std::max(picture.width, picture.height);
  volume.to_metres =
      glm::dmat4(step, 0, 0, 0, 0, -step, 0, 0, 0, 0, -step, 0, -0.5 * step * (picture.width - 1),
                 0.5 * step * (picture.height - 1), 0.5 * step * (depth - 1), 1);
  const std::shared_ptr<std::byte[]> samples(new std::byte[volume.byte_count()]);
  volume.bytes = std::shared_ptr<const std::byte>(samples, samples.get());
  const auto each = [&](const auto& act) {
    each_row(map, axis, tilt, picture, settings.correct, depth, report, act);
  };
  if (settings.kind == SampleKind::f32) {
    each([&](int y, const VoxelRow& row) {
      store_row<float>(row, 1, volume.size, y, samples.get());
    });
  } else if (settings.kind == SampleKind::u8 || settings.kind == SampleKind::u16) {
    // The brightest voxel has the largest code.
    std::vector<float> brightest(size_t(picture.height));
    each([&](int y, const VoxelRow& row) {
      for (const HalfLanes light : row.light)
        for (int c = 0; c < 3; ++c) brightest[size_t(y)] = std::max(brightest[size_t(y)], light[c]);
    });
    const float most = *std::max_element(brightest.begin(), brightest.end());
    const bool wide = settings.kind == SampleKind::u16;
    const float unit = most > 0 ? most / (wide ? 65535 : 255) : 1;
    volume.slope = double(unit);
    each([&](int y, const VoxelRow& row) {
      if (wide) store_row<uint16_t>(row, unit, volume.size, y, samples.get());
      else store_row<uint8_t>(row, unit, volume.size, y, samples.get());
    });
  } else {
    throw LoadError("nebula", "samples", "have to be u8, u16 or f32");
  }
  measure_reprojection(volume, picture, report);
  return volume;
}

image::LinearImage show_cubes(const Volume& volume) {
  switch (volume.kind) {
    case SampleKind::u8: return sum_samples<uint8_t>(volume);
    case SampleKind::u16: return sum_samples<uint16_t>(volume);
    default: return sum_samples<float>(volume);
  }
}

}  // namespace wellspring::volume
