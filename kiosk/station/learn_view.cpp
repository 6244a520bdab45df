// SPDX-License-Identifier: Apache-2.0
#include "kiosk/station/learn_view.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <random>

#include "kiosk/station/sight.h"

namespace wellspring::kiosk {
namespace {

constexpr int view_side = 320;      // pixels of the longer side
constexpr int view_features = 220;  // most that are kept
constexpr int candidates = 1200;
constexpr int cells_across = 8, most_in_cell = 7;
constexpr int tries = 14;  // views under which features must be found again
constexpr int frame_width = 640, frame_height = 480;

cv::Mat picture_of(const Photo& photo) {
  return {photo.height, photo.width, CV_8UC3, const_cast<uint8_t*>(photo.bgr.data())};
}

// Draws a view as a camera may see it. Returns the homography.
cv::Mat draw_view(const cv::Mat& gray, std::mt19937& random, cv::Mat& to) {
  auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const double w = gray.cols, h = gray.rows, size = uniform(0.35, 0.95) * frame_height;
  const double scale = size / std::max(w, h), focal = 550;
  const cv::Vec3d turn(uniform(-0.6, 0.6), uniform(-0.6, 0.6), uniform(-CV_PI, CV_PI));
  // The roll comes first, then the tilt.
  cv::Matx33d roll, tilt;
  cv::Rodrigues(cv::Vec3d(0, 0, turn[2]), roll);
  cv::Rodrigues(cv::Vec3d(turn[0], turn[1], 0), tilt);
  const cv::Matx33d r = tilt * roll;
  std::vector<cv::Point2f> from, seen;
  for (const cv::Point2d p : {cv::Point2d(0, 0), {w, 0}, {w, h}, {0, h}}) {
    const cv::Vec3d at = r * cv::Vec3d((p.x - w / 2) * scale, (p.y - h / 2) * scale, 0);
    const double z = focal + at[2];
    from.emplace_back(float(p.x), float(p.y));
    seen.emplace_back(float(focal * at[0] / z + frame_width / 2.0),
                      float(focal * at[1] / z + frame_height / 2.0));
  }
  const cv::Mat pose = cv::getPerspectiveTransform(from, seen);
  to = cv::Mat(frame_height, frame_width, CV_8U, cv::Scalar(uniform(60, 190)));
  cv::warpPerspective(gray, to, pose, to.size(), cv::INTER_AREA, cv::BORDER_TRANSPARENT);
  const double blur = uniform(0.3, 1.4);
  cv::GaussianBlur(to, to, {0, 0}, blur);
  cv::Mat noise(to.size(), CV_16S), wide;
  cv::RNG noise_random(random());
  noise_random.fill(noise, cv::RNG::NORMAL, 0, uniform(1, 5));
  to.convertTo(wide, CV_16S, uniform(0.6, 1.3), uniform(-15, 15));
  wide += noise;
  wide.convertTo(to, CV_8U);
  return pose;
}

// Counts under how many views each feature is found again.
std::vector<int> count_found(const cv::Mat& gray, const std::vector<Feature>& features) {
  std::vector<int> found(features.size(), 0);
  std::mt19937 random(7);  // the same file gives the same tree
  cv::Mat frame;
  for (int i = 0; i < tries; i++) {
    const cv::Mat pose = draw_view(gray, random, frame);
    const auto seen = find_features(frame.cols, frame.rows, frame.data, 600);
    std::vector<cv::Point2f> from, to;
    for (const Feature& one : features) from.emplace_back(one.place.x, one.place.y);
    if (from.empty()) break;
    cv::perspectiveTransform(from, to, pose);
    for (size_t k = 0; k < features.size(); k++)
      found[k] += std::ranges::any_of(seen, [&](const Feature& other) {
        return std::abs(other.place.x - to[k].x) < 4 && std::abs(other.place.y - to[k].y) < 4 &&
               bits_apart(other.bits, features[k].bits) <= 60;
      });
  }
  return found;
}

}  // namespace

std::vector<uint8_t> shrink_photo(const Photo& photo, int width, int height) {
  cv::Mat out;
  cv::resize(picture_of(photo), out, {width, height}, 0, 0,
             width < photo.width ? cv::INTER_AREA : cv::INTER_CUBIC);
  return {out.data, out.data + size_t(width) * size_t(height) * 3};
}

View learn_view(const Photo& photo, vec2 size) {
  View view;
  view.side = photo.side;
  view.size = size;
  const float scale = float(view_side) / float(std::max(photo.width, photo.height));
  view.width = std::max(16, int(std::lround(float(photo.width) * scale)));
  view.height = std::max(16, int(std::lround(float(photo.height) * scale)));
  auto bgr = shrink_photo(photo, view.width, view.height);
  const cv::Mat color(view.height, view.width, CV_8UC3, bgr.data());
  const cv::Scalar mean = cv::mean(color);
  view.mean = vec3(mean[0], mean[1], mean[2]);
  cv::Mat gray, half;
  cv::cvtColor(color, gray, cv::COLOR_BGR2GRAY);
  cv::resize(gray, half, {view.gray_width(), view.gray_height()}, 0, 0, cv::INTER_AREA);
  view.gray.assign(half.data, half.data + half.total());

  // A border of the mean lets corners near the edge be found, as they are before a background.
  constexpr int border = 20;
  cv::Mat wide;
  cv::copyMakeBorder(gray, wide, border, border, border, border, cv::BORDER_CONSTANT,
                     cv::mean(gray));
  std::vector<Feature> features;
  for (Feature one : find_features(wide.cols, wide.rows, wide.data, candidates)) {
    one.place -= vec2(border);
    if (one.place.x >= 3 && one.place.y >= 3 && one.place.x < float(view.width - 3) &&
        one.place.y < float(view.height - 3))
      features.push_back(one);
  }
  const auto found = count_found(gray, features);
  std::vector<size_t> order(features.size());
  for (size_t i = 0; i < order.size(); i++) order[i] = i;
  std::ranges::stable_sort(order, [&](size_t a, size_t b) { return found[a] > found[b]; });
  // They are spread over the view, since a pose that fits one corner of it fits no other.
  std::map<std::pair<int, int>, int> in_cell;
  for (const size_t i : order) {
    const vec2 at = features[i].place * float(cells_across) / float(view_side);
    int& count = in_cell[{int(at.x), int(at.y)}];
    if (found[i] < 2 || count >= most_in_cell || view.features.size() >= size_t(view_features))
      continue;
    count++;
    view.features.push_back(features[i]);
  }
  return view;
}

}  // namespace wellspring::kiosk
