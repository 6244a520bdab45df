// SPDX-License-Identifier: Apache-2.0
#include "kiosk/face/face_mesh.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>
#include <vector>

namespace wellspring::kiosk {

namespace {

constexpr float least_confidence = 0.5f;  // below, irises are not read
constexpr float mesh_rim = 1.5f;          // side of the square over that of the mesh
// The landmarks' square has no forehead: the mesh's is larger by this, and higher by this share.
constexpr float over_marks = 1.45f, above_marks = 0.1f;
constexpr float eye_rim = 2.3f;  // side of an eye's square over the distance of its corners
// These points are the corners of the eyes: at image left the outer and the inner one, at image
// right the inner and the outer one.
constexpr size_t eye_corners[2][2] = {{33, 133}, {362, 263}};
constexpr size_t iris_values = 228, contour_points = 71;

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

MeshReader::MeshReader(const std::string& folder)
    : mesh_(open_graph(graph_file(folder, "facemesh"))),
      iris_(open_graph(graph_file(folder, "iris"))) {}

FaceMesh MeshReader::read(const GrayView& picture, const Cut& square) {
  const Tensors outputs = mesh_.run(levels(picture, square, mesh_));
  const std::vector<float>& values = outputs.at("output_mesh").values;
  const auto side = float(mesh_.input().columns);
  FaceMesh mesh;
  mesh.confidence = first_of(outputs, "output_faceflag");
  for (size_t k = 0; k < mesh_points; k++)
    mesh.points[k] = vec3(cut_to_picture(square, vec2(values[3 * k], values[3 * k + 1]) / side),
                          values[3 * k + 2] / side * square.width);
  if (!(mesh.confidence >= least_confidence)) return mesh;
  mesh.irises.emplace();
  for (size_t eye = 0; eye < 2; eye++) {
    const vec2 from{mesh.points[eye_corners[eye][0]]}, to{mesh.points[eye_corners[eye][1]]};
    const float width = eye_rim * glm::length(to - from);
    (*mesh.irises)[eye] =
        read_iris(picture, {(from + to) / 2.f, width, width, square.angle}, eye == 1);
  }
  return mesh;
}

std::array<vec2, iris_points> MeshReader::read_iris(const GrayView& picture, const Cut& eye,
                                                    bool mirrored) {
  const auto side = float(iris_.input().columns);
  std::vector<float> planes = levels(picture, eye, iris_);
  if (mirrored) mirror(planes, size_t(side));
  const Tensors outputs = iris_.run(planes);
  const std::vector<float>& values = outputs.at("Identity").values;
  std::array<vec2, iris_points> out;
  for (size_t k = 0; k < iris_points; k++) {
    const float* point = &values[3 * (contour_points + k)];
    const vec2 share = vec2(point[0], point[1]) / side;
    out[k] = cut_to_picture(eye, {mirrored ? 1 - share.x : share.x, share.y});
  }
  if (mirrored) std::swap(out[1], out[3]);
  return out;
}

LivenessReader::LivenessReader(const std::string& folder)
    : real_(open_graph(graph_file(folder, "antispoof"))),
      alive_(open_graph(graph_file(folder, "liveness"))) {}

float LivenessReader::read(const GrayView& picture, const Cut& square) {
  const float real = first_of(real_.run(levels(picture, square, real_)), "activation_4");
  const float alive = first_of(alive_.run(levels(picture, square, alive_)), "activation_6");
  return (real + alive) / 2;
}

}  // namespace wellspring::kiosk
