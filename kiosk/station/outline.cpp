// SPDX-License-Identifier: Apache-2.0
#include "kiosk/station/outline.h"

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "kiosk/station/pattern.h"

namespace wellspring::kiosk {
namespace {

constexpr float most_error = 0.012f;  // mean error of corners over the mean side
constexpr size_t most_quads = 24;

using Quad = std::array<vec2, 4>;

vec2 meet(const cv::Vec4f& a, const cv::Vec4f& b) {
  const vec2 p(a[2], a[3]), q(b[2], b[3]), u(a[0], a[1]), v(b[0], b[1]);
  const float turn = u.x * v.y - u.y * v.x;
  if (std::abs(turn) < 1e-3f) return p;
  const vec2 to = q - p;
  return p + u * ((to.x * v.y - to.y * v.x) / turn);
}

// Fits lines to the contour between corners; their crossings are the corners, finer than pixels.
// False: an edge is not straight.
bool refine(const std::vector<cv::Point>& contour, Quad& quad) {
  std::vector<cv::Point2f> sides[4];
  for (const cv::Point& point : contour) {
    const vec2 p(point.x, point.y);
    for (size_t i = 0; i < 4; i++) {
      const vec2 a = quad[i], along = quad[(i + 1) % 4] - a;
      const float length = glm::length(along), at = glm::dot(p - a, along) / length;
      const float off = std::abs(along.x * (p.y - a.y) - along.y * (p.x - a.x)) / length;
      if (at > 0.12f * length && at < 0.88f * length && off < 4) sides[i].emplace_back(p.x, p.y);
    }
  }
  cv::Vec4f lines[4];
  for (size_t i = 0; i < 4; i++) {
    const float length = glm::distance(quad[i], quad[(i + 1) % 4]);
    if (float(sides[i].size()) < 0.5f * length || sides[i].size() < 8) return false;
    cv::fitLine(sides[i], lines[i], cv::DIST_HUBER, 0, 0.01, 0.01);
    double off = 0;
    for (const cv::Point2f& p : sides[i])
      off += std::abs(lines[i][0] * (p.y - lines[i][3]) - lines[i][1] * (p.x - lines[i][2]));
    if (off / double(sides[i].size()) > 0.9) return false;
  }
  for (size_t i = 0; i < 4; i++) quad[i] = meet(lines[(i + 3) % 4], lines[i]);
  return true;
}

float mean_side(const Quad& quad) {
  float sum = 0;
  for (size_t i = 0; i < 4; i++) sum += glm::distance(quad[i], quad[(i + 1) % 4]);
  return sum / 4;
}

}  // namespace

std::optional<SpacePose> solve_rectangle(const Quad& corners, vec2 size, float focal, int width,
                                         int height) {
  const float w = size.x / 2, h = size.y / 2;
  const std::vector<cv::Point3f> model{{-w, -h, 0}, {w, -h, 0}, {w, h, 0}, {-w, h, 0}};
  std::vector<cv::Point2f> seen;
  for (const vec2& corner : corners) seen.emplace_back(corner.x, corner.y);
  const cv::Matx33d camera(focal, 0, width / 2.0, 0, focal, height / 2.0, 0, 0, 1);
  cv::Vec3d turn, place;
  try {
    if (!cv::solvePnP(model, seen, camera, cv::noArray(), turn, place, false, cv::SOLVEPNP_IPPE))
      return {};
  } catch (const cv::Exception&) {
    return {};
  }
  cv::solvePnPRefineLM(model, seen, camera, cv::noArray(), turn, place);
  if (!(place[2] > 0)) return {};
  cv::Matx33d rotation;
  cv::Rodrigues(turn, rotation);
  std::vector<cv::Point2f> again;
  cv::projectPoints(model, turn, place, camera, cv::noArray(), again);
  SpacePose out;
  for (size_t i = 0; i < 4; i++) out.error += float(cv::norm(again[i] - seen[i])) / 4;
  out.position = vec3(place[0], place[1], place[2]);
  for (int row = 0; row < 3; row++)
    for (int column = 0; column < 3; column++)
      out.rotation[column][row] = float(rotation(row, column));
  if (!is_finite(out.position) || !std::isfinite(out.error)) return {};
  return out;
}

std::vector<Quad> find_quads(const GrayFrame& frame) {
  const cv::Mat gray(frame.height, frame.width, CV_8U, const_cast<uint8_t*>(frame.pixels.data()));
  cv::Mat smooth, edges;
  cv::GaussianBlur(gray, smooth, {5, 5}, 1.2);
  cv::Canny(smooth, edges, 15, 45);
  // Edges between colours of one brightness are those of the smaller picture in colour.
  if (!frame.bgr.empty()) {
    const cv::Mat color(frame.color_height, frame.color_width, CV_8UC3,
                        const_cast<uint8_t*>(frame.bgr.data()));
    cv::Mat large, channel, more;
    cv::resize(color, large, gray.size(), 0, 0, cv::INTER_CUBIC);
    for (int i = 0; i < 3; i++) {
      cv::extractChannel(large, channel, i);
      cv::GaussianBlur(channel, channel, {5, 5}, 1.2);
      cv::Canny(channel, more, 25, 75);
      edges |= more;
    }
  }
  cv::dilate(edges, edges, cv::Mat());
  std::vector<std::vector<cv::Point>> contours;
  cv::findContours(edges, contours, cv::RETR_LIST, cv::CHAIN_APPROX_NONE);
  std::vector<std::pair<double, Quad>> found;
  const double least = 0.01 * frame.width * frame.height;
  for (const auto& contour : contours) {
    if (contour.size() < 80 || cv::contourArea(contour) < least) continue;
    std::vector<cv::Point> shape;
    cv::approxPolyDP(contour, shape, 0.03 * cv::arcLength(contour, true), true);
    if (shape.size() != 4 || !cv::isContourConvex(shape)) continue;
    Quad quad;
    for (size_t i = 0; i < 4; i++) quad[i] = vec2(shape[i].x, shape[i].y);
    if (area_of(quad) < 0) std::swap(quad[1], quad[3]);
    if (!refine(contour, quad)) continue;
    const auto first =
        std::ranges::min_element(quad, {}, [](const vec2& corner) { return corner.x + corner.y; });
    std::rotate(quad.begin(), first, quad.end());
    found.emplace_back(double(area_of(quad)), quad);
  }
  std::ranges::stable_sort(found, [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<Quad> out;
  for (size_t i = 0; i < std::min(found.size(), most_quads); i++) out.push_back(found[i].second);
  return out;
}

std::vector<std::string> OutlineSolver::gives() const {
  return {pose_value, view_value, side_value, scale_value, shared_value, turns_value};
}

const std::vector<Quad>& OutlineSolver::quads() {
  if (number_ != sight_.number) quads_ = find_quads(*sight_.frame), number_ = sight_.number;
  return quads_;
}

// Finds a view's outline; near `before`, if that is given.
bool OutlineSolver::find(int node, const mat3* before, ContextStore& context) {
  const auto& views = tree_.data[size_t(node)].views;
  float least = most_error;
  bool found = false;
  for (size_t v = 0; v < views.size(); v++) {
    const View& view = views[v];
    if (view.size.x <= 0 || view.size.y <= 0) continue;
    for (const Quad& quad : quads()) {
      const float side = mean_side(quad);
      for (size_t turn = 0; turn < 4; turn++) {
        Quad turned = quad;
        std::rotate(turned.begin(), turned.begin() + long(turn), turned.end());
        if (before) {
          const auto last = corners_of(*before, view);
          float moved = 0;
          for (size_t i = 0; i < 4; i++) moved += glm::distance(last[i], turned[i]) / 4;
          if (moved > 0.3f * side) continue;
        }
        const auto pose = solve_rectangle(turned, view.size, sight_.focal, sight_.frame->width,
                                          sight_.frame->height);
        if (!pose || pose->error / side >= least) continue;
        const float w = float(view.width), h = float(view.height);
        const vec2 own[] = {{0, 0}, {w, 0}, {w, h}, {0, h}};
        std::vector<cv::Point2f> from, to;
        for (size_t i = 0; i < 4; i++)
          from.emplace_back(own[i].x, own[i].y), to.emplace_back(turned[i].x, turned[i].y);
        const cv::Mat matrix = cv::getPerspectiveTransform(from, to);
        mat3 homography;
        for (int row = 0; row < 3; row++)
          for (int column = 0; column < 3; column++)
            homography[column][row] = float(matrix.at<double>(row, column));
        const float ratio = view.size.x / view.size.y;
        least = pose->error / side;
        found = true;
        context.set(pose_value, homography);
        context.set(view_value, double(v));
        context.set(side_value, view.side);
        context.set(shared_value, std::string("yes"));
        context.set(scale_value, double(std::sqrt(area_of(turned) / (w * h))));
        context.set(turns_value, ratio > 0.97f && ratio < 1.03f ? 4.0 : 2.0);
      }
    }
  }
  return found;
}

Answer OutlineSolver::match(int, int child, ContextStore& context) {
  return {find(child, nullptr, context) ? Verdict::likely : Verdict::no, 1};
}

bool OutlineSolver::verify(int node, ContextStore& context) {
  const mat3* last = context.get<mat3>(pose_value);
  if (!last) return false;
  const mat3 before = *last;
  return find(node, &before, context);
}

}  // namespace wellspring::kiosk
