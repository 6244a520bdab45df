// SPDX-License-Identifier: Apache-2.0
#include "main_import_preview.h"

#include <algorithm>
#include <fmt/format.h>
#include <iostream>

#include "base/clock.h"
#include "base/write_file.h"
#include "frame/frame.h"
#include "frame/tonemap.h"
#include "image/image.h"
#include "volume/draw/preview.h"

namespace wellspring::program {
namespace {

constexpr int side = 480;                    // pixels of one picture
constexpr vec3 wall(0.03f, 0.028f, 0.026f);  // linear, beside and behind the volume

// Puts a picture beside those that are there.
void put(const volume::VolumePicture& picture, int column, Frame& sheet) {
  for (int y = 0; y < side; y++)
    for (int x = 0; x < side; x++) {
      const size_t from = size_t(y) * side + size_t(x);
      const size_t to = size_t(y) * size_t(sheet.width) + size_t(column * side + x);
      sheet.color[to] = picture.color[from] + picture.clear[from] * wall;
    }
}

// Draws until all bricks that the picture looks for are there, as far as there is room.
volume::VolumePicture draw_finest(const volume::ShownVolume& shown,
                                  const volume::DrawnPreset& preset) {
  while (true) {
    const uint64_t before = shown.arrivals();
    volume::VolumePicture picture = draw_volume(shown, preset, {.side = side, .cuts = {}});
    while (shown.bricks && shown.bricks->pool().load_some()) {}
    if (shown.arrivals() == before) return picture;
  }
}

}  // namespace

void write_preview(const volume::ShownVolume& shown, const std::string& file) {
  const double began = seconds_now();
  const std::vector<volume::Preset> presets = find_presets(shown);
  Frame sheet;
  fit_frame(side * int(presets.size()), side, sheet);
  std::ranges::fill(sheet.depth, 0.0f);
  for (size_t i = 0; i < presets.size(); i++) {
    const volume::DrawnPreset drawn(shown, presets[i], volume::preview_light());
    const double drawing = seconds_now();
    const volume::VolumePicture picture = draw_finest(shown, drawn);
    std::cerr << fmt::format("  preset '{}' from {:.6g}, drawn in {:.0f} ms\n", presets[i].name,
                             presets[i].points.front().value, 1000 * (seconds_now() - drawing));
    put(picture, int(i), sheet);
  }
  Image8 image;
  tonemap(sheet, Tonemap{1.1f}, image);
  const std::vector<uint8_t> png = encode_png(image, "", file);
  write_file(file, {reinterpret_cast<const char*>(png.data()), png.size()});
  std::cerr << fmt::format("  {}: {} presets, in {:.1f} s\n", file, presets.size(),
                           seconds_now() - began);
}

}  // namespace wellspring::program
