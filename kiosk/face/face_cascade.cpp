// SPDX-License-Identifier: Apache-2.0
// Finds faces by the cascades of Debian's opencv-data (Viola and Jones 2001; Liao et al. 2007 for
// LBP): a quick LBP search proposes, a Haar cascade confirms; around a face already followed Haar
// alone searches a small window. Cascades find neither landmarks nor far faces.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <opencv2/imgproc.hpp>
#include <opencv2/objdetect.hpp>

#include "base/load_error.h"
#include "kiosk/face/face_finder.h"

namespace wellspring::kiosk {

namespace {

constexpr int follow_side = 44;     // pixels of a followed face in its window
constexpr int eyes_side = 110;      // pixels of a face in which eyes are searched
constexpr float least_tilt = 0.2f;  // radians; cascades tolerate less

cv::CascadeClassifier load_cascade(const std::string& folder, const char* name) {
  const std::string path = (std::filesystem::path(folder) / name).string();
  if (!std::filesystem::exists(path))
    throw LoadError(path, "", "no such cascade; the Debian package opencv-data brings it");
  cv::CascadeClassifier cascade;
  bool good = false;
  try {
    good = cascade.load(path);
  } catch (const cv::Exception&) {}
  if (!good) throw LoadError(path, "", "not a cascade; reinstall the Debian package opencv-data");
  return cascade;
}

cv::Mat view_of(const GrayFrame& frame) {
  return {frame.height, frame.width, CV_8U, const_cast<uint8_t*>(frame.pixels.data())};
}

Box grown(const Box& box, float factor) {
  float w = box.width * factor, h = box.height * factor;
  return {box.center_x() - w / 2, box.center_y() - h / 2, w, h};
}

// This is a part of a frame at a scale of its own; boxes found in it go back to the frame.
struct Window {
  cv::Mat pixels;
  float x = 0, y = 0, scale_x = 1, scale_y = 1;  // window pixels per frame pixel
  Box to_frame(const cv::Rect& r) const {
    return {x + r.x / scale_x, y + r.y / scale_y, r.width / scale_x, r.height / scale_y};
  }
};

std::optional<Window> cut(const GrayFrame& frame, const Box& box, float scale) {
  cv::Rect area(int(std::floor(box.x)), int(std::floor(box.y)), int(std::ceil(box.width)),
                int(std::ceil(box.height)));
  area &= cv::Rect(0, 0, frame.width, frame.height);
  int w = int(std::lround(area.width * scale)), h = int(std::lround(area.height * scale));
  if (w < 24 || h < 24) return {};
  Window window;
  cv::resize(view_of(frame)(area), window.pixels, {w, h}, 0, 0,
             scale < 1 ? cv::INTER_AREA : cv::INTER_LINEAR);
  window.x = float(area.x);
  window.y = float(area.y);
  window.scale_x = float(w) / float(area.width);
  window.scale_y = float(h) / float(area.height);
  return window;
}

class CascadeFinder : public FaceFinder {
 public:
  explicit CascadeFinder(const FaceSettings& settings);
  // This takes about 8 ms.
  std::vector<Face> search(const GrayFrame& frame) override;
  // This uses the slower and more sensitive Haar cascade alone.
  std::vector<Face> search_thoroughly(const GrayFrame& frame, const Box& zone) override;
  // This finds frontal faces and profiles in about 2 ms. The cascades know upright faces, so the
  // window is turned back by `roll`.
  std::optional<Face> follow(const GrayFrame& frame, const Face& last, float roll) override;
  bool finds_landmarks() const override { return false; }

 private:
  FaceSettings settings;
  cv::CascadeClassifier lbp, haar, profile, eye;

  std::vector<cv::Rect> detect(cv::CascadeClassifier& cascade, const cv::Mat& pixels, int neighbors,
                               float smallest, float largest, std::vector<int>* votes = nullptr) {
    std::vector<cv::Rect> found;
    std::vector<int> counts;
    const cv::Size least{int(smallest), int(smallest)}, most{int(largest), int(largest)};
    cascade.detectMultiScale(pixels, found, counts, 1.1, neighbors, 0, least, most);
    if (votes) *votes = counts;
    return found;
  }

