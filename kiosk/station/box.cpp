// SPDX-License-Identifier: Apache-2.0
#include "kiosk/station/box.h"

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "kiosk/station/pattern.h"

namespace wellspring::kiosk {
namespace {

constexpr int smaller = 2;            // edges are sought in a picture so much smaller
constexpr float least_length = 14;    // length of an edge, pixels of that picture, as what follows
constexpr float near_end = 10;        // how far an edge may end from the corner
constexpr float off_line = 3;         // how far it may pass it by
constexpr float least_angle = 0.26f;  // between edges of a corner, radians
constexpr size_t most_segments = 140, most_junctions = 300;
constexpr float lengths_fit = 0.2f;  // how far edges may be from telling one distance
constexpr size_t most_hypotheses = 24;
constexpr int edge_samples = 12;                              // places along an edge of the model
constexpr float on_edge = 1.6f;                               // pixels
constexpr float surely_there = 0.7f, box_still_there = 0.6f;  // shares of places that lie on edges
constexpr float edge_seen = 0.4f;  // share of an edge's places from which it is seen
constexpr int most_unseen = 2;     // edges that fingers may hide

struct Segment {
  vec2 a, b;
};

float distance_to_line(vec2 p, vec2 a, vec2 b) {
  const vec2 along = glm::normalize(b - a);
  return std::abs(along.x * (p.y - a.y) - along.y * (p.x - a.x));
}

cv::Mat half_of(const GrayFrame& frame) {
  const cv::Mat gray(frame.height, frame.width, CV_8U, const_cast<uint8_t*>(frame.pixels.data()));
  cv::Mat half;
  cv::resize(gray, half, {frame.width / smaller, frame.height / smaller}, 0, 0, cv::INTER_AREA);
  return half;
}

std::vector<Segment> find_segments(const cv::Mat& picture) {
  std::vector<cv::Vec4f> found;
  cv::createLineSegmentDetector(cv::LSD_REFINE_NONE)->detect(picture, found);
  std::vector<Segment> out;
  for (const cv::Vec4f& one : found)
    if (const vec2 a(one[0], one[1]), b(one[2], one[3]); glm::distance(a, b) >= least_length)
      out.push_back({a, b});
  std::ranges::stable_sort(out, std::ranges::greater(),
                           [](const Segment& one) { return glm::distance(one.a, one.b); });
  if (out.size() > most_segments) out.resize(most_segments);
  return out;
}

// Finds where two edges meet, and turns each so that `a` is its end there; nothing if they do not.
std::optional<vec2> meet(Segment& one, Segment& other) {
  float least = 1e9f;
  Segment p, q;
  for (const Segment& u : {one, Segment{one.b, one.a}})
    for (const Segment& v : {other, Segment{other.b, other.a}})
      if (const float apart = glm::distance(u.a, v.a); apart < least) least = apart, p = u, q = v;
  if (least > 2 * near_end) return {};
  const vec2 u = glm::normalize(p.b - p.a), v = glm::normalize(q.b - q.a);
  const float turn = u.x * v.y - u.y * v.x;
  if (std::abs(turn) < std::sin(least_angle)) return {};
  const vec2 to = q.a - p.a, at = p.a + u * ((to.x * v.y - to.y * v.x) / turn);
  if (glm::distance(at, p.a) > near_end || glm::distance(at, q.a) > near_end) return {};
  one = p, other = q;
  return at;
}

vec3 ray_of(vec2 at, float focal, int width, int height) {
  return {(at.x - float(width) / 2) / focal, (at.y - float(height) / 2) / focal, 1};
}

// Returns the turn that takes a ray to the line of sight.
mat3 turn_to_sight(vec3 ray) {
  const vec3 z = glm::normalize(ray), x = glm::normalize(glm::cross(vec3(0, 1, 0), z));
  return glm::transpose(mat3(x, glm::cross(z, x), z));
}

// Names the box's axes: its away leads from the camera, its down looks down in the picture. Those
// are the ways round that look the same, but for a half turn.
mat3 upright(const std::array<vec3, 3>& axes) {
  const vec3 away = axes[2].z < 0 ? -axes[2] : axes[2];
  const vec3 down = axes[1].y < 0 ? -axes[1] : axes[1];
  return {glm::cross(down, away), down, away};
}

}  // namespace

std::vector<Junction> find_junctions(const GrayFrame& frame) {
  const std::vector<Segment> all = find_segments(half_of(frame));
  std::vector<Junction> out;
  for (size_t i = 0; i < all.size(); i++)
    for (size_t k = i + 1; k < all.size(); k++) {
      Segment first = all[i], second = all[k];
      const auto at = meet(first, second);
      if (!at) continue;
      for (size_t m = k + 1; m < all.size() && out.size() < most_junctions; m++) {
        Segment third = all[m];
        if (glm::distance(*at, third.b) < glm::distance(*at, third.a)) std::swap(third.a, third.b);
        if (glm::distance(*at, third.a) > near_end) continue;
        if (distance_to_line(*at, third.a, third.b) > off_line) continue;
        Segment a = first, b = second, c = third, d = third;
        if (!meet(a, c) || !meet(b, d)) continue;
        const float scale = smaller;
        out.push_back({*at * scale, {first.b * scale, second.b * scale, third.b * scale}});
      }
    }
  return out;
}

std::vector<SpacePose> solve_corner(const Junction& corner, vec3 size, float focal, int width,
                                    int height) {
  // Looked at straight, each edge lies in a plane through the line of sight: only its slope is
  // unknown. The edges are square to one another, which gives the slopes but for their signs.
  const vec3 ray = ray_of(corner.at, focal, width, height);
  const mat3 turn = turn_to_sight(ray);
  std::array<vec3, 3> ends;
  std::array<float, 3> angle;
  for (size_t i = 0; i < 3; i++) {
    ends[i] = ray_of(corner.ends[i], focal, width, height);
    const vec3 seen = turn * ends[i];
    angle[i] = std::atan2(seen.y, seen.x);
  }
  const float c12 = std::cos(angle[0] - angle[1]), c13 = std::cos(angle[0] - angle[2]),
              c23 = std::cos(angle[1] - angle[2]);
  std::vector<SpacePose> out;
  constexpr float least = 0.01f;
  if (std::min({std::abs(c12), std::abs(c13), std::abs(c23)}) < least) return out;
  const float square = -c12 * c13 / c23;
  if (!(square > 0)) return out;
  for (const float sign : {1.f, -1.f}) {
    const float slope = sign * std::sqrt(square);
    const float slopes[] = {slope, -c12 / slope, -c13 / slope};
    std::array<vec3, 3> along;
    for (size_t i = 0; i < 3; i++)
      along[i] = glm::transpose(turn) *
                 glm::normalize(vec3(std::cos(angle[i]), std::sin(angle[i]), slopes[i]));
    std::array<int, 3> order{0, 1, 2};  // axis of the box that each edge is
    do {
      float low = 1e9f, high = 0, sum = 0;
      for (size_t i = 0; i < 3; i++) {
        const vec3 aside = glm::cross(ends[i], along[i]), by = glm::cross(ends[i], ray);
        const float depth = -size[order[i]] * glm::dot(aside, by) / glm::dot(by, by);
        low = std::min(low, depth), high = std::max(high, depth), sum += depth / 3;
      }
      if (!(low > 0) || high - low > lengths_fit * sum) continue;
      SpacePose pose;
      pose.position = ray * sum;
      std::array<vec3, 3> axes;
      for (size_t i = 0; i < 3; i++) {
        pose.position += along[i] * (0.5f * size[order[i]]);
        axes[size_t(order[i])] = along[i];
      }
      pose.rotation = upright(axes);
      pose.error = (high - low) / sum;
      if (is_finite(pose.position)) out.push_back(pose);
    } while (std::ranges::next_permutation(order).found);
  }
  return out;
}

// Holds the picture's edges, and the brightness's slope across them.
struct BoxSolver::EdgePicture {
  cv::Mat edges, across, down;

