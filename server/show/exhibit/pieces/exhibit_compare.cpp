// SPDX-License-Identifier: Apache-2.0
#include "show/exhibit/pieces/exhibit_compare.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/load_error.h"
#include "volume/compare/compare_surface.h"
#include "volume/compare/mesh_file.h"
#include "volume/format/open_volume.h"
#include "world/load/scene_surface.h"

namespace wellspring::show {
namespace {

constexpr float reach = 2.5f;  // samples of the coloured volume from a point that colours them
constexpr vec3 unknown(0.5f);  // linear colour where there is no point

// Colours the samples around points, the nearest points the most.
std::array<std::vector<uint16_t>, 3> spread(const Comparison& comparison,
                                            const ShownVolume& volume) {
  const VolumeLevel& level = volume.levels.front();
  std::vector<vec4> sums(level.codes.size(), vec4(0));
  const glm::dmat4 to_samples = glm::inverse(volume.to_metres);
  const std::vector<vec3> colors = deviation_colors(comparison.scale, comparison.deviations);
  for (size_t i = 0; i < colors.size(); i++) {
    const vec3 at(to_samples * glm::dvec4(comparison.points[i].position, 1));
    const glm::ivec3 low = glm::max(glm::ivec3(glm::ceil(at - reach)), glm::ivec3(0)),
                     high = glm::min(glm::ivec3(glm::floor(at + reach)), level.size - 1);
    for (int z = low.z; z <= high.z; z++)
      for (int y = low.y; y <= high.y; y++)
        for (int x = low.x; x <= high.x; x++) {
          const vec3 to = vec3(x, y, z) - at;
          const float weight = 1 / (dot(to, to) + 0.2f);
          sums[(size_t(z) * size_t(level.size.y) + size_t(y)) * size_t(level.size.x) + size_t(x)] +=
              weight * vec4(colors[i], 1);
        }
  }
  std::array<std::vector<uint16_t>, 3> planes;
  for (int channel = 0; channel < 3; channel++) {
    std::vector<uint16_t>& plane = planes[size_t(channel)];
    plane.resize(sums.size());
    for (size_t i = 0; i < sums.size(); i++) {
      const float light = sums[i].w > 0 ? sums[i][channel] / sums[i].w : unknown[channel];
      plane[i] = uint16_t(std::lround(most_code * std::sqrt(std::clamp(light, 0.0f, 1.0f))));
    }
  }
  return planes;
}

}  // namespace

void compare_model(const std::string& model, const std::string& scan, const ExhibitPiece& piece,
                   const Preset& outside, PieceLayer& layer) {
  SurfaceMesh mesh =
      is_mesh_file(model) ? read_mesh_file(model, 0.001) : read_scene_surface(model, 1);
  Comparison comparison = compare_surface(make_density_field(open_volume(scan)), {}, mesh);
  comparison.mesh = model, comparison.volume = scan;
  const int coarse = std::clamp(1, piece.volume->whole_level, int(piece.volume->levels.size()) - 1);
  ShownVolume volume = coarser(*piece.volume, coarse);
  set_colors(spread(comparison, volume), volume);
  comparison.points = std::vector<SurfacePoint>(), comparison.deviations = std::vector<Deviation>();
  Preset preset{layer.id, VolumeMode::surface, {{outside.points.front().value, vec3(1), 1}}};
  layer.preset = std::move(preset);
  layer.volume = std::make_shared<ShownVolume>(std::move(volume));
  layer.comparison = std::make_shared<Comparison>(std::move(comparison));
}

}  // namespace wellspring::show
