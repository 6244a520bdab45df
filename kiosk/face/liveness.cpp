// SPDX-License-Identifier: Apache-2.0
#include "kiosk/face/liveness.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>
#include <vector>

#include "kiosk/network/face_marks.h"

namespace wellspring::kiosk {

// Picture of a face and what is around it, and where it was taken from.
struct FacePart {
  cv::Rect area;    // frame's pixels
  float scale = 1;  // its pixels over the frame's
  cv::Mat pixels;
};

namespace {

using Points = std::vector<cv::Point2f>;

// The part of a frame that is compared, in widths and heights of the face's box.
constexpr float part_width = 2.6f, part_height = 3;
constexpr float most_pixels = 200;  // across the part
constexpr int points_on_face = 80, points_around = 70;
constexpr float returns_within = 0.5f;  // pixels, of a point that is followed there and back
constexpr size_t least_face = 8, least_around = 10;
constexpr int least_side = 3;      // points that make a side
constexpr float at_rest = 0.08f;   // pixels, error of a point that does not move
constexpr float plane_fit = 0.5f;  // pixels, of points that share a motion

struct Paths {
  Points from, to;
  void add(cv::Point2f a, cv::Point2f b) { from.push_back(a), to.push_back(b); }
};

// Returns the error below which a share of the paths keeps `moved`, which leads from `from`.
float error_of(const Paths& paths, const Points& moved, float share) {
  std::vector<float> errors;
  for (size_t k = 0; k < moved.size(); k++)
    errors.push_back(float(cv::norm(paths.to[k] - moved[k])));
  const auto middle = errors.begin() + std::ptrdiff_t(share * float(errors.size() - 1));
  std::nth_element(errors.begin(), middle, errors.end());
  return *middle;
}

float error_of(const Paths& paths, const cv::Mat& homography, float share) {
  if (homography.empty()) return 1e9f;
  Points moved;
  cv::perspectiveTransform(paths.from, moved, homography);
  return error_of(paths, moved, share);
}

// Returns the best turn, shift and change of size as a homography; empty: there is none. `fits`
// says of each path whether it takes part.
cv::Mat find_similarity(const Paths& paths, int method, cv::OutputArray fits = cv::noArray()) {
  const cv::Mat found = cv::estimateAffinePartial2D(paths.from, paths.to, fits, method, plane_fit);
  if (found.empty()) return {};
  cv::Mat out = cv::Mat::eye(3, 3, CV_64F);
  found.copyTo(out(cv::Rect(0, 0, 3, 2)));
  return out;
}

// Follows corners within the mask from one picture to another and back.
Paths follow_points(const cv::Mat& before, const cv::Mat& now, const cv::Mat& mask, int most,
                    double apart) {
  Points from, to, back;
  cv::goodFeaturesToTrack(before, from, most, 0.01, apart, mask);
  Paths paths;
  if (from.empty()) return paths;
  std::vector<uchar> there, here;
  std::vector<float> error;
  const cv::Size window{13, 13};
  cv::calcOpticalFlowPyrLK(before, now, from, to, there, error, window, 3);
  cv::calcOpticalFlowPyrLK(now, before, to, back, here, error, window, 3);
  for (size_t k = 0; k < from.size(); k++)
    if (there[k] && here[k] && cv::norm(from[k] - back[k]) <= returns_within)
      paths.add(from[k], to[k]);
  return paths;
}

cv::Rect area_around(const Box& face, int width, int height) {
  const cv::Rect area(int(face.center_x() - part_width / 2 * face.width),
                      int(face.center_y() - part_height / 2 * face.height),
                      int(part_width * face.width), int(part_height * face.height));
  return area & cv::Rect(0, 0, width, height);
}

FacePart cut_part(const GrayView& view, const cv::Rect& area) {
  const cv::Mat full(view.height, view.width, CV_8U, const_cast<uint8_t*>(view.pixels));
  FacePart part{area, std::min(1.f, most_pixels / float(area.width)), {}};
  cv::resize(full(area), part.pixels, {}, part.scale, part.scale, cv::INTER_AREA);
  return part;
}

bool is_face(const Box& box) {
  return std::isfinite(box.x + box.y + box.width + box.height) && box.width >= 8 &&
         box.height >= 8 && box.width < 1e5f && box.height < 1e5f;
}

std::optional<FaceFlow> measure(const FacePart& before, const cv::Mat& now, const Box& face) {
  const float scale = before.scale, width = face.width * scale, height = face.height * scale;
  const vec2 middle =
      vec2(face.center_x() - float(before.area.x), face.center_y() - float(before.area.y)) * scale;
  // Parts of the face's box in its widths and heights from its middle.
  auto box = [&](float side, float above, float below) {
    return cv::Rect(int(middle.x - side * width), int(middle.y - above * height),
                    int(2 * side * width), int((above + below) * height)) &
           cv::Rect({}, before.pixels.size());
  };
  cv::Mat mask = cv::Mat::zeros(before.pixels.size(), CV_8U);
  mask(box(0.38f, 0.45f, 0.42f)) = 255;
  const Paths on_face = follow_points(before.pixels, now, mask, points_on_face, 3);
  if (on_face.from.size() < least_face) return {};
  mask = 255;
  mask(box(0.65f, 0.95f, 0.8f)) = 0;  // head, hair and neck
  const Paths around = follow_points(before.pixels, now, mask, points_around, 5);
  FaceFlow flow;
  flow.motion = error_of(on_face, on_face.from, 0.5f) / width;
  flow.plane_error =
      error_of(on_face, cv::findHomography(on_face.from, on_face.to, cv::LMEDS), 0.75f) / width;
  flow.similar_error = error_of(on_face, find_similarity(on_face, cv::LMEDS), 0.75f) / width;
  flow.noise = at_rest / width;
  if (around.from.size() < least_around) return flow;
  auto count_sides = [&](const cv::Mat& fits) {
    int at_side[4] = {}, sides = 0;  // left, right, above, below: shoulders are below
    for (size_t k = 0; k < around.from.size(); k++) {
      if (!fits.at<uchar>(int(k))) continue;
      const float x = (around.from[k].x - middle.x) / width;
      const float y = (around.from[k].y - middle.y) / height;
      at_side[y > 0.5f ? 3 : x < -0.65f ? 0 : x > 0.65f ? 1 : 2]++;
    }
    for (int points : at_side) sides += points >= least_side;
    return sides;
  };
  cv::Mat fits;
  cv::Mat model = cv::findHomography(around.from, around.to, cv::RANSAC, plane_fit, fits);
  if (model.empty() || count_sides(fits) < 3)  // too little for where the face is between them
    model = find_similarity(around, cv::RANSAC, fits);
  if (model.empty()) return flow;
  flow.sides = count_sides(fits);
  flow.against = error_of(on_face, model, 0.5f) / width;
  return flow;
}

}  // namespace

FaceMotion classify(const FaceFlow& flow) {
  // Shares of the face's width, set with prints that were moved by hand and people at webcams;
  // docs/benchmarks/kiosk.face.md has others.
  const float floor = std::max(0.0015f, flow.noise);
  if (flow.motion < floor) return FaceMotion::none;
  // A plane that turns: a homography explains what a similarity cannot.
  const bool turned = flow.similar_error > std::max(0.004f, 2 * floor) &&
                      flow.similar_error > 2.2f * flow.plane_error;
  // A plane that goes elsewhere, and takes what is around the face with it.
  const bool carried = flow.motion > 0.03f && flow.sides >= 3 && flow.against &&
                       *flow.against < 0.08f * flow.motion + 0.002f &&
                       flow.plane_error < 0.02f * flow.motion + floor;
  if (turned || carried) return FaceMotion::plane;
  const bool bent = flow.plane_error > 0.03f * flow.motion + 0.8f * floor;
  const bool leaves =
      flow.sides >= 2 && flow.against && flow.motion > 0.01f && *flow.against > 0.5f * flow.motion;
  return flow.motion > 0.0025f && (bent || leaves) ? FaceMotion::solid : FaceMotion::unclear;
}

namespace {

// One comparison gives this evidence: five in a hundred prints moved as heads do, and people who
// move their hands before the face up to a third as planes do.
constexpr float solid_evidence = 2, plane_evidence = -1.5f, most_evidence = 5;
constexpr float is_picture = -2.5f;  // two planes more than solids

}  // namespace

void step_liveness(LivenessState& state, const LivenessSettings& settings, double time,
                   std::optional<FaceMotion> motion) {
  if (!std::isfinite(time)) return;
  if (!state.started) state = {true, time, time, time, false, 0};
  if (time < state.last_time) {  // ages are kept
    const double shift = time - state.last_time;
    state.first_time += shift, state.stirred_time += shift;
  }
  state.last_time = time;
  if (motion == FaceMotion::none) return;
  if (motion) state.stirred = true, state.stirred_time = time;
  if (motion == FaceMotion::solid) state.evidence += solid_evidence;
  if (motion == FaceMotion::plane) state.evidence += plane_evidence;
  // Who cannot be compared for long, in the dark, is not refused for it.
  if (!motion && time - state.first_time >= settings.wait) state.stirred = true;
  state.evidence = std::clamp(state.evidence, -most_evidence, most_evidence);
}

float liveness(const LivenessState& state) { return 1 / (1 + std::exp(-state.evidence)); }

bool counts_as_visitor(const LivenessState& state, const LivenessSettings& settings) {
  if (state.evidence <= is_picture) return false;
  if (state.last_time - state.stirred_time > settings.still) return false;
  return state.evidence >= solid_evidence ||
         (state.stirred && state.last_time - state.first_time >= settings.wait);
}

struct LivenessWatch::Impl {
  LivenessSettings settings;
  struct Watched {
    LivenessState state;
    FacePart part;
    Box face;
    double time = -1e9;
    int width = 0, height = 0;
  };
  std::map<uint32_t, Watched> faces{};
};

LivenessWatch::LivenessWatch(const LivenessSettings& settings)
    : impl_(std::make_unique<Impl>(Impl{settings})) {}
LivenessWatch::~LivenessWatch() = default;

const LivenessState& LivenessWatch::step(const GrayFrame& frame, uint32_t id, const Box& face) {
  Impl::Watched& one = impl_->faces[id];
  if (!one.state.started) step_liveness(one.state, impl_->settings, frame.time, FaceMotion::none);
  const bool comparable = !one.part.pixels.empty() && one.width == frame.width &&
                          one.height == frame.height && frame.time > one.time;
  if (comparable && frame.time - one.time < impl_->settings.every) return one.state;
  const GrayView view{frame.pixels.data(), frame.width, frame.height};
  if (comparable) {
    const auto flow = measure(one.part, cut_part(view, one.part.area).pixels, one.face);
    step_liveness(one.state, impl_->settings, frame.time,
                  flow ? std::optional(classify(*flow)) : std::nullopt);
  }
  one.part = {};
  one.face = face, one.time = frame.time, one.width = frame.width, one.height = frame.height;
  if (!is_face(face)) return one.state;
  const cv::Rect area = area_around(face, frame.width, frame.height);
  if (area.width >= 16 && area.height >= 16) one.part = cut_part(view, area);
  return one.state;
}

void LivenessWatch::forget(uint32_t id) { impl_->faces.erase(id); }

bool LivenessWatch::counts(const LivenessState& state) const {
  return counts_as_visitor(state, impl_->settings);
}

}  // namespace wellspring::kiosk
