// SPDX-License-Identifier: Apache-2.0
#include "kiosk/turn.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "kiosk/head.h"

namespace wellspring {

namespace {

// The head about its centre, metres: x across, y up and down, z front to back.
const vec3 radii{0.078f, 0.115f, 0.095f};
// From the middle of the detector's box to the head's centre, box sides down the image.
constexpr float center_in_box = -0.06f;
constexpr int most_points = 60, fewest_points = 10, wanted_points = 40;
constexpr double longest_gap = 0.3;  // seconds between frames that flow may bridge
// Seconds in which a cue from single frames moves the estimate by two thirds.
constexpr float pull_roll = 0.4f, pull_yaw = 4, pull_profile = 0.4f, pull_pitch = 8;
// How far nostrils and lips stand before the eyes, in eye distances.
constexpr float axis_depth = 0.4f;
constexpr float profile_yaw = 0.9f;  // what a profile view means, radians

// Image axes (u right, v down, into the room) to the visitor's (right, up, towards the visitor's
// back), and back.
const mat3 axes(vec3(-1, 0, 0), vec3(0, -1, 0), vec3(0, 0, 1));

cv::Mat view_of(const GrayFrame& frame, const cv::Rect& area) {
  return cv::Mat(frame.height, frame.width, CV_8U, const_cast<uint8_t*>(frame.pixels.data()))(area);
}

mat3 small_rotation(vec3 w) {
  float angle = glm::length(w);
  return angle < 1e-9f ? mat3(1) : mat3(glm::rotate(mat4(1), angle, w / angle));
}

// Solves the 6x6 system by Gaussian elimination with pivots; false when it is singular.
bool solve(double a[6][7]) {
  for (int i = 0; i < 6; i++) {
    int best = i;
    for (int j = i + 1; j < 6; j++)
      if (std::abs(a[j][i]) > std::abs(a[best][i])) best = j;
    if (!(std::abs(a[best][i]) > 1e-12)) return false;
    std::swap_ranges(a[i], a[i] + 7, a[best]);
    for (int j = 0; j < 6; j++) {
      if (j == i) continue;
      double f = a[j][i] / a[i][i];
      for (int k = i; k < 7; k++) a[j][k] -= f * a[i][k];
    }
  }
  for (int i = 0; i < 6; i++) a[i][6] /= a[i][i];
  return true;
}

}  // namespace

struct Turn::Impl {
  struct Point {
    cv::Point2f at;  // in the frame
    vec3 model;      // on the head, metres
    float weight = 1;
  };
  bool started = false;
  double time = 0;
  mat3 rotation{1};  // head to image axes; identity: the face looks into the lens
  vec2 center{0};    // pixels
  float scale = 1;   // pixels per metre
  std::vector<Point> points;

  void place(const Face& face) {
    scale = face.box.width / face_box_metres;
    center = {face.box.center_x(), face.box.center_y() + center_in_box * face.box.height};
  }

  // Where the ray through a pixel meets the near side of the head, in head axes; false: it passes
  // by.
  bool on_head(cv::Point2f at, vec3& model) const {
    vec3 q =
        glm::transpose(rotation) * vec3((at.x - center.x) / scale, (at.y - center.y) / scale, 0);
    vec3 d = glm::transpose(rotation) * vec3(0, 0, 1);
    vec3 o = q / radii, e = d / radii;
    float a = glm::dot(e, e), b = glm::dot(o, e), c = glm::dot(o, o) - 1, disc = b * b - a * c;
    if (disc < 0.15f * a) return false;  // grazing: the surface there slides over the outline
    model = q + (-b - std::sqrt(disc)) / a * d;
    return true;
  }

  void seed(const GrayFrame& frame, const Face& face) {
    const Box& b = face.box;
    cv::Rect area(int(b.x), int(b.y - 0.05f * b.height), int(b.width), int(0.95f * b.height));
    area &= cv::Rect(0, 0, frame.width, frame.height);
    if (area.width < 16 || area.height < 16) return;
    cv::Mat pixels = view_of(frame, area), mask = cv::Mat::zeros(area.size(), CV_8U);
    cv::ellipse(mask, {area.width / 2, area.height / 2},
                {int(0.40 * area.width), int(0.5 * area.height)}, 0, 0, 360, 255, cv::FILLED);
    const float apart = std::max(3.f, 0.06f * b.width);
    for (const Point& p : points)
      cv::circle(mask, cv::Point(int(p.at.x) - area.x, int(p.at.y) - area.y), int(apart), 0,
                 cv::FILLED);
    std::vector<cv::Point2f> corners;
    cv::goodFeaturesToTrack(pixels, corners, most_points - int(points.size()), 0.02, apart, mask,
                            3);
    for (cv::Point2f c : corners) {
      Point p;
      p.at = {c.x + float(area.x), c.y + float(area.y)};
      if (on_head(p.at, p.model)) points.push_back(p);
    }
  }

