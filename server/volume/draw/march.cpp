// SPDX-License-Identifier: Apache-2.0
#include "volume/draw/march.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "volume/draw/along_ray.h"
#include "volume/draw/level_samples.h"
#include "volume/draw/matter_light.h"

namespace wellspring::volume {
namespace {

constexpr float nearly_opaque = 0.004f;  // share of light that comes through and changes no code
constexpr float least_leap = 1e-3f;      // samples beyond a cell's border

// Follows eight rays through one level. Samples: WholeSamples or BrickSamples.
template <class Samples>
class March {
 public:
  March(const ShownVolume& volume, const DrawnPreset& preset, const VolumeRays& rays,
        const MarchSettings& settings)
      : level_(volume.levels[size_t(settings.level)]),
        samples_(volume, settings.level),
        preset_(preset),
        seen_(preset.seen[size_t(settings.level)]),
        to_samples_(volume, settings.level),
        light_(preset.light, preset.grid, to_samples_, settings.level, rays.direction),
        cuts_(settings.cuts),
        rays_(rays),
        voxel_(float(volume.voxel)) {
    origin_ = to_samples_.place(rays.origin), way_ = to_samples_.way(rays.direction);
    const Lanes speed = lanes_sqrt(dot(way_, way_));  // samples a metre
    step_ = settings.step / speed;
    near_ = rays.near, far_ = rays.far;
    clip_to(origin_.x, way_.x, level_.size.x), clip_to(origin_.y, way_.y, level_.size.y),
        clip_to(origin_.z, way_.z, level_.size.z);
    for (const VolumeCut& cut : settings.cuts) clip_to(rays, cut);
    place_ = near_ + settings.jitter * step_;
    if (preset.table.mode() == VolumeMode::maximum) follow_maximum();
    else if (preset.table.mode() == VolumeMode::surface) find_surface();
    else if (preset.table.mode() == VolumeMode::glow) add_glow();
    else add_up();
  }
  MarchedLight found;

 private:
  const VolumeLevel& level_;
  Samples samples_;
  const DrawnPreset& preset_;
  const std::vector<uint8_t>& seen_;
  const ToSamples to_samples_;
  const MatterLight light_;
  const std::span<const VolumeCut> cuts_;
  const VolumeRays& rays_;
  const float voxel_;  // metres
  Lanes3 origin_, way_;
  Lanes step_, near_, far_, place_;

  void clip(const Lanes& distance, const Lanes& speed) {
    // Keeps where distance + t * speed >= 0.
    const Lanes at = -distance / speed;
    near_ = speed > 0.0f ? lanes_max(near_, at) : near_;
    far_ = speed < 0.0f ? lanes_min(far_, at) : far_;
    far_ = (speed == 0.0f) & (distance < 0.0f) ? all_lanes(-INFINITY) : far_;
  }
  void clip_to(const Lanes& from, const Lanes& way, int size) {
    clip(from + 0.5f, way);
    clip(float(size) - 0.5f - from, -way);
  }
  void clip_to(const VolumeRays& rays, const VolumeCut& cut) {
    clip(dot(rays.origin, all_lanes(cut.normal)) - cut.offset,
         dot(rays.direction, all_lanes(cut.normal)));
  }
  Lanes exposed(const Lanes& place) const {
    return cuts_.empty() ? Lanes{} : laid_open(cuts_, rays_.origin, rays_.direction, place, voxel_);
  }
  Lanes3 at(const Lanes& place) const { return origin_ + way_ * place; }

  // Returns the lanes whose cell shows something; moves the others to the end of theirs.
  LaneMask leap(const LaneMask& active) {
    LaneMask full{};
    const Lanes3 p = at(place_);
    for (unsigned bits = negative_lanes(active); bits != 0; bits &= bits - 1) {
      const int k = std::countr_zero(bits);
      const glm::ivec3 cell =
          glm::clamp(glm::ivec3(glm::floor(p.at(k))) / cell_side, glm::ivec3(0), level_.cells - 1);
      if (seen_[(size_t(cell.z) * size_t(level_.cells.y) + size_t(cell.y)) *
                    size_t(level_.cells.x) +
                size_t(cell.x)]) {
        full[k] = -1;
        continue;
      }
      const vec3 way = way_.at(k), from = origin_.at(k);
      float end = INFINITY;
      for (int axis = 0; axis < 3; axis++) {
        if (way[axis] == 0) continue;
        const bool up = way[axis] > 0;
        const bool last = up ? cell[axis] + 1 == level_.cells[axis] : cell[axis] == 0;
        if (last) continue;  // beyond it is the end of the volume
        const float border = float((cell[axis] + up) * cell_side) + (up ? 1 : -1) * least_leap;
        end = std::min(end, (border - from[axis]) / way[axis]);
      }
      // By whole steps, so that where a ray is sampled does not depend on cells.
      const float steps = std::ceil((end - place_[k]) / step_[k]);
      place_[k] = end == INFINITY ? INFINITY : place_[k] + std::max(steps, 1.0f) * step_[k];
    }
    return full;
  }

