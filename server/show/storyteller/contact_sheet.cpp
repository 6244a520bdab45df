// SPDX-License-Identifier: Apache-2.0
#include "show/storyteller/contact_sheet.h"

#include <algorithm>
#include <cmath>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#include <stb_easy_font.h>
#pragma GCC diagnostic pop

namespace wellspring::show {
namespace {

constexpr int gap = 4;

// stb's letters are ASCII; what else there is becomes a question mark.
std::string plain(const std::string& text) {
  std::string result;
  for (char c : text.substr(0, 200)) result += c >= ' ' && c < 127 ? c : '?';
  return result;
}

}  // namespace

int text_width(const std::string& text, int scale) {
  std::string letters = plain(text);
  return stb_easy_font_width(letters.data()) * scale;
}

void draw_text(Frame& frame, const std::string& text, int x, int y, int scale, vec3 color) {
  struct Corner {
    float x, y, z;
    unsigned char color[4];
  };
  std::string letters = plain(text);
  std::vector<Corner> corners(letters.size() * 80 + 4);  // at most 20 strokes a letter
  int count = stb_easy_font_print(0, 0, letters.data(), nullptr, corners.data(),
                                  int(corners.size() * sizeof(Corner)));
  for (int q = 0; q < count; q++) {  // each stroke is an upright rectangle
    const Corner &a = corners[size_t(q) * 4], &b = corners[size_t(q) * 4 + 2];
    int left = std::max(x + int(a.x) * scale, 0),
        right = std::min(x + int(b.x) * scale, frame.width);
    int top = std::max(y + int(a.y) * scale, 0),
        bottom = std::min(y + int(b.y) * scale, frame.height);
    for (int row = top; row < bottom; row++)
      for (int column = left; column < right; column++)
        frame.color[size_t(row) * size_t(frame.width) + size_t(column)] = color;
  }
}

Frame render_sheet(const Character& character, const std::vector<SheetCell>& cells,
                   const PortraitShot& shot, int columns, std::vector<std::string>& warnings) {
  Frame sheet;
  if (cells.empty()) return sheet;
  if (columns <= 0)
    columns =
        int(std::ceil(std::sqrt(double(cells.size()) * shot.height / std::max(shot.width, 1))));
  columns = std::clamp(columns, 1, int(cells.size()));
  int rows = (int(cells.size()) + columns - 1) / columns;
  int scale = std::max(shot.width / 180, 1), strip = 12 * scale;
  sheet.width = columns * (shot.width + gap) + gap;
  sheet.height = rows * (shot.height + strip + gap) + gap;
  sheet.color.assign(size_t(sheet.width) * size_t(sheet.height), vec3(0.02f));
  for (size_t i = 0; i < cells.size(); i++) {
    std::vector<std::string> said;
    Frame picture = render_portrait(character, cells[i].pose, shot, said);
    if (i == 0) warnings.insert(warnings.end(), said.begin(), said.end());
    int left = gap + int(i) % columns * (shot.width + gap);
    int top = gap + int(i) / columns * (shot.height + strip + gap);
    for (int row = 0; row < shot.height; row++)
      std::copy_n(picture.color.begin() + ptrdiff_t(row) * shot.width, shot.width,
                  sheet.color.begin() + ptrdiff_t(top + row) * sheet.width + left);
    int middle = left + (shot.width - text_width(cells[i].label, scale)) / 2;
    draw_text(sheet, cells[i].label, std::max(middle, left), top + shot.height + 3 * scale, scale,
              vec3(0.8f));
  }
  return sheet;
}

}  // namespace wellspring::show