  // Moves the points to the new frame and drops those that do not come back to where they were.
  void follow(const GrayFrame& previous, const GrayFrame& frame, const Box& box) {
    float left = box.x, top = box.y, right = box.x + box.width, bottom = box.y + box.height;
    for (const Point& p : points) {
      left = std::min(left, p.at.x), right = std::max(right, p.at.x);
      top = std::min(top, p.at.y), bottom = std::max(bottom, p.at.y);
    }
    const int rim = 24;
    cv::Rect area(int(left) - rim, int(top) - rim, int(right - left) + 2 * rim,
                  int(bottom - top) + 2 * rim);
    area &= cv::Rect(0, 0, frame.width, frame.height);
    if (area.width < 32 || area.height < 32) return points.clear();
    const cv::Mat before = view_of(previous, area), now = view_of(frame, area);
    std::vector<cv::Point2f> from, to, back;
    std::vector<uint8_t> there, and_back;
    std::vector<float> error;
    const cv::Point2f corner{float(area.x), float(area.y)};
    for (const Point& p : points) from.push_back(p.at - corner);
    const int side = std::clamp(int(0.14f * box.width) | 1, 9, 21);
    const cv::TermCriteria until(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 20, 0.02);
    cv::calcOpticalFlowPyrLK(before, now, from, to, there, error, {side, side}, 3, until);
    cv::calcOpticalFlowPyrLK(now, before, to, back, and_back, error, {side, side}, 3, until);
    std::vector<Point> kept;
    for (size_t i = 0; i < points.size(); i++) {
      cv::Point2f d = back[i] - from[i];
      if (!there[i] || !and_back[i] || d.x * d.x + d.y * d.y > 0.6f) continue;
      points[i].at = to[i] + corner;
      kept.push_back(points[i]);
    }
    points = kept;
  }

  // Gauss-Newton over a small rotation, the centre and the scale. Returns the number of points that
  // agree.
  int fit() {
    const float reach = std::max(2.f, 0.035f * scale * face_box_metres);  // pixels, Tukey's limit
    int agree = 0;
    for (int round = 0; round < 6; round++) {
      double a[6][7] = {};
      agree = 0;
      for (Point& p : points) {
        vec3 q = rotation * p.model;
        float ex = p.at.x - (center.x + scale * q.x), ey = p.at.y - (center.y + scale * q.y);
        float r = std::sqrt(ex * ex + ey * ey) / (round < 2 ? 3 * reach : reach);
        p.weight = r < 1 ? (1 - r * r) * (1 - r * r) : 0;
        agree += p.weight > 0.2f;
        // d(w x q) = w x q: x gets wy qz - wz qy, y gets wz qx - wx qz.
        const float jx[6] = {0, scale * q.z, -scale * q.y, 1, 0, scale * q.x};
        const float jy[6] = {-scale * q.z, 0, scale * q.x, 0, 1, scale * q.y};
        for (int i = 0; i < 6; i++) {
          for (int j = 0; j < 6; j++) a[i][j] += double(p.weight) * (jx[i] * jx[j] + jy[i] * jy[j]);
          a[i][6] += double(p.weight) * (jx[i] * ex + jy[i] * ey);
        }
      }
      if (agree < fewest_points) return agree;
      for (int i = 0; i < 3; i++)
        a[i][i] *= 1.001;  // rotations and shifts are nearly alike on a small face
      if (!solve(a)) return 0;
      const vec3 turn{float(a[0][6]), float(a[1][6]), float(a[2][6])};
      if (!is_finite(turn) || glm::length(turn) > 0.5f) return 0;
      rotation = small_rotation(turn) * rotation;
      center += vec2(float(a[3][6]), float(a[4][6]));
      scale *= std::exp(glm::clamp(float(a[5][6]), -0.2f, 0.2f));
    }
    return agree;
  }

  // Corrects the rotation without moving any point in space.
  void relabel(const mat3& corrected) {
    mat3 change = glm::transpose(corrected) * rotation;
    for (Point& p : points) p.model = change * p.model;
    rotation = corrected;
  }

