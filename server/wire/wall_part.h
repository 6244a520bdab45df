// SPDX-License-Identifier: Apache-2.0
// Says which part of a wall of screens a page is, as its hello has it.
#pragma once
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include "base/vec.h"
#include "json/text.h"
#include "wire/limits.h"

namespace wellspring::json {
struct FieldDescriber;
}

namespace wellspring::wire {

// List the fields of a part that a message may have, an object of its own: to read it, and to write
// or describe it.
template <class Part, class Fields>
void list_part(const char* name, std::optional<Part>& part, Fields& fields) {
  fields.part(name, "", [&](Fields& own) { Part::list(part.emplace(), own); });
}
template <class Part, class Fields>
void list_part(const char* name, const std::optional<Part>& part, Fields& fields) {
  if (!part && !std::is_same_v<Fields, json::FieldDescriber>) return;
  Fields own;
  const Part usual;
  Part::list(part ? *part : usual, own);
  fields.out[name] = std::move(own.out);
}

// Says which part of a wall of screens a page shows, all of which show one wide picture in step
// (show/wall/wall.h). A page without a part of its own leads the wall: its visit is what is seen.
struct WallPart {
  std::string name;                // name of the wall, which its pages have in common
  int columns = 1, rows = 1;       // screens beside and above one another
  std::optional<int> column, row;  // place of the page's screen, from the upper left
  vec2 bezel{0};  // width and height of what is between two pictures, over those of a picture
  float fov = 0;  // radians, 0: it follows from the viewpoint
  std::string viewpoint;
  static void list(auto& part, auto& fields) {
    fields.text("name", part.name, "name of the wall, which its pages have in common",
                Need::required);
    fields.integer("columns", 1, max_wall_side, part.columns, "1..8 screens beside one another");
    fields.integer("rows", 1, max_wall_side, part.rows, "1..8 screens above one another");
    fields.integer(
        "column", 0, max_wall_side - 1, part.column,
        "of this screen, 0: at the left; without column and row the page leads the wall, "
        "which shows what its visitor sees");
    fields.integer("row", 0, max_wall_side - 1, part.row, "of this screen, 0: at the top");
    fields.vector("bezel", 1, part.bezel,
                  "[x, y]: width and height of what is between two neighbouring pictures, over "
                  "those of a picture, 0..1");
    fields.number("fov", 0, 2.8, part.fov,
                  "radians from the wall's left to its right; 0 or left out: as high as the "
                  "viewpoint, and 100 degrees wide at most");
    fields.text("viewpoint", part.viewpoint, "name of that where it begins; optional");
  }
  bool operator==(const WallPart&) const = default;
};

}  // namespace wellspring::wire