  // Calls read(full) at each place of the rays, for the lanes whose cell shows something, while
  // more than `least` of the light behind comes through.
  template <class Read>
  void follow(float least, const Read& read) {
    found.clear = all_lanes(1), found.depth = all_lanes(INFINITY);
    LaneMask active = place_ < far_;
    while (any_lane(active)) {
      const LaneMask full = leap(active);
      if (any_lane(full)) {
        read(full);
        found.steps += std::popcount(negative_lanes(full));
        place_ = full ? place_ + step_ : place_;
      }
      active = (place_ < far_) & (found.clear > least);
    }
  }

  void add_up() {
    follow(nearly_opaque, [&](const LaneMask& full) {
      const Lanes3 p = at(place_);
      const LanesLit sample = samples_.value_and_normal(p, full);
      Lanes density;
      const Lanes3 color = preset_.table.look(sample.value, density) * own_color(level_, p);
      const Lanes through = fade(density * step_);
      const LaneMask some = full & (density > 0.0f);
      if (!any_lane(some)) return;
      const Lanes share = keep_lanes(some, found.clear * (1.0f - through));
      found.color = found.color + light_.lit(color, p, sample.normal, exposed(place_)) * share;
      const Lanes after = some ? found.clear * through : found.clear;
      found.depth = (found.clear > 0.5f) & (after <= 0.5f) ? place_ : found.depth;
      found.clear = after;
    });
  }

  void add_glow() {
    follow(0, [&](const LaneMask& full) {
      const Lanes3 p = at(place_);
      Lanes light;
      const Lanes3 color =
          preset_.table.look(samples_.value(p, full), light) * own_color(level_, p);
      found.color = found.color + color * keep_lanes(full, light * step_);
    });
  }

  void find_surface() {
    const float threshold = preset_.table.threshold();
    Lanes before = near_, value_before{};
    LaneMask first = LaneMask{} - 1;  // nothing was read yet
    follow(0.5f, [&](const LaneMask& full) {
      const Lanes value = samples_.value(at(place_), full);
      const LaneMask hit = full & (value >= threshold) & (found.clear > 0.5f);
      if (any_lane(hit)) {
        const LaneMask crossed = hit & ~first & (value_before < threshold);
        const Lanes way = (threshold - value_before) / (value - value_before);
        const Lanes place = crossed ? before + (place_ - before) * way : place_;
        const Lanes3 p = at(place);
        const LanesLit there = samples_.value_and_normal(p, hit);
        Lanes density;
        const Lanes3 color =
            preset_.table.look(lanes_max(there.value, all_lanes(threshold)), density);
        found.color = choose(hit, light_.lit(color, p, there.normal, exposed(place)), found.color);
        found.depth = hit ? place : found.depth;
        found.clear = hit ? Lanes{} : found.clear;
      }
      before = full ? place_ : before, value_before = full ? value : value_before;
      first &= ~full;
    });
  }

  void follow_maximum() {
    Lanes most = all_lanes(-1), where = all_lanes(INFINITY);
    follow(0, [&](const LaneMask& full) {
      const Lanes value = samples_.value(at(place_), full);
      const LaneMask more = full & (value > most);
      most = more ? value : most, where = more ? place_ : where;
    });
    Lanes opacity;
    const Lanes3 color = preset_.table.look(positive_lanes(most), opacity);
    opacity = keep_lanes(most >= 0.0f, lanes_min(opacity, all_lanes(1)));
    found.color = color * opacity;
    found.clear = 1.0f - opacity;
    found.depth = opacity > 0.5f ? where : all_lanes(INFINITY);
  }
};

// Each is a function of its own, so that the compiler inlines in one what it would in the other.
template <class Samples>
[[gnu::noinline]] MarchedLight march_through(const ShownVolume& volume, const DrawnPreset& preset,
                                             const VolumeRays& rays,
                                             const MarchSettings& settings) {
  return March<Samples>(volume, preset, rays, settings).found;
}

}  // namespace

DrawnPreset::DrawnPreset(const ShownVolume& volume, const Preset& preset, const VolumeLight& of)
    : table(preset, volume), light(of), grid(make_light_grid(volume, table, of)) {
  for (const VolumeLevel& level : volume.levels) {
    std::vector<uint8_t>& cells = seen.emplace_back();
    for (const CodeRange& range : level.ranges) cells.push_back(!table.is_empty(range));
  }
}

MarchedLight march(const ShownVolume& volume, const DrawnPreset& preset, const VolumeRays& rays,
                   const MarchSettings& settings) {
  return volume.bricks ? march_through<BrickSamples>(volume, preset, rays, settings)
                       : march_through<WholeSamples>(volume, preset, rays, settings);
}

int level_for(const ShownVolume& volume, double footprint) {
  const double levels = std::log2(std::max(footprint / volume.voxel, 1.0));
  return std::min(int(levels), int(volume.levels.size()) - 1);
}

}  // namespace wellspring::volume
