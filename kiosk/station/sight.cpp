// SPDX-License-Identifier: Apache-2.0
#include "kiosk/station/sight.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <opencv2/calib3d.hpp>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

namespace wellspring::kiosk {
namespace {

constexpr int picture_features = 800;
constexpr int most_bits = 64;    // bits that a feature may differ in from one picture to another
constexpr float clearly = 0.8f;  // share of the second nearest feature's distance
constexpr float plain = 5;       // standard deviation below which a part has no texture
constexpr int parts_across = 6;  // a view is compared in 6 by 6 parts
constexpr float alike = 0.55f;   // correlation of a part that is the same
constexpr float still_there = 0.4f;  // share of parts that is enough while one follows

cv::Mat gray_of(const Sight& sight) {
  const GrayFrame& frame = *sight.frame;
  return {frame.height, frame.width, CV_8U, const_cast<uint8_t*>(frame.pixels.data())};
}

cv::Matx33d to_cv(const mat3& m) {
  return {m[0].x, m[1].x, m[2].x, m[0].y, m[1].y, m[2].y, m[0].z, m[1].z, m[2].z};
}

mat3 from_cv(const cv::Mat& h) {
  mat3 out;
  for (int row = 0; row < 3; row++)
    for (int column = 0; column < 3; column++) out[column][row] = float(h.at<double>(row, column));
  return out;
}

// Returns what takes a patch's pixels to a view's, pixel centres to pixel centres.
mat3 patch_to_view(const Box& part, float scale) {
  return {vec3(1 / scale, 0, 0), vec3(0, 1 / scale, 0), vec3(part.x, part.y, 1)};
}

Patch take(const cv::Mat& picture, const mat3& to_picture, const Box& part, float scale) {
  Patch out;
  out.width = std::max(1, int(std::lround(part.width * scale)));
  out.height = std::max(1, int(std::lround(part.height * scale)));
  const int channels = picture.channels();
  out.pixels.resize(size_t(out.width) * size_t(out.height) * size_t(channels));
  cv::Mat to(out.height, out.width, picture.type(), out.pixels.data());
  cv::warpPerspective(picture, to, to_cv(to_picture), to.size(),
                      cv::INTER_LINEAR | cv::WARP_INVERSE_MAP, cv::BORDER_REPLICATE);
  int inside = 0;
  for (int y = 0; y < 4; y++)
    for (int x = 0; x < 4; x++) {
      const vec2 at = project_by(to_picture, {(float(x) + 0.5f) * float(out.width) / 4,
                                              (float(y) + 0.5f) * float(out.height) / 4});
      inside += at.x >= 0 && at.y >= 0 && at.x < float(picture.cols) && at.y < float(picture.rows);
    }
  out.inside = float(inside) / 16;
  return out;
}

}  // namespace

void look_at(Sight& sight, const GrayFrame& frame, float focal) {
  sight.frame = &frame;
  sight.focal = focal;
  sight.number++;
  sight.has_features = false;
  sight.features.clear();
}

std::vector<Feature> find_features(int width, int height, const uint8_t* gray, int most) {
  const cv::Mat picture(height, width, CV_8U, const_cast<uint8_t*>(gray));
  constexpr int edge = 15, patch = 31, threshold = 10, levels = 8;
  const auto orb =
      cv::ORB::create(most, 1.2f, levels, edge, 0, 2, cv::ORB::HARRIS_SCORE, patch, threshold);
  std::vector<cv::KeyPoint> points;
  cv::Mat bits;
  orb->detectAndCompute(picture, cv::noArray(), points, bits);
  std::vector<Feature> out(points.size());
  for (size_t i = 0; i < points.size(); i++) {
    out[i].place = {points[i].pt.x, points[i].pt.y};
    std::memcpy(out[i].bits.data(), bits.ptr(int(i)), sizeof(Descriptor));
  }
  return out;
}

const std::vector<Feature>& features_of(Sight& sight) {
  if (!std::exchange(sight.has_features, true)) {
    const GrayFrame& frame = *sight.frame;
    sight.features =
        find_features(frame.width, frame.height, frame.pixels.data(), picture_features);
  }
  return sight.features;
}

int bits_apart(const Descriptor& a, const Descriptor& b) {
  return std::popcount(a[0] ^ b[0]) + std::popcount(a[1] ^ b[1]) + std::popcount(a[2] ^ b[2]) +
         std::popcount(a[3] ^ b[3]);
}

std::vector<std::pair<int, int>> pair_features(std::span<const Feature> from,
                                               std::span<const Feature> to) {
  struct Taken {
    int from = -1, apart = 257;
  };
  std::vector<Taken> taken(to.size());
  for (size_t i = 0; i < from.size(); i++) {
    int best = -1, apart = 257, second = 257;
    for (size_t k = 0; k < to.size(); k++) {
      const int now = bits_apart(from[i].bits, to[k].bits);
      if (now >= second) continue;
      // The same corner is often found at several sizes; those do not compete.
      const bool same = best >= 0 && glm::distance(to[k].place, to[size_t(best)].place) < 6;
      if (now < apart) {
        if (!same) second = apart;
        apart = now, best = int(k);
      } else if (!same) {
        second = now;
      }
    }
    if (best < 0 || apart > most_bits || float(apart) >= clearly * float(second)) continue;
    if (apart < taken[size_t(best)].apart) taken[size_t(best)] = {int(i), apart};
  }
  std::vector<std::pair<int, int>> out;
  for (size_t k = 0; k < to.size(); k++)
    if (taken[k].from >= 0) out.emplace_back(taken[k].from, int(k));
  return out;
}

std::optional<FoundPose> fit_pose(std::span<const vec2> from, std::span<const vec2> to,
                                  float apart) {
  constexpr size_t least = 8;
  if (from.size() < least) return {};
  std::vector<cv::Point2f> a, b;
  for (const vec2& p : from) a.emplace_back(p.x, p.y);
  for (const vec2& p : to) b.emplace_back(p.x, p.y);
  std::vector<uint8_t> fits;
  const cv::Mat h = cv::findHomography(a, b, cv::RANSAC, double(apart), fits, 1000, 0.995);
  if (h.empty()) return {};
  FoundPose out{from_cv(h), int(std::count(fits.begin(), fits.end(), 1))};
  if (size_t(out.inliers) < least) return {};
  for (int column = 0; column < 3; column++)
    if (!is_finite(out.pose[column])) return {};
  return out;
}

vec2 project_by(const mat3& pose, vec2 place) {
  const vec3 at = pose * vec3(place, 1);
  return vec2(at) / at.z;
}

std::array<vec2, 4> corners_of(const mat3& pose, const View& view) {
  const float w = float(view.width), h = float(view.height);
  return {project_by(pose, {0, 0}), project_by(pose, {w, 0}), project_by(pose, {w, h}),
          project_by(pose, {0, h})};
}

float area_of(const std::array<vec2, 4>& c) {
  float sum = 0;
  for (size_t i = 0; i < 4; i++) {
    const vec2 a = c[i], b = c[(i + 1) % 4];
    sum += a.x * b.y - b.x * a.y;
  }
  return sum / 2;
}

bool is_sound(const mat3& pose, const View& view, int width, int height) {
  const float w = float(view.width), h = float(view.height);
  for (const vec2 corner : {vec2(0, 0), vec2(w, 0), vec2(w, h), vec2(0, h)})
    if (!((pose * vec3(corner, 1)).z > 0) != !((pose * vec3(w / 2, h / 2, 1)).z > 0)) return false;
  const auto c = corners_of(pose, view);
  for (size_t i = 0; i < 4; i++) {
    if (!std::isfinite(c[i].x) || !std::isfinite(c[i].y)) return false;
    const vec2 a = c[(i + 1) % 4] - c[i], b = c[(i + 2) % 4] - c[(i + 1) % 4];
    if (!(a.x * b.y - a.y * b.x > 0)) return false;  // turns the same way as the view
    const vec2 across = c[(i + 3) % 4] - c[(i + 2) % 4];
    const float ratio = glm::length(a) / std::max(glm::length(across), 1e-3f);
    if (!(ratio > 0.3f && ratio < 3.3f)) return false;
  }
  const float area = area_of(c), all = float(width) * float(height);
  if (!(area > 0.004f * all && area < 2 * all)) return false;
  // Both sides are seen by at least a fifth of what the other would make one expect.
  const float across = (glm::length(c[1] - c[0]) + glm::length(c[2] - c[3])) / w;
  const float down = (glm::length(c[3] - c[0]) + glm::length(c[2] - c[1])) / h;
  return across > 0.2f * down && down > 0.2f * across;
}

Patch take_gray(const Sight& sight, const mat3& pose, const Box& part, float scale) {
  return take(gray_of(sight), pose * patch_to_view(part, scale), part, scale);
}

Patch take_color(const Sight& sight, const mat3& pose, const Box& part, float scale) {
  const GrayFrame& frame = *sight.frame;
  if (frame.bgr.empty() || frame.color_width < 1) return {};
  const cv::Mat color(frame.color_height, frame.color_width, CV_8UC3,
                      const_cast<uint8_t*>(frame.bgr.data()));
  const float smaller = float(frame.color_width) / float(frame.width);
  const mat3 shrink(vec3(smaller, 0, 0), vec3(0, smaller, 0), vec3(0, 0, 1));
  return take(color, shrink * pose * patch_to_view(part, scale), part, scale);
}

float correlate(int width, int height, const uint8_t* a, int a_stride, const uint8_t* b,
                int b_stride) {
  double sa = 0, sb = 0, aa = 0, bb = 0, ab = 0;
  for (int y = 0; y < height; y++)
    for (int x = 0; x < width; x++) {
      const double p = a[y * a_stride + x], q = b[y * b_stride + x];
      sa += p, sb += q, aa += p * p, bb += q * q, ab += p * q;
    }
  const double n = double(width) * height;
  const double va = aa / n - sa * sa / (n * n), vb = bb / n - sb * sb / (n * n);
  const bool plain_a = va < plain * plain, plain_b = vb < plain * plain;
  if (plain_a || plain_b) return plain_a && plain_b ? 1.f : 0.f;
  return float((ab / n - sa * sb / (n * n)) / std::sqrt(va * vb));
}

namespace {

// Compares a view with a picture of it, part by part.
float agree(const View& view, const uint8_t* seen) {
  const int width = view.gray_width(), height = view.gray_height();
  int count = 0, same = 0;
  for (int row = 0; row < parts_across; row++)
    for (int column = 0; column < parts_across; column++) {
      const int x = column * width / parts_across, y = row * height / parts_across;
      const int w = width / parts_across, h = height / parts_across;
      const uint8_t* own = view.gray.data() + y * width + x;
      if (w < 2 || h < 2) continue;
      double sum = 0, square = 0;
      for (int i = 0; i < w * h; i++) {
        const double v = own[i / w * width + i % w];
        sum += v, square += v * v;
      }
      const double n = w * h;
      if (square / n - sum * sum / (n * n) < double(2 * plain) * double(2 * plain)) continue;
      count++;
      same += correlate(w, h, own, width, seen + y * width + x, width) > alike;
    }
  return count ? float(same) / float(count) : 0.f;
}

}  // namespace

float agreement(const Sight& sight, const View& view, const mat3& pose) {
  if (view.gray.empty()) return 0;
  const Box whole{0, 0, float(2 * view.gray_width()), float(2 * view.gray_height())};
  const Patch seen = take_gray(sight, pose, whole, 0.5f);
  return agree(view, seen.pixels.data());
}

std::optional<mat3> follow_pose(const Sight& sight, const View& view, const mat3& before) {
  if (view.gray.empty()) return {};
  const int width = view.gray_width(), height = view.gray_height();
  const Box whole{0, 0, float(2 * width), float(2 * height)};
  const Patch seen = take_gray(sight, before, whole, 0.5f);
  if (seen.inside < 0.4f) return {};
  const cv::Mat own(height, width, CV_8U, const_cast<uint8_t*>(view.gray.data()));
  cv::Mat own_even, seen_even;
  cv::equalizeHist(own, own_even);
  cv::equalizeHist(cv::Mat(height, width, CV_8U, const_cast<uint8_t*>(seen.pixels.data())),
                   seen_even);
  std::vector<cv::Point2f> from, to;
  cv::goodFeaturesToTrack(own_even, from, 90, 0.005, 8);
  if (from.size() < 8) return {};
  std::vector<uint8_t> found;
  cv::calcOpticalFlowPyrLK(own_even, seen_even, from, to, found, cv::noArray(), {15, 15}, 3);
  std::vector<vec2> a, b;
  for (size_t i = 0; i < from.size(); i++)
    if (found[i]) a.emplace_back(from[i].x, from[i].y), b.emplace_back(to[i].x, to[i].y);
  const auto moved = fit_pose(a, b, 1.5f);
  if (!moved || float(moved->inliers) < 0.3f * float(from.size())) return {};
  // Halves to views and back.
  const mat3 twice(vec3(2, 0, 0), vec3(0, 2, 0), vec3(0, 0, 1));
  const mat3 half(vec3(0.5f, 0, 0), vec3(0, 0.5f, 0), vec3(0, 0, 1));
  mat3 pose = before * twice * moved->pose * half;
  if (pose[2].z != 0) pose /= pose[2].z;
  if (!is_sound(pose, view, sight.frame->width, sight.frame->height)) return {};
  if (agreement(sight, view, pose) < still_there) return {};
  return pose;
}

}  // namespace wellspring::kiosk
