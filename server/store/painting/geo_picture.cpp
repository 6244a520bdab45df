// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "base/load_error.h"
#include "store/painting/geo_style.h"
#include "store/painting/painted_picture.h"
#include "store/painting/painting_finish.h"

namespace wellspring::store {

namespace {

constexpr double longest_map = 32768;      // texels of the longer side
constexpr double most_map_aspect = 64;     // longer side by the shorter one
constexpr double border_of_points = 0.04;  // around what has no bbox, of its larger side
constexpr double paper_millimetre = 0.001, simple_pixel = 0.0003;  // shares of the width

}  // namespace

std::shared_ptr<const PaintedPicture> open_geojson(const std::string& path,
                                                   const std::string& language) {
  const GeoFile file = read_geojson(path);
  GeoFrame frame;
  frame.bounds = geo_bounds(file);
  if (!file.bbox && !file.box.empty()) {
    const dvec2 size = frame.bounds.high - frame.bounds.low;
    frame.bounds = frame.bounds.grown(border_of_points * std::max(size.x, size.y));
  }
  if (!is_geographic(file.box.empty() ? frame.bounds : file.box))
    throw LoadError(path, "", "has no longitudes and latitudes; a painting can give their bounds");
  const double aspect = std::clamp(geo_aspect(frame.bounds), 1 / most_map_aspect, most_map_aspect);
  Painting painting;
  painting.width = int64_t(std::lround(longest_map * std::min(aspect, 1.0)));
  painting.height = int64_t(std::lround(longest_map * std::min(1 / aspect, 1.0)));
  frame.frame = {{0, 0}, {1, double(painting.height) / double(painting.width)}};
  GeoStyles styles;
  styles.styles[0] = plain_geo_style(paper_millimetre);
  styles.simple_width = simple_pixel;
  PaintItem item;
  item.kind = PaintItem::Kind::geo;
  item.geo = std::make_shared<const GeoDrawing>(
      make_geo_drawing(file, frame, std::move(styles), language));
  painting.languages.assign(item.geo->languages.begin(), item.geo->languages.end());
  finish_item(item, painting);
  PaintLayer layer;
  layer.name = "map";
  layer.items.push_back(std::move(item));
  painting.layers.push_back(std::move(layer));
  return std::make_shared<const PaintedPicture>(path, std::move(painting), 0);
}

}  // namespace wellspring::store
