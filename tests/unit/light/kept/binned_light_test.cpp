// SPDX-License-Identifier: Apache-2.0
// Light of lamps with a dial, kept in bins: turned to any of its lights a map has what sums over
// single nanometres give, and light of other lamps stays as it is.
#include "light/kept/binned_light.h"

#include <gtest/gtest.h>

#include "light/kept/lamps.h"
#include "light/kept/map_file.h"
#include "spectrum/color.h"
#include "spectrum/lamps.h"
#include "spectrum/observer.h"
#include "unit/folder.h"
#include "unit/light/kept/bake_cases.h"
#include "world/load/scene_spectra.h"

namespace wellspring::test {
namespace {

using namespace scenes;

// The reflectance of a pigment that reflects what is longer than `nm`.
Spectrum edge_at(double nm, double low, double high) {
  Spectrum s;
  for (size_t i = 0; i < spectrum_size; i++)
    s[i] = low + (high - low) / (1 + std::exp(-(nm_of(i) - nm) / 15));
  return s;
}

constexpr const char* own_light = "LED-B3";
constexpr const char* dial_lights[] = {"candle", "north-light", "FL11", "HP1"};

void give_dial(Scene& scene, Lamp& lamp) {
  const int own = add_spectrum(scene, own_light, spectrum::find_lamp(own_light)->power);
  set_lamp_spectrum(scene, lamp, own);
  const vec3 color = lamp_color(scene.spectra[size_t(own)].value);
  for (const char* name : dial_lights) {
    const int power = add_spectrum(scene, name, spectrum::find_lamp(name)->power);
    lamp.dial.push_back({power, lamp_color(scene.spectra[size_t(power)].value) / color});
  }
}

// A closed box whose walls glow with a lamp's light and reflect by a pigment: at each wavelength
// its power over 1 - reflectance arrives everywhere.
Scene make_glowing_box(const Spectrum& pigment) {
  Scene scene = make_furnace(1);
  scene.lamps.push_back({"walls", {}, {scene.meshes[0].material}});
  Material& wall = scene.materials[size_t(scene.meshes[0].material)];
  set_reflectance(scene, wall, add_spectrum(scene, "pigment", pigment));
  give_dial(scene, scene.lamps[0]);
  return scene;
}

// The colour that the walls reflect, as far as a map can hold it: with no channel below zero.
dvec3 furnace_color(const Spectrum& lamp, const Spectrum& pigment) {
  Spectrum sent_on;
  for (size_t i = 0; i < spectrum_size; i++) sent_on[i] = pigment[i] / (1 - pigment[i]);
  const dvec3 color = rgb_of(spectrum::LampObserver(lamp).xyz(sent_on));
  return xyz_of_rgb(glm::max(color, dvec3(0)));
}

vec3 mean_of(const IlluminationMap& map) {
  dvec3 sum(0);
  for (uint32_t light : map.nodes.light) sum += dvec3(unpack_rgb9e5(light));
  return vec3(sum / double(map.nodes.light.size()));
}

double difference(const dvec3& xyz, const dvec3& truth, const dvec3& white) {
  // Both as bright, so that white is no limit.
  const double scale = 0.5 / truth.y;
  return ciede2000(lab_of(xyz * scale, white), lab_of(truth * scale, white));
}

TEST(BinnedLight, ADialShowsManyReflectionsAsEveryNanometreDoes) {
  for (const double nm : {480.0, 590.0}) {
    const Spectrum pigment = edge_at(nm, 0.05, 0.5);
    Baked box(make_glowing_box(pigment), {.gather_nodes = 60, .direct_nodes = 60});
    const auto all = box.map(24);
    ASSERT_TRUE(all);
    ASSERT_EQ(all->layers->size(), 1 + bin_layers);
    const Material& wall = box.scene.materials[size_t(box.scene.meshes[0].material)];
    for (size_t k = 0; k <= std::size(dial_lights); k++) {
      const char* name = k == 0 ? own_light : dial_lights[k - 1];
      const LampLevel level(lamp_full, uint8_t(k));
      const auto map = relit(*all, find_layer_colors(box.scene, std::span(&level, 1)));
      const Spectrum& power = spectrum::find_lamp(name)->power;
      const dvec3 found = xyz_of_rgb(dvec3(mean_of(*map) * vec3(wall.base_color)));
      const dvec3 white = spectrum::LampObserver(power).white();
      EXPECT_LT(difference(found, furnace_color(power, pigment), white), 1.0)
          << name << ", edge at " << nm;
    }
    // The map itself is under the lamp's own light.
    const LampLevel own(lamp_full);
    const auto map = relit(*all, find_layer_colors(box.scene, std::span(&own, 1)));
    EXPECT_EQ(map->nodes.light, all->nodes.light);
  }
}

// Between walls of which only colours are known, and under a lamp of D65, bins have what colours
// have.
TEST(BinnedLight, ColoursUnderDaylightStayAsTheyAre) {
  for (const vec3 color : {vec3(0.5f), vec3(0.5f, 0.25f, 0.15f), vec3(0.1f, 0.2f, 0.4f)}) {
    Scene scene = make_furnace(1);
    Material& wall = scene.materials[size_t(scene.meshes[0].material)];
    wall.base_color = vec4(color, 1);
    scene.lamps.push_back({"walls", {}, {scene.meshes[0].material}});
    const int power = add_spectrum(scene, "D65", spectrum::find_lamp("D65")->power);
    set_lamp_spectrum(scene, scene.lamps[0], power);
    scene.lamps[0].dial.push_back({power, vec3(1)});
    const vec3 glow = wall.emission;
    Baked box(std::move(scene), {.gather_nodes = 60, .direct_nodes = 60});
    const vec3 found = mean_of(*box.map(24)), expected = glow / (1.0f - color);
    // Walks end after 12 edges, and the square of a colour is not the colour of a squared spectrum.
    for (int c = 0; c < 3; c++)
      EXPECT_NEAR(found[c], expected[c], 0.07f * expected[c]) << color.x << ", channel " << c;
  }
}

// A lamp without a dial has one layer of colours, whatever the other lamps have.
TEST(BinnedLight, OtherLampsKeepTheirColours) {
  auto make = [](bool dial) {
    Scene scene = make_plane_with_punctual({.position = {0, 2, 0}, .intensity = vec3(30)});
    scene.lights.push_back(point_light({0.5f, 1, 0}, {10, 5, 2}));
    scene.lamps.push_back({"white", {0}, {}});
    scene.lamps.push_back({"warm", {1}, {}});
    if (dial) give_dial(scene, scene.lamps[0]);
    return scene;
  };
  Baked plain(make(false)), with(make(true));
  const std::vector<MapLayer> layers = find_layers(with.scene);
  ASSERT_EQ(layers.size(), 2 + bin_layers);
  EXPECT_EQ(layers.back().lamp, 1);
  EXPECT_EQ(layers.back().bin, -1);
  const auto a = plain.map(4), b = with.map(4);
  const LampLevels only_warm{0, lamp_full};
  const vec3 mean = mean_of(*relit(*a, find_layer_colors(plain.scene, only_warm))),
             same = mean_of(*relit(*b, find_layer_colors(with.scene, only_warm)));
  for (int c = 0; c < 3; c++) EXPECT_NEAR(same[c], mean[c], 0.02f * mean[c]);
}

// A file of before has the lamp's light in colours: the map that is loaded says that it lacks it.
TEST(BinnedLight, AMapWithoutBinsLacksTheLampsLight) {
  const Folder folder;
  const std::string file = folder.file("light.maps");
  Scene scene = make_plane_with_punctual({.position = {0, 2, 0}, .intensity = vec3(30)});
  scene.lamps.push_back({"lamp", {0}, {}});
  Baked plain(scene);
  ASSERT_TRUE(save_map(plain.world, *plain.map(2), file, hash_scene(plain.scene)));
  give_dial(scene, scene.lamps[0]);
  const World world(scene);
  const LoadedMap loaded = load_map(world, file, hash_scene(scene));
  EXPECT_EQ(loaded.found, KeyedFile::another_key);
  ASSERT_TRUE(loaded.map);
  EXPECT_EQ(loaded.dark_lamps, std::vector<int>{0});
  EXPECT_EQ(loaded.map->layers->size(), 1 + bin_layers);
  EXPECT_EQ(mean_of(*loaded.map), vec3(0));
  // Its own map comes back with its bins.
  Baked binned(scene);
  const auto map = binned.map(2);
  ASSERT_TRUE(save_map(binned.world, *map, file, hash_scene(scene)));
  const LoadedMap again = load_map(world, file, hash_scene(scene));
  EXPECT_EQ(again.found, KeyedFile::read);
  EXPECT_TRUE(again.dark_lamps.empty());
  for (int c = 0; c < 3; c++)
    EXPECT_NEAR(mean_of(*again.map)[c], mean_of(*map)[c], 0.02f * mean_of(*map)[c]);
}

}  // namespace
}  // namespace wellspring::test
