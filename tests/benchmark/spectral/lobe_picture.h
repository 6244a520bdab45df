// SPDX-License-Identifier: Apache-2.0
// Draws the picture by which Radziszewski, Boryczko and Alda (2009, section 5.5, table 1) compare
// ways to sample wavelengths: stripes of white light, seen through a ball that refracts once, each
// wavelength into a lobe cos^n about a direction of its own. All estimators draw on the same
// clusters of the renderer (light/material/wavelengths.h); the picture is known without noise.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "light/material/spectral_tables.h"
#include "world/world.h"

namespace wellspring::test {

// Names how a cluster is weighed once its first wavelength has chosen the direction.
enum class LobeEstimator {
  mis,     // by the sum of all densities: the renderer's, equation 7
  single,  // one wavelength alone, as pbrt-v4 has it from the first dispersive surface on
  naive,   // all by the density of the one that chose, equation 5
};

// Says how the ball's index of refraction falls from 360 nm to 830 nm, in a straight line, and how
// sharp its lobes are.
struct LobeMaterial {
  double index_at_360 = 1.35, index_at_830 = 1.2;
  double exponent = 1000;
};

using LobePixels = std::vector<dvec3>;  // linear Rec. 709; white light is 1

class LobePicture {
 public:
  // `size`: pixels along each side.
  LobePicture(const LobeMaterial& material, int size);
  // Returns the sums over all nanometres of what the lobes see.
  LobePixels reference() const;
  // Returns the means of a number of clusters in each pixel, well spread among them. Runs on all
  // cores.
  LobePixels draw(LobeEstimator estimator, int clusters, uint64_t seed) const;
  // Returns the variance of one cluster, the mean over pixels and channels, from `count` of them.
  double variance(LobeEstimator estimator, int count, uint64_t seed) const;

 private:
  vec3 place_of(int pixel) const;  // on the unit sphere, which is its normal there, too
  float index_of(float nm) const;
  vec3 cluster(LobeEstimator estimator, int pixel, uint64_t seed, uint32_t index) const;
  double seen(double sine) const;

  LobeMaterial lobes_;
  int size_;
  Material material_;
  std::shared_ptr<const SpectralTables> tables_;
  Scene ball_scene_, stripes_scene_;
  std::unique_ptr<World> ball_, stripes_;
  std::vector<double> seen_;  // share of a lobe above a plane, by the sine between them
};

// Returns the mean absolute difference over pixels and channels; `shown`: of values cut to [0, 1].
double lobe_error(std::span<const dvec3> picture, std::span<const dvec3> truth, bool shown);

}  // namespace wellspring::test
