// SPDX-License-Identifier: Apache-2.0
// Keeps the light of lamps with a dial in bins of wavelengths (spectrum/bins.h), so that a map has
// it under each light of the dial. Three bins are a layer of an illumination map. A bin holds what
// a lamp of D65 with the same luminance would bring; what the lamp is, and what a surface whose
// reflectance is known by wavelength makes of it, are multiplied in afterwards. Other light is kept
// in colours, one layer for each lamp.
#pragma once
#include <array>
#include <memory>
#include <span>
#include <vector>

#include "light/sample/illumination_map.h"
#include "light/sample/transport.h"
#include "light/walk/walk.h"
#include "spectrum/bins.h"

namespace wellspring::light {

inline constexpr size_t bin_layers = usual_bins / 3;

// Says what a layer of a scene's map holds.
struct MapLayer {
  int lamp = -1;  // index into Scene::lamps; -1: the light that belongs to none
  int bin = -1;   // first of its three bins; -1: it holds colours
};
// Returns the layers of a scene's map: light of no lamp, then that of each lamp in turn.
std::vector<MapLayer> find_layers(const Scene& scene);

// Returns the colours of layers with the lamps at `levels`; none: with all full and as they are at
// first. On surfaces whose reflectance is known by wavelength it is the colour of what they reflect
// over their own. Takes some tens of microseconds for each lamp and reflectance.
LayerColors find_layer_colors(const Scene& scene, std::span<const LampLevel> levels = {});
// Returns the colour of a lamp's own light, if its light is kept in bins; else 1.
vec3 binned_color(const Scene& scene, int lamp);

// Holds what walks need that find light bin by bin.
struct WalkBins {
  using Means = std::array<vec3, bin_layers>;
  std::array<mat3, bin_layers> of_color;  // spectrum's color_means()
  std::vector<Means> means;               // one for each of Scene::spectra
};
// Returns null if no lamp's light is kept in bins.
std::shared_ptr<const WalkBins> make_walk_bins(const Scene& scene);

// Follows a walk's throughput in each bin, beside its colour. Directions are those of the colour's
// walk. Colours of which nothing more is known have the means of `of_color`.
class BinnedWalk {
 public:
  // `bins` is borrowed; null: there is nothing to follow, and nothing else may be called.
  explicit BinnedWalk(const WalkBins* bins) : bins_(bins) { throughput_.fill(vec3(1)); }
  bool is_followed() const { return bins_ != nullptr; }
  // Adds that the walk ran through a solid, which leaves `tint` of a colour.
  void absorb(const Material& solid, vec3 tint, float metres);
  // Prepares for the surface that the walk meets; `bsdf`: its colour's.
  void meet(const Transport& transport, const Walk& walk, const Surface& surface,
            const Material& material, const Bsdf& bsdf);
  // Adds that the surface scatters the walk. `lobes`: those that were sampled.
  void scatter(const BsdfSample& scattered, Lobes lobes);
  void divide(float chance);
  // Returns light of a colour that a layer's bins have, if it arrives along the walk; if the
  // surface sends it on from a direction; if as much arrives there from everywhere.
  vec3 arriving(size_t layer, vec3 color) const;
  vec3 sent_on(size_t layer, vec3 color, vec3 direction) const;
  vec3 diffuse(size_t layer) const;

 private:
  vec3 in_bins(size_t layer, vec3 color) const;
  const WalkBins* bins_;
  WalkBins::Means throughput_, base_;
  std::array<Bsdf, bin_layers> bsdfs_;
  vec3 base_color_{1};
  bool tints_gloss_ = false;
};

}  // namespace wellspring::light
