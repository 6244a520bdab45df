// SPDX-License-Identifier: Apache-2.0
// Finds what a material can do where it is used: its factors together with the darkest and
// brightest texel of its textures and the colours of the mesh, so that an extension of strength
// zero, a black texture or an alpha that is always cut off counts as not being there. The results
// are bounds, not guesses: what is ruled out here cannot happen at any place of the surface.
#pragma once
#include <cstdint>
#include <map>
#include <vector>

#include "world/scene.h"

namespace wellspring::light {

// Lobes smoother than this perceptual roughness cast light sharply enough to be called a caustic.
inline constexpr float caustic_roughness = 0.3f;

// Says what the first surface that an eye meets keeps of a metal (light/walk/first_surface.h).
enum class MetalDemodulation : uint8_t {
  none,
  reflectance,  // it is metal all over, and nowhere a mirror
  light,  // and rough enough all over, without a coat, that its light is filtered as diffuse is
};
inline constexpr float all_metal = 0.8f;  // metallic
inline constexpr float least_demodulated_roughness = 0.2f, least_filtered_roughness = 0.25f;

// Returns whether what a material does to light is known by wavelength.
inline bool knows_wavelengths(const Material& m) {
  return m.spectra.reflectance >= 0 || m.spectra.index >= 0 || m.spectra.absorption >= 0;
}

// Describes a material in use: each is whether it may be so at some place of the surface.
struct MaterialUse {
  bool visible = false;   // by its alpha; if false, nothing else is set
  bool receives = false;  // light makes a difference to it: it is not unlit
  bool scatters = false;  // and some of its light leaves in other than perfect directions
  bool emits = false;
  bool emission_varies = false;  // over the surface: a picture, vertex colours or alpha
  bool pane = false;             // a thin smooth pane: light passes straight
  bool solid = false;            // refracts, has an inside
  bool absorbs = false;          // tints light that runs in it
  bool disperses = false;
  bool spectral = false;  // knows_wavelengths()
  bool coated = false;    // clearcoat or sheen
  bool sharp = false;     // casts caustics: some lobe is smoother than caustic_roughness
  MetalDemodulation metal = MetalDemodulation::none;
};
// Returns what holds for either.
MaterialUse merge(const MaterialUse& a, const MaterialUse& b);

// Holds the smallest and largest value of each channel of an image as eval_texture gives it.
struct TexelRange {
  vec4 low{1}, high{1};
};

// Looks at each image at most once, and only at those a decision depends on. Borrows the scene.
class TextureRanges {
 public:
  explicit TextureRanges(const Scene& scene) : scene_(scene) {}
  const TexelRange& image(int index);
  TexelRange of(const TextureRef& reference);  // 1 if there is no picture
 private:
  const Scene& scene_;
  std::map<int, TexelRange> known_;
};

// Finds it. `mesh`: one that is made of the material (its vertex colours multiply the base colour).
MaterialUse find_material_use(const Material& material, const Mesh& mesh, TextureRanges& ranges);

}  // namespace wellspring::light
