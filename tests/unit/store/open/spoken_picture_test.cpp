// SPDX-License-Identifier: Apache-2.0
// A picture in another language: it is opened when it is looked at, and no sooner.
#include "store/open/spoken_picture.h"

#include <gtest/gtest.h>

#include "base/load_error.h"
#include "store/open/open_picture.h"
#include "unit/folder.h"

namespace wellspring::test {
namespace {

using store::open_picture;
using store::PieceKey;
using store::SpokenPicture;

const char* const town = R"({"type": "Feature", "bbox": [0, 0, 2, 2],
  "properties": {"name": "Town", "name:de": "Stadt", "name:sk": "Mesto", "wide": true},
  "geometry": {"type": "Point", "coordinates": [1, 1]}})";

TEST(SpokenPicture, HasTheWordsOfItsLanguage) {
  Folder folder;
  const std::string file = folder.write("a.geojson", town);
  const auto english = open_picture(file, "", "en"), german = open_picture(file, "", "de");
  EXPECT_EQ(english->languages(), (std::vector<std::string>{"de", "sk"}));
  const SpokenPicture spoken(*english, file, "", "de");
  EXPECT_EQ(spoken.levels().size(), english->levels().size());
  const uint32_t middle = uint32_t(english->levels()[4].columns() / 2);
  const PieceKey key(1, 4, middle, middle);
  EXPECT_EQ(spoken.fetch(key).piece->bytes, german->fetch(key).piece->bytes);
  EXPECT_NE(spoken.fetch(key).piece->bytes, english->fetch(key).piece->bytes);
}

TEST(SpokenPicture, IsOpenedWhenItIsLookedAt) {
  Folder folder;
  const std::string file = folder.write("a.geojson", town);
  const auto english = open_picture(file, "", "en");
  const SpokenPicture spoken(*english, file, "", "de");
  folder.write("a.geojson", "{");
  EXPECT_THROW(spoken.fetch(PieceKey(1, 0, 0, 0)), LoadError);
  folder.write("a.geojson", R"({"type": "Point", "bbox": [0, 0, 9, 2], "coordinates": [1, 1]})");
  EXPECT_THROW(spoken.fetch(PieceKey(1, 0, 0, 0)), LoadError) << "another size";
  folder.write("a.geojson", town);
  EXPECT_TRUE(spoken.fetch(PieceKey(1, 0, 0, 0)).piece) << "it is tried again";
}

TEST(SpokenPicture, APaintingSaysItsLanguages) {
  Folder folder;
  folder.write("a.geojson", town);
  const auto picture = open_picture(folder.write("a.painting.json", R"({"width": 512,
    "height": 512, "metres": 1, "layers": [{"name": "a", "items": [
      {"text": {"en": "Sea", "fr": "Mer"}, "at": [0.1, 0.5], "size": 0.1, "fill": "#000000"},
      {"geojson": "a.geojson", "style": {"label": {"size_mm": 9}}}]}]})"));
  EXPECT_EQ(picture->languages(), (std::vector<std::string>{"de", "en", "fr", "sk"}));
}

}  // namespace
}  // namespace wellspring::test
