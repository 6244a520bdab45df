// SPDX-License-Identifier: Apache-2.0
// Finds faces by trained networks (kiosk/network): a detector proposes boxes, and the landmark
// network must make a face of them that could be a head's (head_pose.h). A followed face is sought
// at its last landmarks, or its last mesh, in every frame; now and then the detector is asked
// whether it still is a face.

#include <algorithm>
#include <cmath>
#include <span>

#include "kiosk/face/face_finder.h"
#include "kiosk/face/head_pose.h"
#include "kiosk/network/face_marks.h"

namespace wellspring::kiosk {

namespace {

constexpr float propose = 0.4f;  // score from which a box may become a face
constexpr float agree = 0.2f;    // score with which a followed one stays one
// the same for one that the detector has seen fewer than `young` times
constexpr float agree_young = 0.35f;
constexpr int young = 4;
constexpr double ask_every = 0.3;  // seconds between the detector's looks at a followed face
constexpr double doubt = 0.7;      // seconds without its agreement until a face is given up
constexpr float is_a_face = 0.5f;  // confidence of a mesh
// These are the sizes of detector windows, network pixels.
constexpr int columns = 320, rows = 256, near_side = 128;
constexpr float near_reach = 2.2f;     // side of the window about a followed face, in squares
constexpr float moved = 0.07f;         // share of the square; farther off, landmarks are read again
constexpr float fine_overlap = 0.25f;  // share of windows side by side
// These are widths of windows over the frame's: the detector is best at faces 45 to 100 pixels
// wide.
constexpr float coarse[] = {0.8f, 0.6f, 0.45f}, fine[] = {0.25f, 0.35f};
constexpr float head_share = 0.6f;  // upper share of a zone: heads are there
constexpr int windows_a_call = 2;
// A lens of 60 degrees is taken: whether landmarks could be a head's hardly depends on it.
constexpr float usual_focal = 0.87f;  // over the frame's width

GrayView gray_view_of(const GrayFrame& frame) {
  return {frame.pixels.data(), frame.width, frame.height};
}

// Returns windows that cover a box, row by row from the top, for each of `sizes`, which are shares
// of `width` by `height`.
std::vector<Cut> windows_over(const Box& box, float width, float height,
                              std::span<const float> sizes) {
  auto count = [](float whole, float part) {
    return std::max(1, int(std::ceil((whole - part) / (part * (1 - fine_overlap)))) + 1);
  };
  auto place = [](float from, float whole, float part, int k, int n) {
    return from + (n == 1 ? whole / 2 : part / 2 + (whole - part) * float(k) / float(n - 1));
  };
  std::vector<Cut> out;
  for (float size : sizes) {
    const float w = size * width, h = size * height;
    const int across = count(box.width, w), down = count(box.height, h);
    for (int y = 0; y < down; y++)
      for (int x = 0; x < across; x++)
        out.push_back(
            {{place(box.x, box.width, w, x, across), place(box.y, box.height, h, y, down)},
             w,
             h,
             0});
  }
  return out;
}

class NetworkFinder : public FaceFinder {
 public:
  NetworkFinder(const std::string& folder, std::optional<MeshReader> reader_of_meshes)
      : boxes(folder), reader(folder), meshes(std::move(reader_of_meshes)) {}
  // This searches in turn the whole frame, coarsely, and one of the windows that cover it; about 12
  // ms.
  std::vector<Face> search(const GrayFrame& frame) override;
  // This searches two windows of the zone's upper part, finer than the frame itself, in turn; about
  // 25 ms. It finds faces to 3.5 m (25 pixels).
  std::vector<Face> search_thoroughly(const GrayFrame& frame, const Box& zone) override;
  // This takes about 5 ms, twice that if the head moves quickly.
  std::optional<Face> follow(const GrayFrame& frame, const Face& last, float roll) override;
  bool finds_landmarks() const override { return true; }
  bool reads_meshes() const override { return meshes.has_value(); }

 private:
  FaceBoxes boxes;
  MarkReader reader;
  std::optional<MeshReader> meshes;
  size_t turn = 0, coarse_turn = 0, fine_turn = 0;

  // Returns the face that landmarks make near `square`; nothing if they make none.
  std::optional<Face> face_at(const GrayFrame& frame, Cut square, int reads) {
    const GrayView view = gray_view_of(frame);
    FaceMarks marks{};
    for (int k = 0; k < reads; k++) {
      marks = reader.read(view, square);
      const Cut next = cut_of_marks(marks);
      if (!(next.width > 8) || !(next.width < 2 * float(frame.width))) return {};
      const float shift = glm::length(next.middle - square.middle) / square.width;
      const float growth = next.width / square.width;
      const bool last = k + 1 == reads || (shift < moved && std::abs(growth - 1) < 2 * moved);
      if (last && (shift > 0.25f || growth < 0.65f || growth > 1.5f)) return {};
      square = next;
      if (last) break;
    }
    return face_of(frame, marks);
  }

  // Returns the face that the mesh near that of `last` makes; nothing if it says there is none.
  std::optional<Face> meshed_face(const GrayFrame& frame, const Face& last) {
    if (!meshes || !last.marks || last.box.width < least_mesh_face) return {};
    const GrayView view = gray_view_of(frame);
    Cut square = last.mesh ? mesh_cut_of_mesh(*last.mesh) : mesh_cut_of_marks(*last.marks);
    FaceMesh mesh;
    for (int read = 0; read < 2; read++) {
      mesh = meshes->read(view, square);
      if (!(mesh.confidence >= is_a_face)) return {};
      const Cut next = mesh_cut_of_mesh(mesh);
      const float shift = glm::length(next.middle - square.middle) / square.width;
      if (shift < moved && std::abs(next.width / square.width - 1) < 2 * moved) break;
      square = next;
    }
    auto face = face_of(frame, marks_of_mesh(mesh));
    if (face) face->mesh = mesh;
    return face;
  }

