// SPDX-License-Identifier: Apache-2.0
#include "store/painting/painted_picture.h"

#include <algorithm>
#include <cmath>

#include "base/load_error.h"
#include "store/painting/brush.h"
#include "store/painting/material.h"
#include "store/painting/paint_vectors.h"
#include "store/painting/painting_file.h"

namespace wellspring::store {

namespace {

constexpr int painted_tile = 256;      // texels a side
constexpr int most_margin = 48;        // texels around a window from which strokes take colours
constexpr float relief_light = 0.35f;  // how strongly a slope of paint shines
constexpr float most_relief = 0.22f;

// Returns the colour of a window of vectors between texels, as codes from 0 to 1.
vec3 color_between(const PaintedVectors& from, float x, float y) {
  x = std::clamp(x, 0.f, float(from.width) - 1.001f);
  y = std::clamp(y, 0.f, float(from.height) - 1.001f);
  const int left = int(x), top = int(y);
  const float u = x - float(left), v = y - float(top);
  const uint32_t* row = &from.colors[size_t(top) * size_t(from.width) + size_t(left)];
  const auto code = [](uint32_t texel) {
    return vec3(float(texel >> 16 & 255), float(texel >> 8 & 255), float(texel & 255));
  };
  if (u == 0 && v == 0) return code(row[0]) * (1.f / 255);
  const vec3 mixed = glm::mix(glm::mix(code(row[0]), code(row[1]), u),
                              glm::mix(code(row[from.width]), code(row[from.width + 1]), u), v);
  return mixed * (1.f / 255);
}

// Returns the numbers of brushes in the part of the vectors that a field covers.
std::vector<uint8_t> brushes_of(const PaintedVectors& vectors, const StrokeField& field,
                                int margin) {
  std::vector<uint8_t> brushes(size_t(field.width) * size_t(field.height));
  for (int y = 0; y < field.height; y++)
    std::copy_n(&vectors.brushes[size_t(y + margin) * size_t(vectors.width) + size_t(margin)],
                field.width, &brushes[size_t(y) * size_t(field.width)]);
  return brushes;
}

// Returns how much lighter paint is where its relief turns to the light, at the upper left.
float relief_at(const StrokeField& field, size_t at) {
  const std::vector<float>& height = field.relief;
  const size_t row = size_t(field.stride);
  const float slope = height[at + 1] - height[at - 1] + height[at + row] - height[at - row];
  return std::clamp(0.5f * relief_light * slope, -most_relief, most_relief);
}

}  // namespace

PaintedPicture::PaintedPicture(std::string file, Painting painting, size_t layer)
    : file_(std::move(file)), painting_(std::move(painting)), layer_(layer) {
  languages_ = painting_.languages;
  int64_t width = painting_.width, height = painting_.height;
  for (;; width = (width + 1) / 2, height = (height + 1) / 2) {
    levels_.push_back({width, height, painted_tile, painted_tile});
    if (std::max(width, height) <= coarsest_side) break;
  }
}

Fetched PaintedPicture::fetch(PieceKey key) const {
  if (key.level() >= int(levels_.size())) return {};
  const PyramidLevel& level = levels_[size_t(key.level())];
  if (int64_t(key.column()) >= level.columns() || int64_t(key.row()) >= level.rows()) return {};
  const int column = int(key.column()), row = int(key.row());
  Fetched fetched;
  fetched.piece = std::make_shared<const Piece>(
      paint(key.level(), int64_t(column) * painted_tile, int64_t(row) * painted_tile,
            level.width_at(column), level.height_at(row)));
  return fetched;
}

Piece PaintedPicture::paint(int level, int64_t left, int64_t top, int width, int height) const {
  const double scale = std::ldexp(double(painting_.width), -level);
  const double texel = painting_.metres / scale;
  const int margin =
      2 + int(std::min(std::ceil(longest_smear(painting_) / texel), double(most_margin)));
  const PaintLayer& layer = painting_.layers[layer_];
  const PaintedVectors vectors = draw_vectors(painting_, layer,
                                              {double(left - margin), double(top - margin), scale,
                                               width + 2 * margin, height + 2 * margin});
  if (vectors.crowded)
    throw LoadError(file_,
                    "level " + std::to_string(level) + ", texel " + std::to_string(left) + ", " +
                        std::to_string(top),
                    "more is drawn there than can be painted at once");
  // The field has a border of a texel, in which relief is compared.
  StrokeField field;
  field.resize(width + 2, height + 2);
  StrokeWindow window{double(left - 1), double(top - 1), texel, painting_.metres};
  const std::vector<uint8_t> brushes = brushes_of(vectors, field, margin - 1);
  add_strokes(field, painting_, window, brushes);

  window.left++, window.top++;
  std::vector<float> factors(size_t(width) * size_t(height), 1.f);
  age_texels(factors, width, layer.material, painting_.seed, window);
  Piece piece{width, height, std::vector<uint8_t>(4 * factors.size())};
  for (int y = 0; y < height; y++)
    for (int x = 0; x < width; x++) {
      const size_t at = field.at(x + 1, y + 1);
      const size_t texel_at = size_t(y) * size_t(width) + size_t(x);
      const float most = float(margin - 2);
      vec3 color =
          color_between(vectors, float(x + margin) + std::clamp(field.smear_x[at], -most, most),
                        float(y + margin) + std::clamp(field.smear_y[at], -most, most));
      if (layer.gray) color = vec3(glm::dot(color, vec3(0.3f, 0.6f, 0.1f)));
      const float factor = factors[texel_at] * (1 + field.tone[at]), warm = field.warmth[at];
      color *= factor * vec3(1 + warm, 1 + 0.2f * warm, 1 - warm);
      color += relief_at(field, at) * (0.15f + glm::dot(color, vec3(0.28f)));
      uint8_t* codes = &piece.bytes[4 * texel_at];
      for (int i = 0; i < 3; i++) codes[i] = uint8_t(std::clamp(255 * color[i] + 0.5f, 0.f, 255.f));
      codes[3] = 255;
    }
  return piece;
}

std::shared_ptr<const PaintedPicture> open_painting(const std::string& path,
                                                    const std::string& layer,
                                                    const std::string& language) {
  Painting painting = read_painting(path, language);
  size_t index = 0;
  while (index < painting.layers.size() && !layer.empty() && painting.layers[index].name != layer)
    index++;
  if (index >= painting.layers.size())
    throw LoadError(path, "/layers", "there is no layer '" + layer + "'");
  return std::make_shared<const PaintedPicture>(path, std::move(painting), index);
}

}  // namespace wellspring::store
