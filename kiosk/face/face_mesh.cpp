// SPDX-License-Identifier: Apache-2.0
#include "kiosk/face/face_mesh.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>
#include <vector>

namespace wellspring::kiosk {

namespace {

constexpr float mesh_rim = 1.5f;  // side of the square over that of the mesh
// The landmarks' square has no forehead: the mesh's is larger by this, and higher by this share.
constexpr float over_marks = 1.45f, above_marks = 0.1f;
constexpr float eye_rim = 2.3f;  // side of an eye's square over the distance of its corners
// These points are the corners of the eyes: at image left the outer and the inner one, at image
// right the inner and the outer one.
constexpr size_t eye_corners[2][2] = {{33, 133}, {362, 263}};
// The iris network tells points of the lids first, then those of the iris.
constexpr size_t contour_points = 71, lower_lid = 4, upper_lid = 12, lid_corners[] = {0, 8};
// Entry k is the point of the mesh that lies where landmark k does.
constexpr std::array<uint16_t, landmark_count> point_of_mark = {
    162, 234, 93,  58,  172, 136, 149, 148, 152, 377, 378, 365, 397, 288, 323, 454, 389,  // outline
    71,  63,  105, 66,  107, 336, 296, 334, 293, 301,                                     // brows
    168, 197, 5,   4,   75,  97,  2,   326, 305,                                          // nose
    33,  160, 158, 133, 153, 144, 362, 385, 387, 263, 373, 380,                           // eyes
    61,  39,  37,  0,   267, 269, 291, 405, 314, 17,  84,  181,                           // lips
    78,  82,  13,  312, 308, 317, 14,  87};

std::string graph_file(const std::string& folder, const char* name) {
  return (std::filesystem::path(folder) / (std::string(name) + ".json")).string();
}

// Returns the cut as a network wants it: levels from 0 to 1.
std::vector<float> levels(const GrayView& picture, const Cut& cut, const GraphNetwork& network) {
  NetworkInput input = cut_out(picture, cut, network.input().columns, network.input().rows);
  for (float& level : input.planes) level /= 255;
  return std::move(input.planes);
}

// Turns rows round, so that an eye at image right looks like one at image left.
void mirror(std::vector<float>& planes, size_t columns) {
  for (auto row = planes.begin(); row != planes.end(); row += std::ptrdiff_t(columns))
    std::reverse(row, row + std::ptrdiff_t(columns));
}

float first_of(const Tensors& outputs, const char* name) { return outputs.at(name).values.at(0); }

}  // namespace

Cut mesh_cut_of_marks(const FaceMarks& marks) {
  Cut cut = cut_of_marks(marks);
  cut.middle = cut_to_picture(cut, {0.5f, 0.5f - above_marks});
  cut.width = cut.height = over_marks * cut.width;
  return cut;
}

Cut mesh_cut_of_mesh(const FaceMesh& mesh) {
  const vec2 left{mesh.points[eye_corners[0][0]]}, right{mesh.points[eye_corners[1][1]]};
  Cut cut{{}, 1, 1, std::atan2(left.y - right.y, right.x - left.x)};
  // Corners of the upright cut of one pixel are where axes of the face lead.
  const vec2 across = cut_to_picture(cut, {1.5f, 0.5f}), down = cut_to_picture(cut, {0.5f, 1.5f});
  vec2 low(1e9f), high(-1e9f);
  for (vec3 point : mesh.points) {
    const vec2 upright{glm::dot(vec2(point), across), glm::dot(vec2(point), down)};
    low = glm::min(low, upright), high = glm::max(high, upright);
  }
  const vec2 middle = (low + high) / 2.f;
  cut.middle = middle.x * across + middle.y * down;
  cut.width = cut.height = mesh_rim * std::max(high.x - low.x, high.y - low.y);
  return cut;
}

FaceMarks marks_of_mesh(const FaceMesh& mesh) {
  FaceMarks marks;
  for (size_t k = 0; k < marks.size(); k++) marks[k] = vec2(mesh.points[point_of_mark[k]]);
  return marks;
}

MeshReader::MeshReader(const std::string& folder)
    : network_(open_graph(graph_file(folder, "facemesh"))) {}

FaceMesh MeshReader::read(const GrayView& picture, const Cut& square) {
  const Tensors outputs = network_.run(levels(picture, square, network_));
  const std::vector<float>& values = outputs.at("output_mesh").values;
  const auto side = float(network_.input().columns);
  FaceMesh mesh;
  mesh.confidence = first_of(outputs, "output_faceflag");
  for (size_t k = 0; k < mesh_points; k++)
    mesh.points[k] = vec3(cut_to_picture(square, vec2(values[3 * k], values[3 * k + 1]) / side),
                          values[3 * k + 2] / side * square.width);
  return mesh;
}

IrisReader::IrisReader(const std::string& folder)
    : network_(open_graph(graph_file(folder, "iris"))) {}

void IrisReader::read(const GrayView& picture, FaceMesh& mesh) {
  mesh.irises.emplace();
  const float angle = mesh_cut_of_mesh(mesh).angle;
  for (size_t eye = 0; eye < 2; eye++) read_eye(picture, angle, eye, mesh);
}

void IrisReader::read_eye(const GrayView& picture, float angle, size_t eye, FaceMesh& mesh) {
  const vec2 from{mesh.points[eye_corners[eye][0]]}, to{mesh.points[eye_corners[eye][1]]};
  const float width = eye_rim * glm::length(to - from);
  const Cut cut{(from + to) / 2.f, width, width, angle};
  const bool mirrored = eye == 1;  // the network knows the eye at image left
  const auto side = float(network_.input().columns);
  std::vector<float> planes = levels(picture, cut, network_);
  if (mirrored) mirror(planes, size_t(side));
  const Tensors outputs = network_.run(planes);
  const std::vector<float>& values = outputs.at("Identity").values;
  const auto point = [&](size_t k) { return vec2(values[3 * k], values[3 * k + 1]) / side; };
  auto& iris = (*mesh.irises)[eye];
  for (size_t k = 0; k < iris_points; k++) {
    const vec2 share = point(contour_points + k);
    iris[k] = cut_to_picture(cut, {mirrored ? 1 - share.x : share.x, share.y});
  }
  if (mirrored) std::swap(iris[1], iris[3]);
  mesh.lids[eye] = glm::length(point(lower_lid) - point(upper_lid)) /
                   std::max(1e-3f, glm::length(point(lid_corners[0]) - point(lid_corners[1])));
}

}  // namespace wellspring::kiosk
