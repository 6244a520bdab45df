// SPDX-License-Identifier: Apache-2.0
// Reads the file of a painting (".painting.json") and checks it; docs of its fields are their
// descriptions in painting_file.cpp and painting_items.cpp.
#pragma once
#include <map>
#include <set>
#include <string>

#include "json/fields.h"
#include "store/painting/painting.h"
#include "store/painting/painting_path.h"

namespace wellspring::store {

// Reads a painting with its labels in `language`, else in English. Throws LoadError, which names
// the file and the place in it, for what is wrong and for what is too much.
Painting read_painting(const std::string& path, const std::string& language);

// Keeps what has been read while a painting is read: names, and how much is left to read.
struct PaintingReading {
  Painting painting;
  std::string language;
  std::string folder;  // has the file
  std::map<std::string, int, std::less<>> gradients, brushes, symbols;
  int items = 0, points = 0, groups = 0, repeats = 0, geo_items = 0;
  int depth = 0;
  std::set<std::string, std::less<>> languages;  // labels are in these
  uint64_t next_seed() { return painting.seed * 1000003 + uint64_t(++seeds_); }

 private:
  int seeds_ = 0;
};

// Reads one item, and what it holds, and finishes it.
PaintItem read_paint_item(json::FieldReader& fields, PaintingReading& reading);
// Reads the list of a group's or a layer's items.
void read_paint_items(json::FieldReader& fields, const char* name, std::vector<PaintItem>& items,
                      PaintingReading& reading);
// Reads an item that shows a GeoJSON FeatureCollection: it is a group.
PaintItem read_features(json::FieldReader& fields, PaintingReading& reading);

// Counts an item and its points; a fault of `fields` says when they are too many. Returns whether
// they are not.
bool count_item(const PaintItem& item, const json::FieldReader& fields, PaintingReading& reading);
// Reads a path by its letters; false: it is absent or wrong.
bool read_path_field(json::FieldReader& fields, const char* name, PaintPath& path,
                     json::Need need = json::Need::optional);
// Reads a colour, "#rrggbb" or "#rrggbbaa", or "@" and the name of a gradient.
void read_ink(json::FieldReader& fields, const char* name, PaintInk& ink,
              const PaintingReading& reading);
bool read_color(json::FieldReader& fields, const char* name, PaintColor& color);
// Reads a name of one of `known`; -1: it is absent or wrong.
int read_known(json::FieldReader& fields, const char* name, const char* about,
               const std::map<std::string, int, std::less<>>& known,
               json::Need need = json::Need::optional);
// Reads a text, or one of several languages.
std::string read_label(json::FieldReader& fields, const char* name, PaintingReading& reading);

}  // namespace wellspring::store
