// SPDX-License-Identifier: Apache-2.0
#include "light/kept/binned_light.h"

#include <algorithm>
#include <cmath>

#include "light/sample/medium.h"
#include "light/walk/known_light.h"
#include "spectrum/color.h"
#include "spectrum/observer.h"
#include "world/load/scene_spectra.h"

namespace wellspring::light {
namespace {

constexpr float least_base = 1e-3f;  // a channel of a colour that is divided by is at least so much

const SpectralBins& bins() {
  static const SpectralBins made = make_bins();
  return made;
}

// Returns the relative power with which a lamp shines, as an index into Scene::spectra; -1: it has
// a colour.
int spectrum_of(const Scene& scene, const Lamp& lamp, LampLevel level) {
  if (const LampLight* light = dialed(lamp, level)) return light->spectrum;
  if (!lamp.lights.empty()) return scene.lights[size_t(lamp.lights[0])].spectrum;
  if (!lamp.materials.empty()) return scene.materials[size_t(lamp.materials[0])].spectra.emission;
  return -1;
}

// Returns whether the light of a lamp is kept in bins: others of its lights are known by
// wavelength, and so is its own.
bool has_bins(const Scene& scene, const Lamp& lamp) {
  return !lamp.dial.empty() && spectrum_of(scene, lamp, {}) >= 0;
}

// Returns the colour in which a material shows a reflectance.
vec3 base_of(const Scene& scene, int reflectance) {
  for (const Material& material : scene.materials)
    if (material.spectra.reflectance == reflectance) return material.spectra.base;
  return vec3(1);
}

// Holds what a surface makes of light: reflectance, and the colour that it has by itself.
struct Reflecting {
  Spectrum by_wavelength = even_spectrum(1);
  dvec3 color{1};
};
Reflecting reflecting(const Scene& scene, int reflectance) {
  if (reflectance < 0) return {};
  return {scene.spectra[size_t(reflectance)].value, dvec3(base_of(scene, reflectance))};
}

// Returns what each bin of a lamp's light adds to a colour.
std::array<vec3, usual_bins> bin_colors(const LampObserver& lamp, const Reflecting& surface) {
  std::array<dvec3, usual_bins> parts;
  dvec3 sum(0);
  for (size_t b = 0; b < parts.size(); b++) {
    Spectrum part;
    for (size_t i = 0; i < spectrum_size; i++)
      part[i] = bins().shapes[b][i] * surface.by_wavelength[i];
    sum += parts[b] = lamp.xyz(part);
  }
  // The shapes add up to 1 but for some thousandths.
  const dvec3 scale = lamp.xyz(surface.by_wavelength) / glm::max(sum, dvec3(1e-12));
  std::array<vec3, usual_bins> colors;
  for (size_t b = 0; b < parts.size(); b++)
    colors[b] = vec3(rgb_of(parts[b] * scale) / surface.color);
  return colors;
}

// Returns what a surface makes of light that has the lamp's colour.
vec3 reflected_once(const Scene& scene, int power, const Reflecting& surface) {
  const Spectrum& value = scene.spectra[size_t(power)].value;
  const dvec3 color = rgb_of(LampObserver(value).xyz(surface.by_wavelength));
  return vec3(color / (surface.color * dvec3(lamp_color(value))));
}

mat3 diagonal(vec3 v) { return mat3(vec3(v.x, 0, 0), vec3(0, v.y, 0), vec3(0, 0, v.z)); }

}  // namespace

std::vector<MapLayer> find_layers(const Scene& scene) {
  std::vector<MapLayer> layers(1);
  for (int lamp = 0; lamp < int(scene.lamps.size()); lamp++) {
    if (!has_bins(scene, scene.lamps[size_t(lamp)])) layers.push_back({lamp, -1});
    else
      for (int bin = 0; bin < usual_bins; bin += 3) layers.push_back({lamp, bin});
  }
  return layers;
}

vec3 binned_color(const Scene& scene, int lamp) {
  const Lamp& own = scene.lamps[size_t(lamp)];
  if (!has_bins(scene, own)) return vec3(1);
  return lamp_color(scene.spectra[size_t(spectrum_of(scene, own, {}))].value);
}

static std::vector<mat3> colors_on(const Scene& scene, std::span<const LampLevel> levels,
                                   int reflectance) {
  const Reflecting surface = reflecting(scene, reflectance);
  std::vector<mat3> colors;
  std::array<vec3, usual_bins> of_bins;
  for (const MapLayer& layer : find_layers(scene)) {
    if (layer.lamp < 0) {
      colors.push_back(mat3(1));
      continue;
    }
    const Lamp& lamp = scene.lamps[size_t(layer.lamp)];
    const LampLevel level = levels.empty() ? LampLevel{} : levels[size_t(layer.lamp)];
    const int power = spectrum_of(scene, lamp, level);
    if (layer.bin < 0) {
      const bool known = reflectance >= 0 && power >= 0;
      colors.push_back(diagonal(factor_of(lamp, level) *
                                (known ? reflected_once(scene, power, surface) : vec3(1))));
      continue;
    }
    if (layer.bin == 0)
      of_bins = bin_colors(LampObserver(scene.spectra[size_t(power)].value), surface);
    const vec3* three = &of_bins[size_t(layer.bin)];
    colors.push_back(brightness_of(level) * mat3(three[0], three[1], three[2]));
  }
  return colors;
}

LayerColors find_layer_colors(const Scene& scene, std::span<const LampLevel> levels) {
  LayerColors colors;
  colors.of.push_back(colors_on(scene, levels, -1));
  for (const Material& material : scene.materials) {
    const int reflectance = material.spectra.reflectance;
    if (reflectance < 0) continue;
    const size_t at = size_t(reflectance) + 1;
    if (colors.of.size() <= at) colors.of.resize(at + 1);
    if (colors.of[at].empty()) colors.of[at] = colors_on(scene, levels, reflectance);
  }
  return colors;
}

std::shared_ptr<const WalkBins> make_walk_bins(const Scene& scene) {
  if (std::ranges::none_of(scene.lamps, [&](const Lamp& lamp) { return has_bins(scene, lamp); }))
    return nullptr;
  auto made = std::make_shared<WalkBins>();
  auto at = [](auto& layers, size_t bin, auto value) { layers[bin / 3][int(bin % 3)] = value; };
  const std::vector<dvec3> of_color = color_means(bins());
  std::array<mat3, bin_layers> rows;
  for (size_t b = 0; b < of_color.size(); b++) at(rows, b, vec3(of_color[b]));
  for (size_t l = 0; l < bin_layers; l++) made->of_color[l] = glm::transpose(rows[l]);
  for (const SceneSpectrum& spectrum : scene.spectra) {
    const std::vector<double> means = bin_means(bins(), spectrum.value);
    WalkBins::Means& own = made->means.emplace_back();
    for (size_t b = 0; b < means.size(); b++) at(own, b, float(means[b]));
  }
  return made;
}

vec3 BinnedWalk::in_bins(size_t layer, vec3 color) const {
  return max(bins_->of_color[layer] * color, vec3(0));
}

void BinnedWalk::absorb(const Material& solid, vec3 tint, float metres) {
  const int known = solid.spectra.absorption;
  for (size_t l = 0; l < bin_layers; l++)
    throughput_[l] *= known < 0 ? in_bins(l, tint) : exp(-metres * bins_->means[size_t(known)][l]);
}

void BinnedWalk::meet(const Transport& transport, const Walk& walk, const Surface& surface,
                      const Material& material, const Bsdf& bsdf) {
  const int known = material.spectra.reflectance;
  tints_gloss_ = tints_gloss(material);
  base_color_ = surface.base_color;
  // Greys are the same in all bins.
  auto is_grey = [](vec3 c) { return c.x == c.y && c.y == c.z; };
  const bool grey = known < 0 && is_grey(surface.base_color) && is_grey(surface.specular_color) &&
                    is_grey(surface.sheen_color);
  Surface in_layer = surface;
  for (size_t l = 0; l < bin_layers; l++) {
    base_[l] = grey
                   ? surface.base_color
                   : in_bins(l, surface.base_color / (known < 0 ? vec3(1) : material.spectra.base));
    if (known >= 0) base_[l] *= bins_->means[size_t(known)][l];
    if (grey) {
      bsdfs_[l] = bsdf;
      continue;
    }
    in_layer.base_color = base_[l];
    in_layer.specular_color = in_bins(l, surface.specular_color);
    in_layer.sheen_color = in_bins(l, surface.sheen_color);
    bsdfs_[l] = make_bsdf_in(transport, walk.media, in_layer, material, walk.ray.direction);
  }
}

void BinnedWalk::scatter(const BsdfSample& scattered, Lobes lobes) {
  const bool tinted = tints_gloss_ || scattered.bounce != Bounce::reflect;
  for (size_t l = 0; l < bin_layers; l++) {
    if (scattered.pdf > 0) {
      const BsdfValue value = eval_bsdf(bsdfs_[l], scattered.direction);
      const vec3 sum = lobes == Lobes::specular ? value.specular : value.diffuse + value.specular;
      throughput_[l] *= sum / scattered.pdf;
    } else if (tinted) {
      throughput_[l] *=
          base_[l] * in_bins(l, scattered.weight / max(base_color_, vec3(least_base)));
    } else {
      throughput_[l] *= in_bins(l, scattered.weight);
    }
  }
}

void BinnedWalk::divide(float chance) {
  for (vec3& light : throughput_) light /= chance;
}

vec3 BinnedWalk::arriving(size_t layer, vec3 color) const {
  return throughput_[layer] * in_bins(layer, color);
}

vec3 BinnedWalk::sent_on(size_t layer, vec3 color, vec3 direction) const {
  const BsdfValue value = eval_bsdf(bsdfs_[layer], direction);
  return arriving(layer, color) * (value.diffuse + value.specular);
}

vec3 BinnedWalk::diffuse(size_t layer) const {
  return throughput_[layer] * kept_reflectance(bsdfs_[layer]);
}

}  // namespace wellspring::light
