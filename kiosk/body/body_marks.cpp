// SPDX-License-Identifier: Apache-2.0
#include "kiosk/body/body_marks.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <span>

#include "base/load_error.h"

namespace wellspring::kiosk {

namespace {

constexpr int map_side = 48, map_cells = map_side * map_side;
// Distances in cells by which the published decoding weakens what is far from where it is sought.
constexpr float near_middle = 1.8f, near_guess = 1.8f;
constexpr float least_center = 0.1f;  // value of a centre besides the first
constexpr int center_apart = 4;       // cells between two centres

constexpr const char* center_map = "StatefulPartitionedCall/Sigmoid_1";
constexpr const char* point_maps = "StatefulPartitionedCall/Sigmoid";
constexpr const char* guesses = "StatefulPartitionedCall/kpt_regress_0/conv2d_6/BiasAdd";
constexpr const char* offsets = "StatefulPartitionedCall/kpt_offset_0/conv2d_7/BiasAdd";

Graph load_maps(const std::string& folder) {
  const std::string file = (std::filesystem::path(folder) / "movenet-lightning.json").string();
  return load_graph(file, {center_map, point_maps, guesses, offsets});
}

struct Maps {
  // Numbers by cell (row by row), then by point; guesses and offsets have a row and a column each.
  std::span<const float> center, points, guesses, offsets;
};

Maps maps_of(const Tensors& outputs) {
  auto values = [&](const char* name) { return std::span(outputs.at(name).values); };
  return {values(center_map), values(point_maps), values(guesses), values(offsets)};
}

// Returns the cells of centres: the one that is surest near the middle, then others that are the
// highest of their surroundings, the surest first.
std::vector<int> find_centers(std::span<const float> center, size_t most) {
  int first = 0;
  float best = -1;
  for (int cell = 0; cell < map_cells; cell++) {
    const auto row = float(cell / map_side - map_side / 2);
    const auto column = float(cell % map_side - map_side / 2);
    const float value = center[size_t(cell)] / (std::hypot(row, column) + near_middle);
    if (value > best) best = value, first = cell;
  }
  std::vector<int> found = {first};
  std::vector<int> order;
  for (int cell = 0; cell < map_cells; cell++)
    if (center[size_t(cell)] >= least_center) order.push_back(cell);
  std::ranges::sort(order, [&](int a, int b) { return center[size_t(a)] > center[size_t(b)]; });
  for (int cell : order) {
    if (found.size() >= most) break;
    auto near = [&](int other) {
      return std::max(std::abs(cell / map_side - other / map_side),
                      std::abs(cell % map_side - other % map_side)) < center_apart;
    };
    if (std::ranges::none_of(found, near)) found.push_back(cell);
  }
  found.resize(std::min(found.size(), most));
  return found;
}

// Decodes the body of one centre: each point is the highest of its map near the centre's guess,
// moved by the offset there.
BodyMarks decode(const Maps& maps, int center, const Cut& square) {
  BodyMarks out;
  out.score = maps.center[size_t(center)];
  for (size_t point = 0; point < body_points; point++) {
    const float* guess = &maps.guesses[size_t(center) * 2 * body_points + 2 * point];
    const float row = float(center / map_side) + guess[0];
    const float column = float(center % map_side) + guess[1];
    size_t cell = 0;
    float best = -1;
    for (int y = 0; y < map_side; y++)
      for (int x = 0; x < map_side; x++) {
        const auto at = size_t(y * map_side + x);
        const float far = std::hypot(float(y) - row, float(x) - column);
        const float value = maps.points[at * body_points + point] / (far + near_guess);
        if (value > best) best = value, cell = at;
      }
    const float* offset = &maps.offsets[cell * 2 * body_points + 2 * point];
    const vec2 share = vec2(float(cell % map_side) + offset[1], float(cell / map_side) + offset[0]);
    out.points[point] = {cut_to_picture(square, share / float(map_side)),
                         maps.points[cell * body_points + point]};
  }
  return out;
}

}  // namespace

BodyReader::BodyReader(const std::string& folder) : network_(load_maps(folder)) {
  const GraphNetwork::Input& size = network_.input();
  const std::vector<float> nothing(size_t(size.rows) * size_t(size.columns) *
                                   size_t(size.channels));
  const Tensors outputs = network_.run(nothing);
  const auto expect = [&](const char* name, size_t each) {
    if (outputs.at(name).values.size() != each * map_cells)
      throw LoadError((std::filesystem::path(folder) / "movenet-lightning.json").string(), name,
                      "has the shape " + shape_text(outputs.at(name).shape) +
                          " instead of 1x48x48x" + std::to_string(each));
  };
  expect(center_map, 1), expect(point_maps, body_points);
  expect(guesses, 2 * body_points), expect(offsets, 2 * body_points);
}

std::vector<BodyMarks> BodyReader::read(const GrayView& picture, const TintView& tint,
                                        const Cut& square, size_t most) {
  const GraphNetwork::Input& size = network_.input();
  const NetworkInput input = cut_out(picture, tint, square, size.columns, size.rows);
  const Tensors outputs = network_.run(input.planes);
  const Maps maps = maps_of(outputs);
  std::vector<BodyMarks> found;
  for (int center : find_centers(maps.center, most)) found.push_back(decode(maps, center, square));
  return found;
}

BodyBox body_box(const BodyMarks& marks) {
  BodyBox box{vec2(1e9f), vec2(-1e9f)};
  int seen = 0;
  for (const BodyMark& mark : marks.points) {
    if (mark.score < least_point_score) continue;
    box.low = glm::min(box.low, mark.pixel), box.high = glm::max(box.high, mark.pixel);
    seen++;
  }
  return seen < 2 ? BodyBox{} : box;
}

Cut body_cut(const BodyMarks& marks) {
  constexpr float torso_reach = 1.9f, body_reach = 1.2f;  // the published rule's
  constexpr float rim = 1.5f;                             // round a body without hips
  const BodyMark &left = marks.at(BodyPoint::left_hip), &right = marks.at(BodyPoint::right_hip);
  const BodyBox box = body_box(marks);
  if (left.score < least_point_score || right.score < least_point_score) {
    const vec2 size = box.high - box.low;
    const float side = rim * std::max(size.x, size.y);
    return {(box.low + box.high) / 2.f, side, side, 0};
  }
  const vec2 middle = (left.pixel + right.pixel) / 2.f;
  float torso = 0, body = 0;
  for (size_t point = 0; point < body_points; point++) {
    if (marks.points[point].score < least_point_score) continue;
    const vec2 off = glm::abs(marks.points[point].pixel - middle);
    const float far = std::max(off.x, off.y);
    body = std::max(body, far);
    const auto which = BodyPoint(point);
    if (which == BodyPoint::left_shoulder || which == BodyPoint::right_shoulder ||
        which == BodyPoint::left_hip || which == BodyPoint::right_hip)
      torso = std::max(torso, far);
  }
  const float side = 2 * std::max(torso_reach * torso, body_reach * body);
  return {middle, side, side, 0};
}

}  // namespace wellspring::kiosk
