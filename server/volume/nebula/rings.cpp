// SPDX-License-Identifier: Apache-2.0
#include "volume/nebula/rings.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/load_error.h"
#include "base/parallel.h"

namespace wellspring::volume {

namespace {

constexpr int pieces_of_a_system = 8;
constexpr double least_length = 1e-9;  // in ring thicknesses; shorter ones are left out

// Adds the lengths of one ray. The place on a ray is told by q, its distance from the plane that
// holds the axis and is parallel to it: there the radius is sqrt(beside^2 + q^2), the height along
// the axis is along / cos(tilt) + q tan(tilt), and a step of q is cos(tilt) long.
class RowMaker {
 public:
  RowMaker(const RingGrid& grid, double tilt)
      : grid_(grid),
        cosine_(std::cos(tilt)),
        slope_(std::abs(std::tan(tilt))),
        crossing_(size_t(grid.radial) + 1) {}

  void add_row(glm::dvec2 ray, RingRows& rows) {
    const double beside = std::abs(ray.y);
    if (!(beside < grid_.radius) || !std::isfinite(ray.x)) return;
    const double thickness = grid_.thickness();
    for (int k = int(beside / thickness); k <= grid_.radial; ++k)
      crossing_[size_t(k)] =
          std::sqrt(std::max(0.0, k * thickness * (k * thickness) - beside * beside));
    const double reach = crossing_[size_t(grid_.radial)], slab = grid_.slab();
    const double height = ray.x / cosine_ + grid_.half_length;  // above the lowest slab
    if (slope_ * reach < 1e-9 * slab) {
      const double m = std::floor(height / slab);
      if (m >= 0 && m < grid_.axial) add_slab(int(m), beside, -reach, reach, rows);
      return;
    }
    const double lowest = (height - slope_ * reach) / slab,
                 highest = (height + slope_ * reach) / slab;
    if (highest < 0 || lowest >= grid_.axial) return;
    const int first = std::max(0, int(lowest)), last = int(std::min(highest, grid_.axial - 1.0));
    for (int m = first; m <= last; ++m) {
      const double from = std::max(-reach, (m * slab - height) / slope_),
                   to = std::min(reach, ((m + 1) * slab - height) / slope_);
      if (from < to) add_slab(m, beside, from, to, rows);
    }
  }

 private:
  // Adds the rings that the ray meets from `from` to `to` within a slab. A ring's length is that in
  // the cylinder round it minus that in the cylinder it goes round, each cut at the slab's sides,
  // so that a ray that meets a ring twice has both.
  void add_slab(int m, double beside, double from, double to, RingRows& rows) {
    const double near = from <= 0 && to >= 0 ? 0 : std::min(std::abs(from), std::abs(to)),
                 far = std::max(std::abs(from), std::abs(to));
    const auto ring_at = [&](double q) {
      return std::min(grid_.radial - 1, int(std::hypot(beside, q) / grid_.thickness()));
    };
    const auto within = [&](int k) {
      const double crossing = crossing_[size_t(k)];
      return std::max(0.0, std::min(crossing, to) - std::max(-crossing, from));
    };
    const int first = ring_at(near), last = ring_at(far);
    double inner = within(first);
    for (int k = first; k <= last; ++k) {
      const double outer = within(k + 1);
      const double length = (outer - inner) / cosine_;
      inner = outer;
      if (length <= least_length * grid_.thickness()) continue;
      rows.ring.push_back(uint16_t(grid_.index(k, m)));
      rows.length.push_back(float(length));
    }
  }

  const RingGrid grid_;
  const double cosine_, slope_;
  std::vector<double> crossing_;  // the ray's q at each radius, from the first that it meets
};

}  // namespace

size_t RingSystem::entries() const {
  size_t sum = 0;
  for (const RingRows& rows : pieces) sum += rows.length.size();
  return sum;
}

RingSystem make_ring_system(const RingGrid& grid, double tilt, std::span<const glm::dvec2> rays) {
  if (grid.radial < 1 || grid.axial < 1 || int64_t(grid.radial) * grid.axial > most_rings)
    throw LoadError("nebula", "rings", "has to be 1 to " + std::to_string(most_rings));
  if (!(grid.radius > 0) || !(grid.half_length > 0))
    throw LoadError("nebula", "rings", "have no size");
  if (!(std::abs(tilt) <= most_tilt))
    throw LoadError("nebula", "tilt", "is more than 75 degrees out of the picture");
  RingSystem system{grid, int(rays.size()), {}};
  const int pieces = std::clamp(int(rays.size()), 1, pieces_of_a_system);
  system.pieces.resize(size_t(pieces));
  parallel_each(pieces, [&](int piece) {
    RingRows& rows = system.pieces[size_t(piece)];
    RowMaker maker(grid, tilt);
    const size_t first = rays.size() * size_t(piece) / size_t(pieces),
                 end = rays.size() * (size_t(piece) + 1) / size_t(pieces);
    rows.first_ray = int(first);
    rows.begin.push_back(0);
    for (size_t ray = first; ray < end; ++ray) {
      maker.add_row(rays[ray], rows);
      rows.begin.push_back(uint32_t(rows.length.size()));
    }
  });
  return system;
}

}  // namespace wellspring::volume