  // Returns the face with these landmarks; nothing if they could be no head's.
  static std::optional<Face> face_of(const GrayFrame& frame, const FaceMarks& marks) {
    const auto pose =
        solve_head_pose(marks, usual_focal * float(frame.width), frame.width, frame.height);
    if (!pose || !(trust_of_error(pose->error) > 0)) return {};
    const Cut square = cut_of_marks(marks);
    Face face;
    face.box = {square.middle.x - square.width / 2, square.middle.y - square.height / 2,
                square.width, square.height};
    face.confidence = trust_of_error(pose->error);
    face.marks = marks;
    vec2 left{0}, right{0};
    for (size_t k = 36; k < 42; k++) left += marks[k] / 6.f, right += marks[k + 6] / 6.f;
    face.eyes = {left, right};
    return face;
  }

  void look(const GrayFrame& frame, const Cut& window, std::vector<Face>& faces) {
    for (const FaceBox& box : boxes.find(gray_view_of(frame), window, columns, rows, propose)) {
      const float side = std::max(box.width, box.height);
      auto face = face_at(frame, {box.middle, side, side, 0}, 3);
      if (!face ||
          overlap(face->box, {box.middle.x - side / 2, box.middle.y - side / 2, side, side}) < 0.3f)
        continue;
      if (std::any_of(faces.begin(), faces.end(),
                      [&](const Face& other) { return overlap(other.box, face->box) > 0.3f; }))
        continue;
      face->confidence *= box.score;
      face->score = box.score;
      face->asked_time = face->agreed_time = frame.time;
      faces.push_back(*face);
    }
  }

  static void biggest_first(std::vector<Face>& faces) {
    std::sort(faces.begin(), faces.end(),
              [](auto& a, auto& b) { return a.box.width > b.box.width; });
    if (faces.size() > 8) faces.resize(8);
  }
};

std::vector<Face> NetworkFinder::search(const GrayFrame& frame) {
  std::vector<Face> faces;
  const float w = float(frame.width), h = float(frame.height);
  if (turn++ % 2 == 0) {
    const float across = std::max(w, h * columns / rows);
    look(frame, {{w / 2, h / 2}, across, across * rows / columns, 0}, faces);
  } else {
    const auto windows = windows_over({0, 0, w, h}, w, w * rows / columns, coarse);
    look(frame, windows[coarse_turn++ % windows.size()], faces);
  }
  biggest_first(faces);
  return faces;
}

std::vector<Face> NetworkFinder::search_thoroughly(const GrayFrame& frame, const Box& zone) {
  std::vector<Face> faces;
  const float left = std::max(0.f, zone.x), top = std::max(0.f, zone.y);
  const Box part{left, top, std::min(float(frame.width), zone.x + zone.width) - left,
                 head_share * (std::min(float(frame.height), zone.y + zone.height) - top)};
  if (!(part.width > 0 && part.height > 0)) return faces;
  const float width = float(frame.width);
  const auto windows = windows_over(part, width, width * rows / columns, fine);
  for (int k = 0; k < std::min(windows_a_call, int(windows.size())); k++)
    look(frame, windows[fine_turn++ % windows.size()], faces);
  biggest_first(faces);
  return faces;
}

std::optional<Face> NetworkFinder::follow(const GrayFrame& frame, const Face& last, float roll) {
  const Box& b = last.box;
  const Cut square = last.marks ? cut_of_marks(*last.marks)
                                : Cut{{b.center_x(), b.center_y()}, b.width, b.width, roll};
  auto face = meshed_face(frame, last);
  if (!face) face = face_at(frame, square, 2);
  if (!face) return {};
  const float trust = face->confidence;
  face->score = last.score;
  face->asked_time = last.asked_time;
  face->agreed_time = last.agreed_time;
  face->agreed = last.agreed;
  const bool is_young = last.agreed < young;
  if (is_young || frame.time - last.asked_time >= ask_every || frame.time < last.asked_time) {
    face->asked_time = frame.time;
    const Box& now = face->box;
    const float side = near_reach * now.width;
    face->score = 0;
    for (const FaceBox& box :
         boxes.find(gray_view_of(frame), {{now.center_x(), now.center_y()}, side, side, 0},
                    near_side, near_side, is_young ? agree_young : agree)) {
      const float square_side = std::max(box.width, box.height);
      if (overlap(now, {box.middle.x - square_side / 2, box.middle.y - square_side / 2, square_side,
                        square_side}) > 0.3f)
        face->score = std::max(face->score, box.score);
    }
    if (face->score > 0) face->agreed_time = frame.time, face->agreed++;
    else if (is_young) return {};
  }
  if (frame.time - face->agreed_time > doubt) return {};
  face->confidence = trust * face->score;
  return face;
}

}  // namespace

std::unique_ptr<FaceFinder> make_network_finder(const std::string& folder,
                                                std::optional<MeshReader> meshes) {
  return std::make_unique<NetworkFinder>(folder, std::move(meshes));
}

}  // namespace wellspring::kiosk