  // Returns the strongest frontal face in a window whose face should have a side near `side`
  // pixels.
  std::optional<Face> best(cv::CascadeClassifier& cascade, const Window& window, float side,
                           int neighbors, FaceView view) {
    std::vector<int> votes;
    auto found = detect(cascade, window.pixels, neighbors, side * 0.7f, side * 1.45f, &votes);
    if (found.empty()) return {};
    size_t k = size_t(std::max_element(votes.begin(), votes.end()) - votes.begin());
    Face face{
        window.to_frame(found[k]), view, std::min(1.f, 0.3f + 0.04f * float(votes[k])), {}, {}};
    return face;
  }

  std::optional<Face> confirm(const GrayFrame& frame, const Box& box) {
    auto window = cut(frame, grown(box, 1.7f), follow_side / box.width);
    if (!window) return {};
    return best(haar, *window, follow_side, 2, FaceView::frontal);
  }

  // Finds one eye in each upper quarter of the face.
  void find_eyes(const GrayFrame& frame, Face& face) {
    const Box& b = face.box;
    std::array<vec2, 2> eyes;
    for (int side = 0; side < 2; side++) {
      Box area{b.x + (side ? 0.50f : 0.08f) * b.width, b.y + 0.18f * b.height, 0.42f * b.width,
               0.40f * b.height};
      auto window = cut(frame, area, eyes_side / b.width);
      if (!window) return;
      std::vector<int> votes;
      auto found = detect(eye, window->pixels, 2, 20, 44, &votes);
      if (found.empty()) return;
      size_t k = size_t(std::max_element(votes.begin(), votes.end()) - votes.begin());
      Box at = window->to_frame(found[k]);
      eyes[size_t(side)] = {at.center_x(), at.center_y()};
    }
    float apart = (eyes[1].x - eyes[0].x) / b.width, tilt = (eyes[1].y - eyes[0].y) / b.width;
    if (apart > 0.2f && apart < 0.6f && std::abs(tilt) < 0.3f) face.eyes = eyes;
  }

  // Searches the surroundings of a face, turned upright about their middle: a small frame of their
  // own.
  std::optional<Face> follow_tilted(const GrayFrame& frame, const Box& last, float roll) {
    GrayFrame upright;
    upright.width = upright.height = int(std::ceil(2.2f * last.width));
    upright.pixels.resize(size_t(upright.width) * size_t(upright.height));
    const float c = std::cos(roll), s = std::sin(roll), half = float(upright.width) / 2;
    const float u = last.center_x(), v = last.center_y();
    // Maps the upright window to the frame: a tilt towards image left turns it against the clock.
    auto to_frame = [&](vec2 p) {
      vec2 q = p - vec2(half);
      return vec2(u + c * q.x + s * q.y, v - s * q.x + c * q.y);
    };
    const vec2 corner = to_frame(vec2(0));
    cv::Mat map = (cv::Mat_<double>(2, 3) << c, s, corner.x, -s, c, corner.y);
    cv::Mat out(upright.height, upright.width, CV_8U, upright.pixels.data());
    cv::warpAffine(view_of(frame), out, map, out.size(), cv::INTER_LINEAR | cv::WARP_INVERSE_MAP,
                   cv::BORDER_REPLICATE);
    auto window = cut(upright, {0, 0, 2 * half, 2 * half}, follow_side / last.width);
    if (!window) return {};
    auto face = best(haar, *window, follow_side, 2, FaceView::frontal);
    if (!face) return {};
    find_eyes(upright, *face);
    const vec2 middle = to_frame({face->box.center_x(), face->box.center_y()});
    face->box.x = middle.x - face->box.width / 2;
    face->box.y = middle.y - face->box.height / 2;
    if (face->eyes)
      for (vec2& eye : *face->eyes) eye = to_frame(eye);
    return face;
  }

