// SPDX-License-Identifier: Apache-2.0
// Layers of pictures of many bands, as exhibit.json names them.
#include <gtest/gtest.h>

#include "show/exhibit/pieces/exhibit_pieces.h"
#include "show/exhibit/pieces/piece_choices.h"
#include "unit/show/exhibit/room_package.h"
#include "unit/store/band_files/made_bands.h"
#include "wire/messages.h"

namespace wellspring::test {
namespace {

// An exhibit with a picture of grey bands that are brighter the longer the wavelength.
struct BandPiece {
  Folder folder;
  Exhibit exhibit;
  std::vector<Problem> problems;

  // `harm` is done to the picture before it is read.
  explicit BandPiece(
      const std::string& layers,
      const std::function<void(const std::string& file)>& harm = [](const std::string&) {}) {
    MadeBands made;
    made.bands = 6, made.description = wavelengths_json(6, 400, 100);
    made.value = [](int, int, int band) { return 10000 * (band + 1); };
    harm(write_bands_tiff(folder.file("a.tif"), made));
    exhibit.folder = folder.path;
    exhibit.scene.objects.push_back("");
    const std::string text =
        R"({"pieces": [{"id": "a", "kind": "picture", "source": "a.tif", "width_m": 1,
            "place": {"position": [0, 1.5, 0]}, "label": {"en": "A"}, "layers": [)" +
        layers + "]}]}";
    read_fields(json::parse(text), "exhibit.json", problems,
                [&](FieldReader& root) { read_pieces(exhibit, root, problems); });
  }
  std::string all() const {
    std::string lines;
    for (const Problem& problem : problems) lines += to_string(problem) + "\n";
    return lines;
  }
  // Returns the first texel of a layer.
  glm::ivec3 shown(size_t layer) const {
    const Piece& small = exhibit.pieces.at(0).layers.at(layer).shown.picture->coarsest;
    return {small.bytes[0], small.bytes[1], small.bytes[2]};
  }
};

std::string layer(const std::string& id, const std::string& fields) {
  return R"({"id": ")" + id + R"(", "label": {"en": "L"}, )" + fields + "}";
}

TEST(ExhibitBands, LampsBandsAndFalseColorsAreLayers) {
  const BandPiece piece(layer("candle", R"("lamp": "candle")") + "," +
                        layer("used", R"("lamp": "candle", "adapted": true)") + "," +
                        layer("red", R"("band_nm": 600)") + "," +
                        layer("false", R"("false_color_nm": [900, 600, 500])"));
  ASSERT_TRUE(piece.problems.empty()) << piece.all();
  ASSERT_EQ(piece.exhibit.pieces.at(0).layers.size(), 5u);
  const glm::ivec3 day = piece.shown(0), candle = piece.shown(1), used = piece.shown(2);
  EXPECT_GT(candle.x - candle.z, day.x - day.z + 60);
  EXPECT_LT(std::abs(used.x - used.z - (day.x - day.z)), 40);
  const auto code = [](double share) {
    return int(255 * (1.055 * std::pow(share, 1 / 2.4) - 0.055) + 0.5);
  };
  EXPECT_EQ(piece.shown(3), glm::ivec3(code(30000 / 65535.0)));
  EXPECT_EQ(piece.shown(4),
            glm::ivec3(code(60000 / 65535.0), code(30000 / 65535.0), code(20000 / 65535.0)));
  // A glass shows them as any other layer.
  PieceChoices choices;
  LensOrder order;
  order.name = "a", order.layer = "false";
  EXPECT_EQ(look_through(piece.exhibit, order, choices), "");
  EXPECT_EQ(choices.at(0).layer, 4);
}

TEST(ExhibitBands, WhatIsWrongIsNamed) {
  const std::pair<std::string, const char*> wrong[] = {
      {R"("lamp": "candel")", "there is no lamp 'candel'"},
      {R"("band_nm": 1000)", "has no band at 1000 nm: it has 400 to 900 nm"},
      {R"("band_nm": "red")", "/pieces/0/layers/0/band_nm"},
      {R"("false_color_nm": [900, 600])", "/pieces/0/layers/0/false_color_nm"},
      {R"("lamp": "A", "band_nm": 600)", "has more than one of \"lamp\""},
      {R"("adapted": true)", "/pieces/0/layers/0/adapted: needs a \"lamp\""}};
  for (const auto& [fields, what] : wrong) {
    const BandPiece piece(layer("x", fields));
    EXPECT_NE(piece.all().find(what), std::string::npos) << fields << ": " << piece.all();
  }
}

TEST(ExhibitBands, AFaultOfThePictureIsToldOnceForAllLayers) {
  const std::string layers = layer("candle", R"("lamp": "candle")") + "," +
                             layer("red", R"("band_nm": 600)") + "," +
                             layer("false", R"("false_color_nm": [900, 600, 500])");
  const BandPiece cut(layers, [](const auto& file) { std::filesystem::resize_file(file, 100); });
  EXPECT_EQ(cut.problems.size(), 1u) << cut.all();
  EXPECT_NE(cut.all().find("a.tif: "), std::string::npos) << cut.all();
  const BandPiece gone(layers, [](const auto& file) { std::filesystem::remove(file); });
  EXPECT_EQ(gone.problems.size(), 1u) << gone.all();
  EXPECT_NE(gone.all().find("/pieces/0/source: there is no file"), std::string::npos) << gone.all();
}

}  // namespace
}  // namespace wellspring::test
