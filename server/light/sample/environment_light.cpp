// SPDX-License-Identifier: Apache-2.0
#include "light/sample/environment_light.h"

#include <algorithm>
#include <cmath>

#include "light/random/warp.h"

namespace wellspring::light {
namespace {

constexpr int most_columns = 1024, most_rows = 512;

// +Y is the top row, -Z the middle column, +X to the right of it.
vec2 uv_of(vec3 d) {
  return {0.5f + std::atan2(d.x, -d.z) / (2 * pi), std::acos(glm::clamp(d.y, -1.0f, 1.0f)) / pi};
}

vec3 look_up(const EnvironmentLight& light, vec2 uv) {
  Texture texture;
  texture.wrap_u = Wrap::repeat;
  texture.wrap_v = Wrap::clamp;
  return glm::max(vec3(eval_texture(*light.image, texture, uv)), vec3(0));
}

// Returns the cosine of the polar angle at a row's upper edge.
float edge(const EnvironmentLight& light, int row) {
  return std::cos(pi * float(row) / float(light.rows));
}

// Chords keep their precision where cosines near 1 do not.
bool meets_sun(const EnvironmentLight& light, vec3 direction) {
  if (!(light.sun_chord2 > 0)) return false;
  vec3 chord = direction - light.sun_direction;
  return dot(chord, chord) <= light.sun_chord2;
}

void add_sun(const SunDisc& sun, bool importance, EnvironmentLight& light) {
  float length2 = dot(sun.direction, sun.direction);
  bool emits = luminance(sun.radiance) > 0 && is_finite(sun.radiance) && length2 > 0 &&
               std::isfinite(length2) && sun.angular_radius > 0;
  if (!emits) return;
  float half = std::sin(0.5f * std::min(sun.angular_radius, 0.5f * pi));
  light.sun_direction = sun.direction / std::sqrt(length2);
  light.sun_radiance = glm::max(sun.radiance, vec3(0));
  light.sun_chord2 = 4 * half * half;
  // On lit surfaces the sun is most of the light; in its shadow the sky is all of it.
  if (importance) light.sun_share = light.cells.cells.empty() ? 1.0f : 0.5f;
}

void add_picture(const Scene& scene, bool importance, EnvironmentLight& light) {
  int index = scene.environment.image;
  if (index < 0 || size_t(index) >= scene.images.size() || scene.images[size_t(index)].width <= 0)
    return;
  light.image = &scene.images[size_t(index)];
  if (!importance) return;
  light.columns = std::min(light.image->width, most_columns);
  light.rows = std::min(light.image->height, most_rows);
  // Several look-ups a cell take account of a picture finer than the grid and of the filter's
  // reach.
  int across = std::clamp(2 * light.image->width / light.columns, 2, 16);
  int down = std::clamp(2 * light.image->height / light.rows, 2, 16);
  std::vector<float> weights;
  weights.reserve(size_t(light.columns) * size_t(light.rows));
  for (int y = 0; y < light.rows; y++) {
    float solid = edge(light, y) - edge(light, y + 1);
    for (int x = 0; x < light.columns; x++) {
      float sum = 0;
      for (int j = 0; j < down; j++)
        for (int i = 0; i < across; i++)
          sum += luminance(
              look_up(light, {(float(x) + (float(i) + 0.5f) / float(across)) / float(light.columns),
                              (float(y) + (float(j) + 0.5f) / float(down)) / float(light.rows)}));
      weights.push_back(sum / float(across * down) * solid);
    }
  }
  light.cells = make_alias_table(weights);
  light.mean_luminance =
      float(light.cells.total / (2.0 * light.columns)) * luminance(light.radiance);
  if (!(luminance(light.radiance) > 0)) light.cells = {};
}

}  // namespace

EnvironmentLight make_environment_light(const Scene& scene, bool importance) {
  EnvironmentLight light;
  light.radiance = scene.environment.radiance;
  light.mean_luminance = luminance(light.radiance);
  add_picture(scene, importance, light);
  add_sun(scene.environment.sun, importance, light);
  return light;
}

vec3 eval_environment(const EnvironmentLight& light, vec3 direction) {
  vec3 sky = light.image ? light.radiance * look_up(light, uv_of(direction)) : light.radiance;
  return meets_sun(light, direction) ? sky + light.sun_radiance : sky;
}

EnvironmentSample sample_environment(const EnvironmentLight& light, Sampler& sampler) {
  return sample_environment(light, sampler.next2());
}

EnvironmentSample sample_environment(const EnvironmentLight& light, vec2 u) {
  if (u.x < light.sun_share) {
    float below = 0.5f * light.sun_chord2 * (u.x / light.sun_share);  // 1 - cosine
    vec2 rim = std::sqrt(below * (2 - below)) * unit_circle(u.y);
    vec3 tangent, bitangent;
    make_frame_axes(light.sun_direction, tangent, bitangent);
    vec3 direction = tangent * rim.x + bitangent * rim.y + light.sun_direction * (1 - below);
    return {direction, sample_environment_pdf(light, direction)};
  }
  u.x = std::min((u.x - light.sun_share) / (1 - light.sun_share), 0x1.fffffep-1f);
  AliasPick pick = sample_alias(light.cells, u.x);
  int row = int(pick.index) / light.columns, column = int(pick.index) % light.columns;
  float top = edge(light, row), bottom = edge(light, row + 1);
  float y = glm::mix(top, bottom, u.y);
  float phi = ((float(column) + pick.u) / float(light.columns) - 0.5f) * 2 * pi;
  float radius = std::sqrt(std::max(0.0f, 1 - y * y));
  vec3 direction(radius * std::sin(phi), y, -radius * std::cos(phi));
  if (light.sun_share > 0) return {direction, sample_environment_pdf(light, direction)};
  float solid = (top - bottom) * 2 * pi / float(light.columns);
  return {direction, light.cells.cells[pick.index].probability / solid};
}

float sample_environment_pdf(const EnvironmentLight& light, vec3 direction) {
  float sun = 0;
  if (light.sun_share > 0 && meets_sun(light, direction))
    sun = light.sun_share / (pi * light.sun_chord2);
  if (light.cells.cells.empty()) return sun;
  vec2 uv = uv_of(direction);
  int column = std::clamp(int(uv.x * float(light.columns)), 0, light.columns - 1);
  int row = std::clamp(int(uv.y * float(light.rows)), 0, light.rows - 1);
  float solid = (edge(light, row) - edge(light, row + 1)) * 2 * pi / float(light.columns);
  size_t cell = size_t(row) * size_t(light.columns) + size_t(column);
  return sun + (1 - light.sun_share) * light.cells.cells[cell].probability / solid;
}

namespace {

constexpr float least_variation = 0.3f;  // standard deviation over mean below which it does not pay
constexpr float floor_share = 0.05f;     // share of the mean that even a dark cell keeps

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