  void add(std::vector<Face>& faces, Face face) {
    for (Face& other : faces)
      if (overlap(other.box, face.box) > 0.3f) {
        if (face.confidence > other.confidence) other = face;
        return;
      }
    faces.push_back(face);
  }

  static void largest_first(std::vector<Face>& faces) {
    std::sort(faces.begin(), faces.end(),
              [](auto& a, auto& b) { return a.box.width > b.box.width; });
    if (faces.size() > 8) faces.resize(8);
  }
};

CascadeFinder::CascadeFinder(const FaceSettings& given) : settings(given) {
  lbp = load_cascade(settings.cascades, "lbpcascades/lbpcascade_frontalface.xml");
  haar = load_cascade(settings.cascades, "haarcascades/haarcascade_frontalface_alt2.xml");
  profile = load_cascade(settings.cascades, "haarcascades/haarcascade_profileface.xml");
  eye = load_cascade(settings.cascades, "haarcascades/haarcascade_eye_tree_eyeglasses.xml");
}

std::vector<Face> CascadeFinder::search(const GrayFrame& frame) {
  std::vector<Face> faces;
  const float scale = std::min(1.f, float(settings.search_width) / float(frame.width));
  auto window = cut(frame, {0, 0, float(frame.width), float(frame.height)}, scale);
  if (!window) return faces;
  const float smallest = std::max(24.f, settings.smallest * float(window->pixels.cols));
  auto found = detect(lbp, window->pixels, 2, smallest, 1e6f);
  std::sort(found.begin(), found.end(), [](auto& a, auto& b) { return a.width > b.width; });
  if (found.size() > 12) found.resize(12);
  for (const cv::Rect& r : found)
    if (auto face = confirm(frame, window->to_frame(r))) add(faces, *face);
  largest_first(faces);
  return faces;
}

std::vector<Face> CascadeFinder::search_thoroughly(const GrayFrame& frame, const Box& zone) {
  std::vector<Face> faces;
  const float smallest_box = settings.smallest * float(frame.width);
  // The cascade's window is 20 pixels wide, so the smallest face that counts is made 24.
  auto window = cut(frame, zone, std::min(1.f, 24 / smallest_box));
  if (!window) return faces;
  std::vector<int> votes;
  auto found = detect(haar, window->pixels, 3, 24, 1e6f, &votes);
  for (size_t i = 0; i < found.size(); i++)
    add(faces, {window->to_frame(found[i]),
                FaceView::frontal,
                std::min(1.f, 0.3f + 0.04f * float(votes[i])),
                {}});
  largest_first(faces);
  return faces;
}

std::optional<Face> CascadeFinder::follow(const GrayFrame& frame, const Face& face_before,
                                          float roll) {
  const Box& last = face_before.box;
  if (!(last.width > 4)) return {};
  if (std::abs(roll) > least_tilt) return follow_tilted(frame, last, roll);
  auto window = cut(frame, grown(last, 2.0f), follow_side / last.width);
  if (!window) return {};
  auto face = best(haar, *window, follow_side, 2, FaceView::frontal);
  if (face) {
    find_eyes(frame, *face);
    return face;
  }
  // The profile cascade finds faces that look to the image's left; the others are mirrored for it.
  face = best(profile, *window, follow_side, 2, FaceView::image_left);
  if (face) return face;
  const float right = window->x + float(window->pixels.cols) / window->scale_x;
  cv::flip(window->pixels, window->pixels, 1);
  face = best(profile, *window, follow_side, 2, FaceView::image_right);
  if (face) face->box.x = window->x + right - face->box.x - face->box.width;
  return face;
}

}  // namespace

std::unique_ptr<FaceFinder> make_cascade_finder(const FaceSettings& settings) {
  return std::make_unique<CascadeFinder>(settings);
}

}  // namespace wellspring::kiosk