  explicit EdgePicture(const GrayFrame& frame) {
    cv::Mat smooth;
    cv::GaussianBlur(half_of(frame), smooth, {5, 5}, 1);
    cv::Sobel(smooth, across, CV_16S, 1, 0);
    cv::Sobel(smooth, down, CV_16S, 0, 1);
    cv::Canny(across, down, edges, 30, 80);
  }
  // Finds the edge nearest to `at` along `normal` that runs across it.
  std::optional<vec2> find(vec2 at, vec2 normal, float reach) const {
    for (float step = 0; step <= reach; step += 0.5f)
      for (const float side : {1.f, -1.f}) {
        const vec2 place = at + normal * (side * step);
        const int x = int(std::lround(place.x)), y = int(std::lround(place.y));
        if (x < 0 || y < 0 || x >= edges.cols || y >= edges.rows || !edges.at<uint8_t>(y, x))
          continue;
        const vec2 slope(across.at<int16_t>(y, x), down.at<int16_t>(y, x));
        if (std::abs(glm::dot(slope, normal)) > 0.85f * glm::length(slope)) return place;
      }
    return {};
  }
};

const BoxSolver::EdgePicture& BoxSolver::edges() {
  if (number_ != sight_.number) {
    number_ = sight_.number;
    edges_ = std::make_shared<EdgePicture>(*sight_.frame);
    junctions_ = find_junctions(*sight_.frame);
  }
  return *edges_;
}

namespace {

struct ModelEdge {
  vec3 from, to;
};

// Returns the edges of a box that can be seen from the camera: those of faces that look at it.
std::vector<ModelEdge> seen_edges(const SpacePose& pose, vec3 size) {
  std::vector<ModelEdge> out;
  auto faces_camera = [&](int axis, float side) {
    const vec3 normal = pose.rotation[axis] * side;
    return glm::dot(normal, pose.position + normal * (0.5f * size[axis])) < 0;
  };
  for (int axis = 0; axis < 3; axis++)
    for (const float u : {-1.f, 1.f})
      for (const float v : {-1.f, 1.f}) {
        const int p = (axis + 1) % 3, q = (axis + 2) % 3;
        if (!faces_camera(p, u) && !faces_camera(q, v)) continue;
        vec3 end(0);
        end[axis] = 0.5f * size[axis], end[p] = 0.5f * u * size[p], end[q] = 0.5f * v * size[q];
        vec3 other = end;
        other[axis] = -other[axis];
        out.push_back({end, other});
      }
  return out;
}

}  // namespace

// Moves the pose so that its edges lie on the picture's. Returns the share of their places that do;
// 0 if too many edges are not seen.
float BoxSolver::refine(SpacePose& pose, vec3 size, int steps) {
  const EdgePicture& picture = edges();
  const float focal = sight_.focal / smaller;
  const int width = picture.edges.cols, height = picture.edges.rows;
  const cv::Matx33d camera(focal, 0, width / 2.0, 0, focal, height / 2.0, 0, 0, 1);
  auto project = [&](vec3 own) {
    const vec3 at = pose.position + pose.rotation * own;
    return vec2(at) / at.z * focal + vec2(width, height) / 2.f;
  };
  for (int step = 0;; step++) {
    const bool last = step == steps;
    const float reach = last ? on_edge : std::max(3.f, 8.f / float(step + 1));
    std::vector<cv::Point3f> own;
    std::vector<cv::Point2f> seen;
    int count = 0, unseen = 0;
    for (const ModelEdge& edge : seen_edges(pose, size)) {
      int hits = 0;
      const vec2 a = project(edge.from), b = project(edge.to);
      if (!(glm::distance(a, b) > 2)) continue;
      const vec2 along = glm::normalize(b - a), normal(-along.y, along.x);
      for (int i = 0; i < edge_samples; i++) {
        const vec3 place = glm::mix(edge.from, edge.to, (float(i) + 0.5f) / edge_samples);
        const auto found = picture.find(project(place), normal, reach);
        count++;
        if (!found) continue;
        hits++;
        own.emplace_back(place.x, place.y, place.z);
        seen.emplace_back(found->x, found->y);
      }
      unseen += float(hits) < edge_seen * edge_samples;
    }
    if (count == 0 || seen.size() < 12) return 0;
    if (last) return unseen > most_unseen ? 0 : float(seen.size()) / float(count);
    cv::Matx33d rotation;
    for (int row = 0; row < 3; row++)
      for (int column = 0; column < 3; column++)
        rotation(row, column) = double(pose.rotation[column][row]);
    cv::Vec3d turn,
        place(double(pose.position.x), double(pose.position.y), double(pose.position.z));
    cv::Rodrigues(rotation, turn);
    cv::solvePnPRefineLM(own, seen, camera, cv::noArray(), turn, place);
    cv::Rodrigues(turn, rotation);
    for (int row = 0; row < 3; row++)
      for (int column = 0; column < 3; column++)
        pose.rotation[column][row] = float(rotation(row, column));
    pose.position = vec3(place[0], place[1], place[2]);
    if (!is_finite(pose.position) || !(pose.position.z > size.z)) return 0;
  }
}

// Tells solvers that come later where the face is of which they have a view.
void BoxSolver::tell(int node, ContextStore& context) {
  const NodeData& data = tree_.data[size_t(node)];
  const mat3& axes = pose_->rotation;
  float best = 0.2f;
  for (size_t v = 0; v < data.views.size(); v++) {
    const View& view = data.views[v];
    const bool aside = view.side == "left" || view.side == "right";
    const bool above = view.side == "top" || view.side == "bottom";
    const int axis = aside ? 0 : above ? 1 : 2;
    const float towards = -glm::dot(axes[axis], glm::normalize(pose_->position));
    if (std::abs(towards) <= best) continue;
    best = std::abs(towards);
    const vec3 away = towards > 0 ? -axes[axis] : axes[axis];
    const vec3 down = !above ? axes[1] : towards > 0 ? axes[2] : -axes[2];
    const vec3 right = glm::cross(down, away);
    const vec3 middle = pose_->position - away * (0.5f * data.box[axis]);
    const vec2 half = 0.5f * (aside   ? vec2(data.box.z, data.box.y)
                              : above ? vec2(data.box.x, data.box.z)
                                      : vec2(data.box.x, data.box.y));
    const float w = float(view.width), h = float(view.height);
    const std::vector<cv::Point2f> from{{0, 0}, {w, 0}, {w, h}, {0, h}};
    std::vector<cv::Point2f> to;
    for (const vec2 corner : {vec2(-1, -1), vec2(1, -1), vec2(1, 1), vec2(-1, 1)}) {
      const vec3 at = middle + right * (corner.x * half.x) + down * (corner.y * half.y);
      to.emplace_back(at.x / at.z * sight_.focal + float(sight_.frame->width) / 2,
                      at.y / at.z * sight_.focal + float(sight_.frame->height) / 2);
    }
    const cv::Mat matrix = cv::getPerspectiveTransform(from, to);
    mat3 homography;
    for (int row = 0; row < 3; row++)
      for (int column = 0; column < 3; column++)
        homography[column][row] = float(matrix.at<double>(row, column));
    context.set(pose_value, homography);
    context.set(view_value, double(v));
    context.set(side_value, view.side);
    context.set(shared_value, std::string("yes"));
    context.set(scale_value,
                double(std::sqrt(std::abs(area_of(corners_of(homography, view))) / (w * h))));
    context.set(turns_value, 2.0);
  }
}

std::vector<std::string> BoxSolver::gives() const {
  return {pose_value, view_value, side_value, scale_value, shared_value, turns_value};
}

Answer BoxSolver::match(int, int child, ContextStore& context) {
  const vec3 size = tree_.data[size_t(child)].box;
  if (!(size.x > 0)) return {};
  edges();
  std::vector<SpacePose> poses;
  for (const Junction& junction : junctions_) {
    const auto some =
        solve_corner(junction, size, sight_.focal, sight_.frame->width, sight_.frame->height);
    poses.insert(poses.end(), some.begin(), some.end());
  }
  std::ranges::stable_sort(poses, {}, &SpacePose::error);
  if (poses.size() > most_hypotheses) poses.resize(most_hypotheses);
  float best = surely_there;
  bool found = false;
  for (SpacePose& pose : poses) {
    const float share = refine(pose, size, 4);
    if (share < best) continue;
    best = share, pose_ = pose, found = true;
  }
  if (!found) return {};
  pose_->rotation = upright({pose_->rotation[0], pose_->rotation[1], pose_->rotation[2]});
  tell(child, context);
  return {Verdict::sure, double(best)};
}

bool BoxSolver::verify(int node, ContextStore& context) {
  const vec3 size = tree_.data[size_t(node)].box;
  if (!pose_ || !(size.x > 0)) return false;
  SpacePose pose = *pose_;
  if (refine(pose, size, 3) < box_still_there) {
    pose_.reset();
    return false;
  }
  pose_ = pose;
  tell(node, context);
  return true;
}

}  // namespace wellspring::kiosk
