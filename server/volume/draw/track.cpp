// SPDX-License-Identifier: Apache-2.0
#include "volume/draw/track.h"

#include <algorithm>
#include <cmath>

#include "volume/draw/level_samples.h"
#include "volume/draw/matter_light.h"

namespace wellspring::volume {
namespace {

constexpr int refinements = 3;  // halvings of the step in which a surface is crossed

}  // namespace

// Follows one ray. Distances are metres from `start`, the place where the ray comes in: far away
// from the volume a ray's own distances are too coarse.
class Tracker::Flight {
 public:
  Flight(const Tracker& tracker, const VolumeRay& ray, Rng& random)
      : level_(tracker.volume_->levels[size_t(tracker.settings_.level)]),
        samples_(*tracker.volume_, tracker.settings_.level),
        table_(tracker.preset_->table),
        settings_(tracker.settings_),
        tracker_(tracker),
        ray_(ray),
        random_(random) {
    const ToSamples& to = tracker.to_samples_;
    way_ = to.turn * ray.direction;
    const vec3 origin = to.turn * ray.origin + to.shift;
    near_ = ray.near, far_ = ray.far;
    for (int i = 0; i < 3; i++) {
      clip(origin[i] + 0.5f, way_[i]);
      clip(float(level_.size[i]) - 0.5f - origin[i], -way_[i]);
    }
    for (const VolumeCut& cut : settings_.cuts)
      clip(dot(ray.origin, cut.normal) - cut.offset, dot(ray.direction, cut.normal));
    start_ = to.turn * (ray.origin + ray.direction * near_) + to.shift;
    length_ = far_ - near_;
    step_ = settings_.step / glm::length(way_);
  }
  bool is_inside() const { return length_ > 0 && std::isfinite(length_); }

  void find_collision() {
    float thickness = draw_thickness();  // left until the next collision is drawn
    visit_cells([&](const CodeRange& range, float from, float to) {
      const float largest = table_.largest_density(range);
      if (!(largest > 0)) return true;
      for (float place = from;;) {
        const float run = thickness / largest;
        if (!(place + run < to)) {
          thickness = std::max(thickness - largest * (to - place), 0.0f);
          return true;
        }
        place += run;
        if (random_.uniform() * largest < table_.density_of(read(place))) {
          stop(place);
          return false;
        }
        thickness = draw_thickness();
      }
    });
  }

  void find_surface() {
    const float threshold = table_.threshold();
    look_along([&](const CodeRange& range) { return !table_.is_empty(range); },
               [&](float place, float value) {
                 if (value < threshold) return true;
                 stop(place);
                 return false;
               });
  }

  // Narrows a surface down between where it was found and the look before.
  void refine_surface() {
    if (!found.is_stopped()) return;
    const float threshold = table_.threshold();
    float inside = stopped_, outside = std::max(inside - step_, 0.0f);
    float value_inside = read(inside), value_outside = read(outside);
    if (value_outside >= threshold) return stop(outside);
    for (int i = 0; i < refinements; i++) {
      const float middle = 0.5f * (inside + outside), value = read(middle);
      if (value < threshold) outside = middle, value_outside = value;
      else inside = middle, value_inside = value;
    }
    const float way = (threshold - value_outside) / (value_inside - value_outside);
    stop(outside + (inside - outside) * way);
  }

  void find_maximum() {
    float most = -1, where = 0;
    look_along(
        [&](const CodeRange& range) { return float(range.most) > most && !table_.is_empty(range); },
        [&](float place, float value) {
          if (value > most) most = value, where = place;
          return true;
        });
    if (most >= 0 && random_.uniform() < table_.density_of(most)) stop(where);
  }

  // Sets the light of a place drawn along the ray, as if it were sent all along.
  void find_glow() {
    const vec3 place = at(random_.uniform() * length_);
    found.reads++;
    Lanes light;
    const Lanes3 color =
        table_.look(all_lanes(samples_.value(place)), light) * own_color(level_, all_lanes(place));
    found.color = (color * (light * length_)).at(0);
  }

  Lanes exposed() const {
    return laid_open(settings_.cuts, all_lanes(ray_.origin), all_lanes(ray_.direction),
                     all_lanes(found.distance), float(tracker_.volume_->voxel));
  }

  // Sets the colour of the place where the ray was stopped.
  void light_up() {
    if (!found.is_stopped()) return;
    const vec3 place = at(stopped_);
    LanesLit there = samples_.value_and_normal(place);
    const VolumeMode mode = table_.mode();
    if (mode == VolumeMode::surface)
      there.value = lanes_max(there.value, all_lanes(table_.threshold()));
    Lanes density;
    const Lanes3 color = table_.look(there.value, density) * own_color(level_, all_lanes(place));
    const DrawnPreset& preset = *tracker_.preset_;
    const MatterLight light(preset.light, preset.grid, tracker_.to_samples_, settings_.level,
                            all_lanes(ray_.direction));
    found.color =
        (mode == VolumeMode::maximum ? color
                                     : light.lit(color, all_lanes(place), there.normal, exposed()))
            .at(0);
  }

