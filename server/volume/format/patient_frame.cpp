// SPDX-License-Identifier: Apache-2.0
#include "volume/format/patient_frame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

namespace wellspring::volume {
namespace {

// Letters of the frame's axes, forward and backward.
constexpr std::array<const char*, 3> frame_letters{"LR", "SI", "AP"};

int frame_axis(char letter) {
  for (int axis = 0; axis < 3; axis++)
    if (letter != 0 &&
        (letter == frame_letters[size_t(axis)][0] || letter == frame_letters[size_t(axis)][1]))
      return axis;
  return -1;
}

const char* word_of(char letter) {
  switch (letter) {
    case 'L': return "to the patient's left";
    case 'R': return "to the patient's right";
    case 'S': return "up";
    case 'I': return "down";
    case 'A': return "to the front";
    default: return "to the back";
  }
}

}  // namespace

bool are_axes(const std::string& axes) {
  if (axes.size() != 3) return false;
  std::array<bool, 3> seen{};
  for (const char letter : axes) {
    const int axis = frame_axis(letter);
    if (axis < 0 || seen[size_t(axis)]) return false;
    seen[size_t(axis)] = true;
  }
  return true;
}

glm::dmat4 to_patient_frame(const std::string& axes) {
  glm::dmat4 frame(0);
  for (int i = 0; i < 3; i++) {
    const int axis = std::max(frame_axis(axes[size_t(i)]), 0);
    frame[i][axis] = axes[size_t(i)] == frame_letters[size_t(axis)][0] ? 1 : -1;
  }
  frame[3][3] = 1;
  return frame;
}

std::string axes_of(const glm::dmat4& to_metres) {
  // Takes the one that fits best of six ways to give axes to columns: no letter comes twice.
  const glm::dmat3 turn(to_metres);
  const auto part = [&](int column, int axis) {
    return turn[column][axis] / std::max(glm::length(turn[column]), 1e-300);
  };
  std::array<int, 3> order{0, 1, 2}, best = order;
  double most = -1;
  do {
    double sum = 0;
    for (int i = 0; i < 3; i++) sum += std::abs(part(i, order[size_t(i)]));
    if (sum > most) most = sum, best = order;
  } while (std::ranges::next_permutation(order).found);
  std::string axes;
  for (int i = 0; i < 3; i++) {
    const int axis = best[size_t(i)];
    axes += frame_letters[size_t(axis)][part(i, axis) < 0 ? 1 : 0];
  }
  return axes;
}

std::string describe_axes(const glm::dmat4& to_metres) {
  const std::string axes = axes_of(to_metres);
  const glm::dmat4 ideal = to_patient_frame(axes);
  double angle = 0;
  for (int i = 0; i < 3; i++) {
    const glm::dvec3 column = glm::normalize(glm::dvec3(to_metres[i]));
    const double cosine = glm::dot(column, glm::dvec3(ideal[i]));
    angle = std::max(angle, glm::degrees(std::acos(std::clamp(cosine, -1.0, 1.0))));
  }
  std::string text = fmt::format("x runs {}, y {}, z {} ({})", word_of(axes[0]), word_of(axes[1]),
                                 word_of(axes[2]), axes);
  if (angle > 0.1) text += fmt::format(", oblique by up to {:.1f} degrees", angle);
  if (glm::determinant(glm::dmat3(to_metres)) < 0) text += ", a left-handed grid";
  return text;
}

}  // namespace wellspring::volume