  vec3 angles() const { return yaw_pitch_roll(axes * rotation * axes); }
  void set_angles(vec3 a) { relabel(axes * rotation_matrix(a) * axes); }
};

Turn::Turn() : impl_(std::make_unique<Impl>()) {}
Turn::~Turn() = default;
Turn::Turn(Turn&&) noexcept = default;
Turn& Turn::operator=(Turn&&) noexcept = default;

mat3 Turn::step(const GrayFrame& previous, const GrayFrame& frame, const Face& face, bool detected,
                float rest) {
  Impl& m = *impl_;
  const double gap = frame.time - m.time;
  m.time = frame.time;
  const bool alike = previous.width == frame.width && previous.height == frame.height;
  if (!m.started || !alike || gap <= 0 || gap > longest_gap) {
    m.points.clear();
    m.place(face);
    if (!m.started) m.set_angles({0, rest, 0});
    m.started = true;
  } else if (!m.points.empty()) {
    const mat3 before = m.rotation;
    m.follow(previous, frame, face.box);
    if (m.fit() < fewest_points) {
      m.rotation = before;
      m.points.clear();
      m.place(face);
    } else {
      std::erase_if(m.points, [](const auto& p) { return p.weight <= 0; });
    }
  }
  if (detected) {
    const float dt = float(std::clamp(gap, 0.0, longest_gap));
    auto pull = [&](float seconds) { return 1 - std::exp(-dt / seconds); };
    // The detector's box is right on the whole: far from it the flow has slid off the head.
    const float expected = face.box.width / face_box_metres;
    const vec2 middle{face.box.center_x(), face.box.center_y() + center_in_box * face.box.height};
    if (glm::length(middle - m.center) > 0.4f * face.box.width || m.scale > 1.4f * expected ||
        m.scale < expected / 1.4f) {
      m.points.clear();
      m.place(face);
    }
    vec3 angles = m.angles();
    if (face.eyes) {
      vec2 d = (*face.eyes)[1] - (*face.eyes)[0];
      angles.z += pull(pull_roll) * (std::atan2(-d.y, d.x) - angles.z);
    }
    if (face.view == FaceView::frontal) {
      angles.y += pull(pull_pitch) * (rest - angles.y);
      if (auto yaw = yaw_of_midline(frame, face)) angles.x += pull(pull_yaw) * (*yaw - angles.x);
    } else {
      float side = face.view == FaceView::image_left ? profile_yaw : -profile_yaw;
      if (side * angles.x < side * side) angles.x += pull(pull_profile) * (side - angles.x);
    }
    angles.x = glm::clamp(angles.x, -1.4f, 1.4f);
    angles.y = glm::clamp(angles.y, -1.f, 1.f);
    m.set_angles(angles);
  }
  if (int(m.points.size()) < wanted_points) m.seed(frame, face);
  return axes * m.rotation * axes;
}

std::optional<float> yaw_of_midline(const GrayFrame& frame, const Face& face) {
  if (!face.eyes || face.view != FaceView::frontal) return {};
  const vec2 left = (*face.eyes)[0], right = (*face.eyes)[1];
  const float apart = glm::length(right - left);
  if (!(apart > 8)) return {};
  // The strip from below the eyes to the lips, turned upright, 24 pixels between the eyes. What
  // lies across it, nostrils and lips, is as symmetric in side light as in front light; the sides
  // of the nose are less so and count less.
  constexpr int eyes_apart = 24, width = 49, height = 27, half = 13;
  constexpr float side = 0.6f;  // what a vertical edge counts against a horizontal one
  const vec2 u = (right - left) / apart, v{-u.y, u.x}, middle = (left + right) * 0.5f;
  const float step = apart / eyes_apart;
  const vec2 origin = middle + v * (0.1f * apart) - u * (step * (width / 2));
  cv::Mat map = (cv::Mat_<double>(2, 3) << u.x * step, v.x * step, origin.x, u.y * step, v.y * step,
                 origin.y);
  cv::Mat whole = view_of(frame, {0, 0, frame.width, frame.height}), strip, across, along;
  cv::warpAffine(whole, strip, map, {width, height}, cv::INTER_AREA | cv::WARP_INVERSE_MAP,
                 cv::BORDER_REPLICATE);
  cv::GaussianBlur(strip, strip, {3, 3}, 0);
  cv::Sobel(strip, across, CV_32F, 0, 1);
  cv::Sobel(strip, along, CV_32F, 1, 0);
  float score[width] = {};  // of each axis: correlation of the edges on both sides
  int best = -1;
  for (int axis = half; axis < width - half; axis++) {
    double lr = 0, ll = 1, rr = 1;
    for (int y = 0; y < height; y++)
      for (int k = 1; k <= half; k++) {
        double l = across.at<float>(y, axis - k), r = across.at<float>(y, axis + k);
        lr += l * r, ll += l * l, rr += r * r;
        l = side * along.at<float>(y, axis - k), r = -side * along.at<float>(y, axis + k);
        lr += l * r, ll += l * l, rr += r * r;
      }
    score[axis] = float(2 * lr / (ll + rr));
    if (best < 0 || score[axis] > score[best]) best = axis;
  }
  if (best <= half || best >= width - half - 1 || score[best] < 0.5f) return {};
  float bend = score[best - 1] - 2 * score[best] + score[best + 1];
  float sub = bend < 0 ? 0.5f * (score[best - 1] - score[best + 1]) / bend : 0;
  float shift =
      (float(best) + sub - width / 2) / eyes_apart;  // image right positive, in eye distances
  return glm::clamp(std::atan(-shift / axis_depth), -0.5f, 0.5f);
}

}  // namespace wellspring
