// SPDX-License-Identifier: Apache-2.0
// Draws pictures for a kiosk's camera: the project's figures as visitors in a plain room,
// ray-traced. Each head's place and rotation are known exactly. Axes are those of an observation
// (wire/eye_messages.h, Person): origin in the lens, +x to the right as the visitor sees the
// screen, +y up, +z towards the visitor; metres, radians.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "frame/frame.h"

namespace wellspring::test {

enum class VisitorLight : uint8_t { bright, normal, dim, side, back };
const char* name_of(VisitorLight light);

enum class Worn : uint8_t {
  nothing,
  glasses,
  hat,
  mask,
  hand
};  // the hand is held before the face

struct Visitor {
  int figure = 0;          // index into VisitorStage's files
  vec3 eyes{0, 0, 0.8f};   // the point between the pupils
  vec3 turn{0};            // yaw, pitch, roll of the head; identity faces the screen's plane
  float size = 1;          // 1: the figure's own
  std::string expression;  // an emotion's name (avatar/face/expression.h); empty: neutral
  float strength = 1;
  Worn worn = Worn::nothing;
};

struct VisitorShot {
  std::vector<Visitor> visitors;
  VisitorLight light = VisitorLight::normal;
};

struct VisitorPicture {
  Image8 image;
  std::vector<bool> of_visitor;  // pixels
};

// 640x480 at 60 degrees across.
inline constexpr int visitor_width = 640, visitor_height = 480;
inline constexpr float visitor_fov = 60 * pi / 180;

class VisitorStage {
 public:
  // Throws LoadError for a figure that cannot be read.
  explicit VisitorStage(const std::vector<std::string>& files);
  ~VisitorStage();
  // Each figure shows at most once in a shot. Deterministic. Throws std::invalid_argument for an
  // expression that the figure does not have.
  VisitorPicture draw(const VisitorShot& shot, int spp);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace wellspring::test
