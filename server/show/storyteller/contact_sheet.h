// SPDX-License-Identifier: Apache-2.0
// A contact sheet: one figure in many poses, each picture with its name below.
#pragma once
#include <string>
#include <vector>

#include "show/storyteller/portrait.h"

namespace wellspring::show {

struct SheetCell {
  std::string label;
  Pose pose;
};

// `shot` is that of one cell; columns <= 0: as many as make the sheet about as wide as high. All
// cores; seconds a cell. Empty where there is no cell.
Frame render_sheet(const Character& character, const std::vector<SheetCell>& cells,
                   const PortraitShot& shot, int columns, std::vector<std::string>& warnings);

// Writes `text` into a picture with its upper left corner at x, y, in letters 7 * scale pixels
// high; what lies outside is cut off.
void draw_text(Frame& frame, const std::string& text, int x, int y, int scale, vec3 color);
int text_width(const std::string& text, int scale);

}  // namespace wellspring::show
