// SPDX-License-Identifier: Apache-2.0
#include "volume/nebula/nebula.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "base/clock.h"
#include "base/load_error.h"
#include "base/read_file.h"

namespace wellspring::volume {

namespace {

constexpr size_t most_file_bytes = 256 << 20;
constexpr int64_t most_picture_pixels = 64 << 20;
constexpr int most_clean_side = 1024;  // the picture in which stars are looked for

image::LinearImage cut_out(const image::LinearImage& picture, const image::ImagePart& part) {
  image::LinearImage cut{part.width, part.height, {}};
  cut.color.reserve(size_t(part.width) * size_t(part.height));
  for (int y = 0; y < part.height; ++y) {
    const auto from = picture.color.begin() +
                      ptrdiff_t(size_t(part.y + y) * size_t(picture.width) + size_t(part.x));
    cut.color.insert(cut.color.end(), from, from + part.width);
  }
  return cut;
}

// Returns the part of a picture that a box along the axis covers.
image::ImagePart box_of(const PictureAxis& axis, glm::dvec2 extent, int width, int height) {
  const double c = std::abs(std::cos(axis.angle)), s = std::abs(std::sin(axis.angle));
  const glm::dvec2 half(extent.x * c + extent.y * s, extent.x * s + extent.y * c);
  const int left = std::clamp(int(std::floor(axis.centre.x - half.x)), 0, width - 1),
            top = std::clamp(int(std::floor(axis.centre.y - half.y)), 0, height - 1),
            right = std::clamp(int(std::ceil(axis.centre.x + half.x)), left + 1, width),
            bottom = std::clamp(int(std::ceil(axis.centre.y + half.y)), top + 1, height);
  return {left, top, right - left, bottom - top};
}

int shrink_factor(int side, int most) { return (side + most - 1) / most; }

void check_settings(const image::LinearImage& picture, const NebulaSettings& settings) {
  const auto refuse = [](const char* where, const char* what) {
    throw LoadError("nebula", where, what);
  };
  if (picture.width < 1 || picture.height < 1 ||
      picture.color.size() != size_t(picture.width) * size_t(picture.height))
    refuse("picture", "has no pixels");
  if (settings.most_side < 1 || settings.most_side > 1024) refuse("side", "has to be 1 to 1024");
  if (settings.most_rays < 1) refuse("rays", "have to be 1 at least");
  if (settings.solve.iterations < 1) refuse("iterations", "have to be 1 at least");
  if (!(settings.light_inside > 0 && settings.light_inside <= 1))
    refuse("light inside", "has to be more than 0 and at most 1");
  if (settings.angle_degrees && !std::isfinite(*settings.angle_degrees))
    refuse("angle", "is no number");
}

// Takes a pixel of a picture shrunk so far as a ray wherever rings can be.
void make_rays(int most, NebulaPicture& nebula) {
  const double area = 4 * nebula.extent.x * nebula.extent.y;
  const double pixels = std::min(area, double(nebula.picture.color.size()));
  const int factor = std::max(1, int(std::ceil(std::sqrt(pixels / most) - 1e-9)));
  const image::LinearImage small = shrink(nebula.picture, factor);
  for (int y = 0; y < small.height; ++y)
    for (int x = 0; x < small.width; ++x) {
      // The last pixels may stand for fewer.
      const glm::ivec2 from(x * factor, y * factor),
          to = glm::min(from + factor, glm::ivec2(nebula.picture.width, nebula.picture.height));
      const glm::dvec2 ray = nebula.axis.along_and_beside(0.5 * glm::dvec2(from + to));
      if (std::abs(ray.y) >= nebula.extent.y) continue;
      const vec3 color = small.color[size_t(y) * size_t(small.width) + size_t(x)];
      nebula.rays.push_back(ray);
      nebula.gathered.push_back(ColorLanes{double(color.x), double(color.y), double(color.z), 0});
    }
}

}  // namespace

NebulaPicture prepare_nebula(const image::LinearImage& picture, const NebulaSettings& settings,
                             NebulaReport& report) {
  const double began = seconds_now();
  check_settings(picture, settings);
  report.shrunk = shrink_factor(std::max(picture.width, picture.height), most_clean_side);
  image::LinearImage clean = shrink(picture, report.shrunk);
  const StarReport stars = clean_sky(clean, settings.remove_stars, settings.stars);
  report.stars = stars.stars, report.star_pixels = stars.pixels, report.sky = stars.sky;

  NebulaPicture nebula;
  nebula.axis = propose_axis(clean);
  report.angle_proposed = !settings.angle_degrees;
  if (settings.angle_degrees) nebula.axis.angle = glm::radians(*settings.angle_degrees);
  report.angle_degrees = glm::degrees(nebula.axis.angle);
  nebula.proposed_tilt = propose_tilt(clean, nebula.axis);
  // Rings round the light have some room, as the outermost are seen by few rays.
  nebula.extent = 1.05 * light_extent(clean, nebula.axis, settings.light_inside) + 1.0;
  report.crop = box_of(nebula.axis, nebula.extent, clean.width, clean.height);
  nebula.picture = cut_out(clean, report.crop);
  nebula.axis.centre -= glm::dvec2(report.crop.x, report.crop.y);
  const int factor =
      shrink_factor(std::max(report.crop.width, report.crop.height), settings.most_side);
  if (factor > 1) {
    nebula.picture = shrink(nebula.picture, factor);
    nebula.axis.centre /= factor;
    nebula.extent /= factor;
  }
  make_rays(settings.most_rays, nebula);
  report.prepare_seconds = seconds_now() - began;
  return nebula;
}

RingMap solve_nebula(const NebulaPicture& nebula, double tilt, const NebulaSettings& settings,
                     NebulaReport& report, const RingMap* before) {
  const double began = seconds_now();
  RingMap map;
  map.grid.radial = settings.rings.x, map.grid.axial = settings.rings.y;
  map.grid.radius = nebula.extent.y;
  map.grid.half_length = nebula.extent.x / std::cos(std::min(std::abs(tilt), most_tilt));
  const RingSystem system = make_ring_system(map.grid, tilt, nebula.rays);
  report.rays = system.rays, report.rings = map.grid.count(), report.entries = system.entries();
  report.tilt_degrees = glm::degrees(tilt);
  report.system_seconds = seconds_now() - began;
  std::span<const ColorLanes> start;
  if (before) start = before->light;
  SolveResult solved = solve_rings(system, nebula.gathered, settings.solve, start);
  report.residual = std::move(solved.residual);
  map.light = std::move(solved.light);
  report.solve_seconds = seconds_now() - began - report.system_seconds;
  return map;
}

Volume make_nebula(const image::LinearImage& picture, const NebulaSettings& settings,
                   NebulaReport& report) {
  const NebulaPicture nebula = prepare_nebula(picture, settings, report);
  report.tilt_proposed = !settings.tilt_degrees && nebula.proposed_tilt;
  double tilt = std::min(nebula.proposed_tilt.value_or(0), most_tilt);
  if (settings.tilt_degrees) tilt = glm::radians(*settings.tilt_degrees);
  RingMap map = solve_nebula(nebula, tilt, settings, report);
  // Only what glows can be shown.
  for (ColorLanes& light : map.light) light = light > 0 ? light : ColorLanes{};
  const double began = seconds_now();
  Volume volume = fill_cubes(map, nebula.axis, tilt, nebula.picture, settings.cubes, report.cubes);
  report.cubes_seconds = seconds_now() - began;
  return volume;
}

image::LinearImage load_nebula_picture(const std::string& file) {
  const auto bytes =
      read_file<std::vector<uint8_t>>(file, most_file_bytes, FileKind::regular_or_pipe);
  return linearise(image::decode_codes(bytes, most_picture_pixels, file));
}

}  // namespace wellspring::volume
