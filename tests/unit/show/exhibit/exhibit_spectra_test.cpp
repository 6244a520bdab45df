// SPDX-License-Identifier: Apache-2.0
// `spectra` of exhibit.json and the lights of its lamps: what they become, and every mistake with
// its place.
#include "show/exhibit/exhibit_spectra.h"

#include <gtest/gtest.h>

#include <utility>

#include "unit/show/exhibit/room_package.h"

namespace wellspring::test {
namespace {

// Materials "wall" (0), "table" (1) and "gem", a solid of glass.
Asset room_of_materials() {
  Asset asset = test::room_asset();
  json& materials = asset.root["materials"];
  materials[0]["name"] = "wall", materials[1]["name"] = "table";
  materials.push_back({{"name", "gem"},
                       {"pbrMetallicRoughness", {{"metallicFactor", 0}}},
                       {"extensions",
                        {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                         {"KHR_materials_volume", {{"thicknessFactor", 0.01}}}}}});
  return asset;
}

struct SpectraPackage : RoomPackage {
  explicit SpectraPackage(const std::string& spectra, const std::string& lamps = "[]")
      : RoomPackage(room_of_materials()) {
    manifest["spectra"] = json::parse(spectra);
    manifest["lamps"] = json::parse(lamps);
    write("pigments.csv",
          "nm,azurite,vermilion\n400,0.3,0.05\n500,0.4,0.05\n600,0.1,0.5\n700,0.1,0.8\n");
    write("gems.csv", "nm,ruby\n400,300\n550,300\n600,10\n700,5\n");
    write("glass.yml",
          "DATA:\n  - type: formula 2\n    wavelength_range: 0.3 2.5\n"
          "    coefficients: 0 1.03961212 0.00600069867 0.231792344 0.0200179144 1.01046945 "
          "103.560653\n");
  }
};

TEST(ExhibitSpectra, MaterialsAndLampsAreKnownByWavelength) {
  SpectraPackage package(
      R"({"wall": {"reflectance": "pigments.csv#azurite"},
                             "table": {"reflectance": "rgb"},
                             "gem": {"glass": "glass.yml", "absorption": "gems.csv"}})",
      R"([{"id": "room", "title": "Room", "nodes": ["Lamp"], "spectrum": "LED-B3",
                              "dial": [{"spectrum": "LED-B3", "title": "Now"},
                                       {"spectrum": "candle", "title": "Candle"}]}])");
  const Exhibit exhibit = package.read();
  EXPECT_EQ(package.told(), "");
  const Scene& scene = exhibit.scene;
  auto material = [&](const std::string& name) -> const Material& {
    for (const Material& m : scene.materials)
      if (m.name == name) return m;
    throw std::out_of_range(name);
  };
  const Material &wall = material("wall"), &table = material("table"), &gem = material("gem");
  ASSERT_GE(wall.spectra.reflectance, 0);
  EXPECT_EQ(scene.spectra[size_t(wall.spectra.reflectance)].name, "pigments.csv#azurite");
  EXPECT_GT(wall.base_color.z, 2 * wall.base_color.x);
  ASSERT_GE(table.spectra.reflectance, 0);
  EXPECT_NEAR(table.base_color.x, 0.6f, 0.01f);
  ASSERT_GE(gem.spectra.index, 0);
  EXPECT_NEAR(gem.ior, 1.5168f, 1e-4f);
  EXPECT_NEAR(20 / gem.dispersion, 64.17f, 0.1f);
  ASSERT_GE(gem.spectra.absorption, 0);
  EXPECT_GT(gem.attenuation_color.x, 2 * gem.attenuation_color.y);
  ASSERT_EQ(scene.lamps.size(), 1u);
  const PunctualLight& light = scene.lights[size_t(scene.lamps[0].lights[0])];
  EXPECT_EQ(scene.spectra[size_t(light.spectrum)].name, "LED-B3");
  EXPECT_NEAR(luminance(light.intensity), 8, 0.1f);
  ASSERT_EQ(scene.lamps[0].dial.size(), 2u);
  EXPECT_EQ(scene.lamps[0].dial[0].factor, vec3(1));
  const vec3 candle = scene.lamps[0].dial[1].factor * light.intensity;
  EXPECT_NEAR(luminance(candle), 8, 0.1f);
  EXPECT_GT(candle.x / candle.z, 3 * light.intensity.x / light.intensity.z);
}

TEST(ExhibitSpectra, EveryProblemIsToldWithItsPlace) {
  SpectraPackage package(R"({"moon": {"reflectance": "rgb"},
                             "wall": {"reflectance": "pigments.csv#gold", "glass": "glass.yml"},
                             "table": {"reflectance": "none.csv#a", "absorption": "pigments.csv"},
                             "gem": {"glass": "pigments.csv", "colour": 1}})",
                         R"([{"id": "a", "title": "A", "nodes": ["Lamp"], "spectrum": "moonlight"},
                             {"id": "b", "title": "B", "nodes": ["Lamp"],
                              "dial": [{"spectrum": "candle", "title": "C"}]}])");
  package.read();
  const std::pair<const char*, const char*> expected[] = {
      {"/spectra/moon", "no material of this name"},
      {"/spectra/wall/reflectance", "only azurite, vermilion"},
      {"/spectra/wall/glass", "is no solid"},
      {"/spectra/table/reflectance", "none.csv"},
      {"/spectra/table/absorption", "names none of the file's spectra"},
      {"/spectra/gem/glass", "no DATA"},
      {"/spectra/gem/colour", "ignored"},
      {"/lamps/0/spectrum", "is no lamp that is known by name"},
      {"/lamps/1/dial", "needs \"spectrum\""}};
  for (const auto& [where, what] : expected)
    EXPECT_EQ(package.says(where, what), 1) << where << ": " << what << "\n" << package.told();
}

}  // namespace
}  // namespace wellspring::test
