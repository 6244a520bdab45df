// SPDX-License-Identifier: Apache-2.0
// Makes objects that a visitor may hold, photographs of them, and a camera's pictures of them.
// Everything follows from seeds.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <random>
#include <string>

#include "kiosk/frame/head.h"
#include "kiosk/station/learn.h"

namespace wellspring::test {

inline constexpr int made_width = 640, made_height = 480;
inline constexpr float made_focal = 554.26f;  // pixels; 60 degrees across

struct MadeRandom {
  std::mt19937 engine;
  explicit MadeRandom(unsigned seed) : engine(seed * 7919 + 13) {}
  double real(double low, double high) {
    return low + (high - low) * double(engine()) / 4294967296.0;
  }
  int whole(int low, int high) { return int(real(low, high + 1)); }
  cv::Scalar color() { return {real(20, 235), real(20, 235), real(20, 235)}; }
};

// Draws shapes and letters, as on a card, a tile or a coin.
inline cv::Mat make_face(unsigned seed, int width = 400, int height = 300) {
  MadeRandom random(seed);
  cv::Mat out(height, width, CV_8UC3, random.color());
  const int shapes = random.whole(34, 50);
  for (int i = 0; i < shapes; i++) {
    const cv::Point at(random.whole(0, width), random.whole(0, height));
    const int size = random.whole(8, 60);
    const cv::Scalar color = random.color();
    switch (random.whole(0, 3)) {
      case 0: cv::circle(out, at, size / 2, color, random.whole(0, 1) ? -1 : 3, cv::LINE_AA); break;
      case 1: cv::rectangle(out, {at.x, at.y, size, size * 2 / 3}, color, -1); break;
      case 2:
        cv::line(out, at, {at.x + random.whole(-80, 80), at.y + random.whole(-80, 80)}, color,
                 random.whole(2, 6), cv::LINE_AA);
        break;
      default: {
        std::string text;
        for (int k = random.whole(2, 6); k > 0; k--) text += char('A' + random.whole(0, 25));
        cv::putText(out, text, at, random.whole(0, 3), random.real(0.6, 1.6), color, 2,
                    cv::LINE_AA);
      }
    }
  }
  return out;
}

// Draws an emblem into a face: what twins differ in.
inline void draw_emblem(cv::Mat& face, unsigned seed, cv::Point at, int size = 64) {
  MadeRandom random(seed + 1000);
  cv::Mat part = face(cv::Rect(at.x, at.y, size, size));
  part.setTo(cv::Scalar(200, 205, 210));
  for (int i = 0; i < 4; i++)
    cv::line(part, {random.whole(4, size - 4), random.whole(4, size - 4)},
             {random.whole(4, size - 4), random.whole(4, size - 4)}, {30, 30, 40}, 5, cv::LINE_AA);
  std::string letter(1, char('A' + seed % 26));
  cv::putText(part, letter, {size / 4, size * 3 / 4}, 0, 1.6, {20, 20, 90}, 4, cv::LINE_AA);
}

inline kiosk::Photo to_photo(const cv::Mat& face, const std::string& side) {
  kiosk::Photo photo{"", side, face.cols, face.rows, {}};
  photo.bgr.assign(face.data, face.data + face.total() * 3);
  return photo;
}

// Says how an object is held.
struct Held {
  float x = 320, y = 240;  // middle, pixels
  float size = 260;        // pixels of the longer side
  float roll = 0;          // radians
  float tilt_x = 0, tilt_y = 0;
};

// Draws a room without an object.
inline cv::Mat make_room(unsigned seed) {
  MadeRandom random(seed + 500);
  cv::Mat out(made_height, made_width, CV_8UC3, cv::Scalar(120, 130, 140));
  for (int i = 0; i < 25; i++) {
    const cv::Point at(random.whole(-40, made_width), random.whole(-40, made_height));
    cv::rectangle(out, {at.x, at.y, random.whole(20, 180), random.whole(20, 160)}, random.color(),
                  random.whole(0, 1) ? -1 : 2);
    if (i % 5 == 0)
      cv::putText(out, "EXIT 12", at, 0, random.real(0.5, 1.2), random.color(), 2, cv::LINE_AA);
  }
  cv::ellipse(out, {random.whole(150, 490), 150}, {60, 80}, 0, 0, 360, {140, 165, 210}, -1);
  cv::GaussianBlur(out, out, {0, 0}, 1.5);
  return out;
}

// Puts a face into a picture. Returns its corners, clockwise from its upper left one.
inline std::array<vec2, 4> put_face(cv::Mat& picture, const cv::Mat& face, const Held& held) {
  const double w = face.cols, h = face.rows, scale = double(held.size) / std::max(w, h);
  cv::Matx33d roll, tilt;
  cv::Rodrigues(cv::Vec3d(0, 0, double(held.roll)), roll);
  cv::Rodrigues(cv::Vec3d(double(held.tilt_x), double(held.tilt_y), 0), tilt);
  const cv::Matx33d turn = tilt * roll;
  const double focal = double(made_focal);
  std::vector<cv::Point2f> from, to;
  std::array<vec2, 4> corners;
  for (const cv::Point2d p : {cv::Point2d(0, 0), {w, 0}, {w, h}, {0, h}}) {
    const cv::Vec3d at = turn * cv::Vec3d((p.x - w / 2) * scale, (p.y - h / 2) * scale, 0);
    // The middle lies on its ray at the depth at which a pixel of the picture is one unit.
    const double x = double(held.x) - made_width / 2.0, y = double(held.y) - made_height / 2.0;
    const double z = focal + at[2];
    from.emplace_back(float(p.x), float(p.y));
    to.emplace_back(float(focal * (x + at[0]) / z + made_width / 2.0),
                    float(focal * (y + at[1]) / z + made_height / 2.0));
    corners[to.size() - 1] = vec2(to.back().x, to.back().y);
  }
  cv::warpPerspective(face, picture, cv::getPerspectiveTransform(from, to), picture.size(),
                      cv::INTER_AREA, cv::BORDER_TRANSPARENT);
  return corners;
}

// Draws fingers over the lower edge of what is held.
inline void put_fingers(cv::Mat& picture, const Held& held) {
  for (int i = 0; i < 3; i++)
    cv::ellipse(picture,
                cv::Point(int(held.x - 0.2f * held.size + 0.2f * held.size * float(i)),
                          int(held.y + 0.42f * held.size)),
                {int(0.07f * held.size), int(0.16f * held.size)}, 0, 0, 360, {130, 160, 215}, -1,
                cv::LINE_AA);
}

// Draws a box of that size whose middle and axes (right, down, away; in the camera's frame) are
// these, each face in one colour.
inline void put_box(cv::Mat& picture, vec3 middle, const mat3& axes, vec3 size, unsigned seed) {
  MadeRandom random(seed + 300);
  const double hue = random.real(60, 200);
  for (int axis = 0; axis < 3; axis++)
    for (const float side : {-1.f, 1.f}) {
      const cv::Scalar color = cv::Scalar(0.8, 0.9, 1) * (hue - 25 * axis + 4 * double(side));
      const vec3 normal = axes[axis] * side, at = middle + normal * (0.5f * size[axis]);
      if (glm::dot(normal, at) >= 0) continue;  // it looks away
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      std::vector<cv::Point> corners;
      constexpr float finer = 16;  // parts of a pixel
      for (const auto& [a, b] :
           {std::pair(-1, -1), std::pair(1, -1), std::pair(1, 1), std::pair(-1, 1)}) {
        const vec3 p =
            at + axes[u] * (0.5f * float(a) * size[u]) + axes[v] * (0.5f * float(b) * size[v]);
        corners.emplace_back(int(finer * (p.x / p.z * made_focal + made_width / 2.f)),
                             int(finer * (p.y / p.z * made_focal + made_height / 2.f)));
      }
      cv::fillConvexPoly(picture, corners, color, cv::LINE_AA, 4);
    }
}
// How a box may be held: three faces are seen.
inline mat3 random_axes(unsigned seed) {
  MadeRandom random(seed + 40);
  const auto about = [](double angle, vec3 axis) {
    return mat3(glm::rotate(mat4(1), float(angle), axis));
  };
  const double aside = random.real(0.35, 1.1) * (random.whole(0, 1) ? 1 : -1);
  return about(random.real(-0.3, 0.3), {0, 0, 1}) * about(random.real(0.3, 0.8), {1, 0, 0}) *
         about(aside, {0, 1, 0});
}

// Makes the picture what a camera gives.
inline GrayFrame to_frame(const cv::Mat& picture, double time, double blur = 0.7, double noise = 4,
                          unsigned seed = 1, double gain = 1) {
  cv::Mat out, wide;
  cv::GaussianBlur(picture, out, {0, 0}, blur);
  out.convertTo(wide, CV_16SC3, gain);
  cv::Mat grain(wide.size(), CV_16SC3);
  cv::RNG random(seed + 1);
  random.fill(grain, cv::RNG::NORMAL, 0, noise);
  wide += grain;
  wide.convertTo(out, CV_8UC3);
  GrayFrame frame;
  frame.time = time;
  frame.width = out.cols, frame.height = out.rows;
  cv::Mat gray, small;
  cv::cvtColor(out, gray, cv::COLOR_BGR2GRAY);
  frame.pixels.assign(gray.data, gray.data + gray.total());
  frame.color_width = 320, frame.color_height = out.rows * 320 / out.cols;
  cv::resize(out, small, {frame.color_width, frame.color_height}, 0, 0, cv::INTER_AREA);
  frame.bgr.assign(small.data, small.data + small.total() * 3);
  return frame;
}

inline Held random_held(unsigned seed) {
  MadeRandom random(seed + 77);
  Held held;
  held.size = float(random.real(190, 380));
  held.x = float(random.real(240, 400));
  held.y = float(random.real(200, 280));
  held.roll = float(random.real(-0.6, 0.6));
  held.tilt_x = float(random.real(-0.45, 0.45));
  held.tilt_y = float(random.real(-0.45, 0.45));
  return held;
}

inline kiosk::LearnObject make_object(const std::string& id,
                                      const std::vector<std::pair<cv::Mat, std::string>>& sides) {
  kiosk::LearnObject object;
  object.id = id;
  object.title["en"] = "The " + id;
  for (const auto& [face, side] : sides) object.photos.push_back(to_photo(face, side));
  return object;
}

}  // namespace wellspring::test
