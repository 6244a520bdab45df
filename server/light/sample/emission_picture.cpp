// SPDX-License-Identifier: Apache-2.0
#include "light/sample/emission_picture.h"

#include <algorithm>
#include <cmath>

#include "light/random/warp.h"

namespace wellspring::light {
namespace {

constexpr float least_variation = 0.3f;  // standard deviation over mean below which it does not pay
constexpr float floor_share = 0.05f;     // of the mean, that even a dark cell keeps

// Row j has n - j upright cells with n - j - 1 upside-down ones between them.
struct Cell {
  int i = 0, j = 0;
  bool upside_down = false;
};

int index_of(int n, Cell c) { return c.j * (2 * n - c.j) + 2 * c.i + c.upside_down; }

Cell cell_of(int n, int index) {
  int j = int(float(n) - std::sqrt(std::max(0.0f, float(n * n - index))));
  j = std::clamp(j, 0, n - 1);
  while (j > 0 && index < j * (2 * n - j)) j--;
  while (j < n - 1 && index >= (j + 1) * (2 * n - j - 1)) j++;
  int rest = index - j * (2 * n - j);
  return {rest / 2, j, rest % 2 == 1};
}

Cell cell_at(int n, vec2 barycentric) {
  vec2 scaled = glm::max(barycentric, vec2(0)) * float(n);
  Cell c;
  c.j = std::clamp(int(scaled.y), 0, n - 1);
  c.i = std::clamp(int(scaled.x), 0, n - 1 - c.j);
  float x = scaled.x - float(c.i), y = scaled.y - float(c.j);
  c.upside_down = x + y > 1 && c.i < n - 1 - c.j;
  return c;
}

vec2 place_in(int n, Cell c, vec2 inside) {
  vec2 low(float(c.i), float(c.j));
  return (c.upside_down ? low + 1.0f - inside : low + inside) / float(n);
}

}  // namespace

EmissionPicture make_emission_picture(float texels, const std::function<float(vec2)>& eval) {
  EmissionPicture picture;
  if (!(texels > 4)) return picture;
  int n = int(std::clamp(std::sqrt(std::min(texels, 1e6f)), 4.0f, float(most_emission_rows)));
  std::vector<float> weight(size_t(n) * size_t(n));
  double sum = 0, squares = 0;
  for (int k = 0; k < n * n; k++) {
    float bright = 0;
    for (vec2 inside : {vec2(1 / 3.0f), vec2(0.1f), vec2(0.8f, 0.1f), vec2(0.1f, 0.8f)}) {
      float value = eval(place_in(n, cell_of(n, k), inside));
      if (value > 0 && std::isfinite(value)) bright += 0.25f * value;
    }
    weight[size_t(k)] = bright;
    sum += double(bright);
    squares += double(bright) * double(bright);
  }
  double count = double(n) * n, mean = sum / count;
  double variance = squares / count - mean * mean;
  if (!(variance > double(least_variation * least_variation) * mean * mean)) return picture;
  for (float& w : weight) w += floor_share * float(mean);
  picture.n = n;
  picture.cells = make_alias_table(weight);
  return picture;
}

PicturePlace sample_emission_picture(const EmissionPicture& picture, vec2 u) {
  AliasPick pick = sample_alias(picture.cells, u.x);
  vec2 inside = sample_triangle({pick.u, u.y});
  PicturePlace place;
  place.barycentric = place_in(picture.n, cell_of(picture.n, int(pick.index)), inside);
  place.density = picture.cells.cells[pick.index].probability * float(picture.n) * float(picture.n);
  return place;
}

float sample_emission_picture_pdf(const EmissionPicture& picture, vec2 barycentric) {
  int index = index_of(picture.n, cell_at(picture.n, barycentric));
  return picture.cells.cells[size_t(index)].probability * float(picture.n) * float(picture.n);
}

}  // namespace wellspring::light
