// SPDX-License-Identifier: Apache-2.0
// Holds one picture of the camera for all solvers, and measures on it that they share. A pose is a
// homography: pixels of a view, (x, y, 1), to pixels of the picture.
#pragma once
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "kiosk/frame/head.h"
#include "kiosk/tree/tree.h"

namespace wellspring::kiosk {

struct Sight {
  const GrayFrame* frame = nullptr;  // borrowed
  float focal = 0;                   // pixels of the frame
  uint64_t number = 0;               // grows with each frame
  std::vector<Feature> features;     // features_of()
  bool has_features = false;
};

// Takes the next frame, which must live until the one after it.
void look_at(Sight& sight, const GrayFrame& frame, float focal);
// Finds the picture's features, once a frame; about 12 ms for 640x480.
const std::vector<Feature>& features_of(Sight& sight);
// Finds at most `most` features of a grey picture, the strongest first.
std::vector<Feature> find_features(int width, int height, const uint8_t* gray, int most);
int bits_apart(const Descriptor& a, const Descriptor& b);  // 0..256

// Pairs each feature of `from` with the one of `to` that is clearly the nearest; no feature of `to`
// is in two pairs.
std::vector<std::pair<int, int>> pair_features(std::span<const Feature> from,
                                               std::span<const Feature> to);
struct FoundPose {
  mat3 pose{1};
  int inliers = 0;
};
// Fits a homography to pairs of places (RANSAC) within `apart` pixels; nothing if fewer than 8 fit.
std::optional<FoundPose> fit_pose(std::span<const vec2> from, std::span<const vec2> to,
                                  float apart);
vec2 project_by(const mat3& pose, vec2 place);
// Returns the corners of a view in the picture, clockwise from its upper left one.
std::array<vec2, 4> corners_of(const mat3& pose, const View& view);
// Says whether a view can be seen like that: not mirrored, not folded, neither tiny nor very
// oblique.
bool is_sound(const mat3& pose, const View& view, int width, int height);
float area_of(const std::array<vec2, 4>& corners);

// Is a part of a view as the picture has it. `inside`: share of it that the picture shows.
struct Patch {
  int width = 0, height = 0;
  std::vector<uint8_t> pixels;  // one or three bytes each
  float inside = 0;
};
// Takes the part [x, x + width) by [y, y + height) of a view's pixels, `scale` patch pixels each.
Patch take_gray(const Sight& sight, const mat3& pose, const Box& part, float scale);
// The same in colour, from the frame's smaller picture; empty if it has none.
Patch take_color(const Sight& sight, const mat3& pose, const Box& part, float scale);

// Returns the correlation of two grey pictures of a size, -1..1, over all pixels of the rows; 1 for
// two that are both plain, 0 if one is.
float correlate(int width, int height, const uint8_t* a, int a_stride, const uint8_t* b,
                int b_stride);
// Returns the share of the view's textured parts that look like the picture at that pose.
float agreement(const Sight& sight, const View& view, const mat3& pose);
// Follows a view from where it was in the last picture; nothing if it is no longer there.
std::optional<mat3> follow_pose(const Sight& sight, const View& view, const mat3& before);

}  // namespace wellspring::kiosk