  TrackedRay found;

 private:
  const VolumeLevel& level_;
  PlaceSamples samples_;
  const TransferTable& table_;
  const TrackSettings& settings_;
  const Tracker& tracker_;
  const VolumeRay& ray_;
  Rng& random_;
  vec3 way_, start_;  // samples a metre; samples
  float near_, far_, length_, step_, stopped_ = 0;

  void clip(float distance, float speed) {
    // Keeps where distance + t * speed >= 0.
    if (speed > 0) near_ = std::max(near_, -distance / speed);
    else if (speed < 0) far_ = std::min(far_, -distance / speed);
    else if (distance < 0) far_ = -std::numeric_limits<float>::infinity();
  }
  vec3 at(float place) const { return start_ + way_ * place; }
  float read(float place) {
    found.reads++;
    return samples_.value(at(place));
  }
  void stop(float place) { stopped_ = place, found.distance = near_ + place; }
  float draw_thickness() { return -std::log(1 - random_.uniform()); }

  // Calls visit(range, from, to) for the cells that the ray crosses, nearest first, while it
  // returns true.
  template <class Visit>
  void visit_cells(const Visit& visit) {
    glm::ivec3 cell =
        glm::clamp(glm::ivec3(glm::floor(start_)) / cell_side, glm::ivec3(0), level_.cells - 1);
    constexpr float never = std::numeric_limits<float>::infinity();
    auto leaves = [&](int axis) {
      const bool up = way_[axis] > 0;
      const bool last = up ? cell[axis] + 1 == level_.cells[axis] : cell[axis] == 0;
      if (way_[axis] == 0 || last) return never;  // beyond it is the end of the volume
      return (float((cell[axis] + up) * cell_side) - start_[axis]) / way_[axis];
    };
    vec3 end(leaves(0), leaves(1), leaves(2));
    for (float from = 0;;) {
      const int axis = end.x <= end.y ? (end.x <= end.z ? 0 : 2) : (end.y <= end.z ? 1 : 2);
      const float to = std::min(end[axis], length_);
      const CodeRange& range =
          level_.ranges[(size_t(cell.z) * size_t(level_.cells.y) + size_t(cell.y)) *
                            size_t(level_.cells.x) +
                        size_t(cell.x)];
      if (to > from && !visit(range, from, to)) return;
      if (!(end[axis] < length_)) return;
      from = std::max(from, to);
      cell[axis] += way_[axis] > 0 ? 1 : -1;
      end[axis] = leaves(axis);
    }
  }

  // Calls look(place, value) a step apart, in the cells that wanted(range) says, while it returns
  // true.
  template <class Wanted, class Look>
  void look_along(const Wanted& wanted, const Look& look) {
    const float first = random_.uniform();  // steps to the first look
    int64_t next = 0;
    visit_cells([&](const CodeRange& range, float from, float to) {
      next = std::max(next, int64_t(std::ceil(from / step_ - first)));
      if (!wanted(range)) return true;
      for (;; next++) {
        const float place = (float(next) + first) * step_;
        if (!(place < to)) return true;
        if (!look(place, read(place))) return false;
      }
    });
  }
};

Tracker::Tracker(const ShownVolume& volume, const DrawnPreset& preset,
                 const TrackSettings& settings)
    : volume_(&volume),
      preset_(&preset),
      settings_(settings),
      to_samples_(volume, settings.level),
      empty_(preset.table.is_empty({0, uint16_t(most_code)})) {}

vec3 Tracker::glow(const VolumeRay& ray, Rng& random) const {
  if (empty_ || mode() != VolumeMode::glow) return vec3(0);
  Flight flight(*this, ray, random);
  if (flight.is_inside()) flight.find_glow();
  return flight.found.color;
}

TrackedRay Tracker::track(const VolumeRay& ray, Rng& random) const {
  if (empty_ || mode() == VolumeMode::glow) return {};
  Flight flight(*this, ray, random);
  if (!flight.is_inside()) return {};
  if (mode() == VolumeMode::maximum) flight.find_maximum();
  else if (mode() == VolumeMode::density) flight.find_collision();
  else flight.find_surface(), flight.refine_surface();
  flight.light_up();
  return flight.found;
}

TrackedRay Tracker::track_shadow(const VolumeRay& ray, Rng& random) const {
  if (empty_ || mode() == VolumeMode::maximum || mode() == VolumeMode::glow) return {};
  Flight flight(*this, ray, random);
  if (!flight.is_inside()) return {};
  if (mode() == VolumeMode::density) flight.find_collision();
  else flight.find_surface();
  return flight.found;
}

}  // namespace wellspring::volume
