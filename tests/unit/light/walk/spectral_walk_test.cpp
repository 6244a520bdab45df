// SPDX-License-Identifier: Apache-2.0
// Light by wavelength: what walks bring from lamps and surfaces that are known so is what sums over
// single nanometres give, whatever the lamp.
#include "world/load/scene_spectra.h"

#include "light/technique/technique.h"
#include "scenes/lit_world.h"
#include "spectrum/color.h"
#include "spectrum/lamps.h"
#include "spectrum/observer.h"
#include "unit/light/statistics.h"

namespace wellspring::test {
namespace {

using namespace scenes;

// An edge of a pigment: what is longer than `nm` is reflected, or what is shorter.
Spectrum edge_at(double nm, double low, double high, double width = 12) {
  Spectrum s;
  for (size_t i = 0; i < spectrum_size; i++)
    s[i] = low + (high - low) / (1 + std::exp(-(nm_of(i) - nm) / width));
  return s;
}
Spectrum lump_at(double nm, double low, double high, double width) {
  Spectrum s;
  for (size_t i = 0; i < spectrum_size; i++) {
    const double t = (nm_of(i) - nm) / width;
    s[i] = low + (high - low) * std::exp(-t * t / 2);
  }
  return s;
}
const Spectrum vermilion = edge_at(600, 0.04, 0.85), azurite = lump_at(460, 0.05, 0.5, 35),
               ochre = edge_at(540, 0.1, 0.5, 30), red_line_only = lump_at(650, 0, 0.9, 3);

dvec3 color_of(const Spectrum& light) { return rgb_of(xyz_of(light)); }

// The radiance of a scene along a ray: means of replicates, channel by channel.
struct ColorMean {
  Mean channel[3];
  dvec3 mean() const { return {channel[0].mean(), channel[1].mean(), channel[2].mean()}; }
};
ColorMean trace_color(const World& world, const Lights& lights, Ray ray, int depth,
                      int replicates = 16, uint32_t count = 256) {
  ColorMean mean;
  const Technique& technique = *find_technique("path");
  TransportSettings settings;
  settings.max_depth = depth;
  settings.clamp = 0;
  std::vector<Request> requests(count);
  std::vector<Sample> samples(count);
  for (int r = 0; r < replicates; r++) {
    for (uint32_t i = 0; i < count; i++)
      requests[i] = {.ray = ray, .seed = mix64(uint64_t(r) + 17), .index = i};
    trace(technique, world, lights, settings, requests, samples);
    vec3 sum(0);
    for (const Sample& sample : samples) {
      EXPECT_TRUE(is_finite(sample.radiance()));
      sum += sample.radiance() / float(count);
    }
    for (int c = 0; c < 3; c++) mean.channel[c].add(double(sum[c]));
  }
  return mean;
}

// Two colours beside a white, whose luminance is 1.
double difference(const dvec3& rgb, const dvec3& other, const dvec3& white) {
  return ciede2000(lab_of(xyz_of_rgb(rgb), white), lab_of(xyz_of_rgb(other), white));
}

// A closed box whose walls glow with a lamp's light and reflect by a pigment: the sum of all
// reflections is the lamp's light over 1 - reflectance, wavelength by wavelength.
struct SpectralFurnace {
  LitWorld lit;
  static Scene make(const Spectrum& lamp, const Spectrum& pigment) {
    Scene scene = make_furnace(1);
    scene.lamps.push_back({"walls", {}, {scene.meshes[0].material}});
    Material& wall = scene.materials[size_t(scene.meshes[0].material)];
    const int reflectance = add_spectrum(scene, "pigment", pigment);
    set_reflectance(scene, wall, reflectance);
    set_lamp_spectrum(scene, scene.lamps[0], add_spectrum(scene, "lamp", lamp));
    return scene;
  }
  SpectralFurnace(const Spectrum& lamp, const Spectrum& pigment) : lit(make(lamp, pigment)) {}
};
// The colour after `edges` edges of the walk, in units in which the lamp's luminance is 1.
dvec3 furnace_color(const Spectrum& lamp, const Spectrum& pigment, int edges) {
  const double scale = 1 / xyz_of(lamp).y;
  Spectrum light;
  for (size_t i = 0; i < spectrum_size; i++) {
    double sum = 0, power = lamp[i] * scale;
    for (int k = 0; k < edges; k++) sum += power, power *= pigment[i];
    light[i] = sum;
  }
  return color_of(light);
}

TEST(SpectralWalk, ManyReflectionsAreThoseOfEveryNanometre) {
  for (const char* name : {"A", "candle", "LED-B3", "FL11", "HP1", "589.0*2+589.6"})
    for (const Spectrum* pigment : {&vermilion, &azurite, &ochre}) {
      const Spectrum lamp = spectrum::find_lamp(name)->power;
      SpectralFurnace furnace(lamp, *pigment);
      ASSERT_TRUE(furnace.lit.lights.tables->plan.uses(TransportPart::spectra));
      for (int depth : {2, 6}) {
        Ray ray = ray_towards({0, 0, 0}, {1, 0.3f, 0.2f});
        const ColorMean mean = trace_color(furnace.lit.world, furnace.lit.lights, ray, depth);
        const dvec3 expected = furnace_color(lamp, *pigment, depth);
        const double bright = furnace_color(lamp, even_spectrum(1), depth).y;
        for (int c = 0; c < 3; c++) {
          const double found = mean.channel[c].mean(), noise = mean.channel[c].error();
          // Hues beyond a display's have a channel near zero or below, which is shown as none.
          if (expected[c] > 0.03 * bright)
            EXPECT_NEAR(found, expected[c], significance_z * noise + 2e-3 * bright)
                << name << ", channel " << c << ", depth " << depth;
          else EXPECT_LT(found, 0.04 * bright) << name << ", channel " << c << ", depth " << depth;
        }
      }
      EXPECT_EQ(furnace.lit.lights.bad_samples->load(), 0u);
    }
}

// Light that is reflected once is known without noise: its colour is within a rounding of the sum
// over all nanometres.
TEST(SpectralWalk, OneReflectionHasNoColourNoise) {
  for (const char* name : {"A", "candle", "FL11", "589.0*2+589.6"}) {
    const Spectrum lamp = spectrum::find_lamp(name)->power;
    Scene scene = make_plane_with_punctual({.position = {0, 2, 0}, .intensity = vec3(30)});
    Material& floor = scene.materials[size_t(scene.meshes[0].material)];
    floor.base_color = vec4(1);
    set_reflectance(scene, floor, add_spectrum(scene, "pigment", azurite));
    scene.lamps.push_back({"lamp", {0}, {}});
    set_lamp_spectrum(scene, scene.lamps[0], add_spectrum(scene, "power", lamp));
    LitWorld lit(std::move(scene));
    const ColorMean mean =
        trace_color(lit.world, lit.lights, ray_towards({0, 1, 2}, {0, 0, 0}), 2, 2, 4);
    const double irradiance = 30 / 4.0 / double(pi);
    dvec3 expected = color_of(product(lamp, azurite)) / xyz_of(lamp).y * irradiance;
    for (int c = 0; c < 3; c++)
      EXPECT_NEAR(mean.channel[c].mean(), expected[c], 2e-3 * irradiance) << name << c;
  }
}

// A lamp of which only a colour is known, and a grey surface by wavelength, are what they are in
// three colours.
TEST(SpectralWalk, GreyByWavelengthIsGrey) {
  Scene plain = make_furnace(0.5f), spectral = make_furnace(1);
  Material& wall = spectral.materials[size_t(spectral.meshes[0].material)];
  set_reflectance(spectral, wall, add_spectrum(spectral, "grey", even_spectrum(0.5)));
  const Ray ray = ray_towards({0, 0, 0}, {1, 0.3f, 0.2f});
  LitWorld a(std::move(plain)), b(std::move(spectral));
  const ColorMean colors = trace_color(a.world, a.lights, ray, 5),
                  lengths = trace_color(b.world, b.lights, ray, 5);
  for (int c = 0; c < 3; c++) {
    EXPECT_NEAR(lengths.channel[c].mean(), 1.9375,
                2e-3 + significance_z * lengths.channel[c].error());
    EXPECT_LT(lengths.channel[c].error(), 0.01);
    expect_same_mean(colors.channel[c], lengths.channel[c], "grey");
  }
}

TEST(SpectralWalk, NoLightInAnyWavelengthIsDarkAndFinite) {
  SpectralFurnace furnace(spectrum::find_lamp("589.0*2+589.6")->power, red_line_only);
  const ColorMean mean =
      trace_color(furnace.lit.world, furnace.lit.lights, ray_towards({0, 0, 0}, {1, 0, 0}), 6);
  const dvec3 lamp = color_of(spectrum::find_lamp("589.0*2+589.6")->power) /
                     xyz_of(spectrum::find_lamp("589.0*2+589.6")->power).y;
  for (int c = 0; c < 3; c++)  // the lamp itself is seen, its hues cut to a display's
    EXPECT_NEAR(mean.channel[c].mean(), std::max(lamp[c], 1e-3 * lamp.x), 1e-2);
  EXPECT_EQ(furnace.lit.lights.bad_samples->load(), 0u);
}

// A slab that bends no light takes it up by Beer's law, each nanometre by its own absorption.
TEST(SpectralWalk, ASolidAbsorbsByWavelength) {
  const Spectrum absorption = lump_at(570, 2, 90, 40);
  Scene scene = empty_scene();
  Material solid = glass(1.0f, 0, 1);
  set_absorption(scene, solid, add_spectrum(scene, "alexandrite", absorption));
  EXPECT_LT(solid.attenuation_color.y, solid.attenuation_color.z);
  const int material = add_material(scene, solid);
  add_box(scene, material, {2, 2, 0.02f}, "slab", at({0, 0, 0}));
  scene.environment.radiance = vec3(1);
  LitWorld lit(std::move(scene));
  const ColorMean mean =
      trace_color(lit.world, lit.lights, ray_towards({0, 0, 2}, {0, 0, 0}), 6, 32);
  Spectrum left;
  const Spectrum white = spectrum::find_lamp("D65")->power;
  for (size_t i = 0; i < spectrum_size; i++) left[i] = white[i] * std::exp(-absorption[i] * 0.02);
  const dvec3 expected = color_of(left) / xyz_of(white).y;
  for (int c = 0; c < 3; c++) {
    EXPECT_NEAR(mean.channel[c].mean(), expected[c],
                significance_z * mean.channel[c].error() + 2e-3);
    EXPECT_LT(mean.channel[c].error(), 0.01);
  }
}

// Glass of a measured index loses no light, neither alone nor in water, smooth or rough.
TEST(SpectralWalk, MeasuredGlassKeepsAFurnaceWhite) {
  Dispersion heavy;
  heavy.name = "SF66";
  heavy.formula = 2;
  heavy.coefficients = {0,          2.0245976, 0.0147053225, 0.470187196, 0.0692998276,
                        2.59970433, 161.817601};
  heavy.low_nm = 390, heavy.high_nm = 2500;
  for (float roughness : {0.0f, 0.3f}) {
    Scene scene = make_white_furnace(glass(1.5f, roughness, 1));
    Material& material = scene.materials[size_t(scene.meshes[0].material)];
    ASSERT_TRUE(set_glass(scene, material, heavy));
    EXPECT_NEAR(material.ior, 1.9229, 1e-3f);
    EXPECT_NEAR(20 / material.dispersion, 20.9, 0.2f);
    LitWorld lit(std::move(scene));
    for (float height : {0.2f, 0.8f}) {
      const ColorMean mean =
          trace_color(lit.world, lit.lights, ray_towards({0, height, 3}, {0, height, 0}), 100, 24);
      const dvec3 xyz = xyz_of_rgb(mean.mean()), white = xyz_of_rgb(dvec3(1));
      for (int c = 0; c < 3; c++)
        EXPECT_NEAR(xyz[c] / white[c], 1,
                    (roughness > 0 ? 0.01 : 0.001) + significance_z * mean.channel[c].error())
            << roughness << " at " << height;
    }
  }
}

// A lamp whose light is known by wavelength is seen through glass that spreads its colours, in its
// own colour: a ball of flint in a closed box of that light changes nothing.
TEST(SpectralWalk, FlintInALampsLightKeepsItsColour) {
  for (const char* name : {"A", "LED-B3"}) {
    Scene scene = make_furnace(0);
    scene.lamps.push_back({"walls", {}, {scene.meshes[0].material}});
    const Spectrum lamp = spectrum::find_lamp(name)->power;
    set_lamp_spectrum(scene, scene.lamps[0], add_spectrum(scene, name, lamp));
    Material flint = glass(1.6f, 0, 1);
    flint.dispersion = 2;
    add_sphere(scene, flint, 0.5f, "ball");
    LitWorld lit(std::move(scene));
    const ColorMean mean = trace_color(lit.world, lit.lights,
                                       ray_towards({0, 0.2f, 0.9f}, {0, 0.2f, 0}), 100, 32, 512);
    const dvec3 expected = color_of(lamp) / xyz_of(lamp).y;
    for (int c = 0; c < 3; c++)
      EXPECT_NEAR(mean.channel[c].mean(), expected[c],
                  significance_z * mean.channel[c].error() + 5e-3)
          << name << ", channel " << c;
  }
}

// A scene that has no use for wavelengths carries none.
TEST(SpectralWalk, ALampAloneNeedsNoWavelengths) {
  Scene scene = make_plane_with_rect_light(3);
  scene.lamps.push_back({"lamp", {}, {scene.meshes[1].material}});
  set_lamp_spectrum(scene, scene.lamps[0],
                    add_spectrum(scene, "candle", spectrum::find_lamp("candle")->power));
  EXPECT_GT(scene.materials[size_t(scene.meshes[1].material)].emission.x,
            3 * scene.materials[size_t(scene.meshes[1].material)].emission.z);
  LitWorld lit(std::move(scene));
  EXPECT_FALSE(lit.lights.tables->plan.uses(TransportPart::spectra));
  EXPECT_FALSE(lit.lights.tables->spectral);
}

}  // namespace
}  // namespace wellspring::test
