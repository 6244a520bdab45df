// SPDX-License-Identifier: Apache-2.0
// Surfaces that are known exactly, and points scattered over them as scanners would.
#pragma once
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "base/vec.h"
#include "scan/draw/draw_points.h"

namespace wellspring::test {

// Points of one node, owned; first they are added, then lent.
struct PointSet {
  dvec3 corner{0};
  float size = 1, spacing = 0.01f;
  uint32_t count = 0;
  std::vector<uint16_t> x, y, z, normal;
  std::vector<uint32_t> color;
  std::vector<uint8_t> classification;

  static uint16_t normal_of(vec3 n) {
    n /= std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
    vec2 u(n.x, n.y);
    if (n.z < 0) u = {std::copysign(1 - std::abs(n.y), n.x), std::copysign(1 - std::abs(n.x), n.y)};
    const auto byte = [](float a) { return uint16_t(uint8_t(int8_t(std::lrint(a * 127)))); };
    return uint16_t(byte(u.x) | byte(u.y) << 8);
  }
  void add_place(int px, int py, int pz, uint32_t c = 0xffffffff, uint16_t n = 0x8080,
                 uint8_t k = 0) {
    count++;
    x.push_back(uint16_t(px)), y.push_back(uint16_t(py)), z.push_back(uint16_t(pz));
    color.push_back(c), normal.push_back(n), classification.push_back(k);
  }
  void add(dvec3 place, vec3 n, uint32_t c) {
    const dvec3 p = (place - corner) * 65536.0 / double(size);
    add_place(int(p.x), int(p.y), int(p.z), c, normal_of(n));
  }
  // Appends what may be read beyond the end, and lends the columns.
  scan::NodePoints lend() {
    for (auto* column : {&x, &y, &z, &normal}) column->resize(count + 8, 0x7777);
    color.resize(count + 8, 0xff00ff), classification.resize(count + 8, 99);
    scan::NodePoints node;
    node.corner = corner, node.size = size, node.spacing = spacing, node.count = count;
    node.x = x.data(), node.y = y.data(), node.z = z.data();
    node.color = color.data(), node.normal = normal.data();
    node.classification = classification.data();
    return node;
  }
};

struct Rectangle {
  dvec3 corner{0}, a{1, 0, 0}, b{0, 1, 0};  // edges at right angles
};
struct Ball {
  dvec3 middle{0};
  double radius = 1;
};

struct Surfaces {
  std::vector<Rectangle> rectangles;
  std::vector<Ball> balls;

  // Returns the depth along the axis at the sampling place of a pixel, or infinity.
  double depth_at(const scan::ScanCamera& view, double px, double py) const {
    const double f = double(view.focal());
    const vec2 axis = view.axis_place();
    const dvec3 d = dvec3(view.forward) +
                    dvec3(view.right) * ((px + double(view.offset.x) - double(axis.x)) / f) -
                    dvec3(view.up) * ((py + double(view.offset.y) - double(axis.y)) / f);
    double best = std::numeric_limits<double>::infinity();
    for (const Rectangle& r : rectangles) {
      const dvec3 n = cross(r.a, r.b);
      const double t = dot(r.corner - view.eye, n) / dot(d, n);
      const dvec3 p = view.eye + d * t - r.corner;
      const double u = dot(p, r.a) / dot(r.a, r.a), v = dot(p, r.b) / dot(r.b, r.b);
      if (t > 0 && t < best && u >= 0 && u <= 1 && v >= 0 && v <= 1) best = t;
    }
    for (const Ball& ball : balls) {
      const dvec3 o = view.eye - ball.middle;
      const double a = dot(d, d), b = dot(o, d), c = dot(o, o) - ball.radius * ball.radius;
      const double root = b * b - a * c;
      if (root <= 0) continue;
      const double t = (-b - std::sqrt(root)) / a;
      if (t > 0 && t < best) best = t;
    }
    return best;
  }

  // Calls add(place, normal) for one point at random in each square of `spacing`, and for a ball
  // for points as even.
  template <class Add>
  void scatter(double spacing, uint32_t seed, const Add& add) const {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> share(0, 1);
    for (const Rectangle& r : rectangles) {
      const double long_a = length(r.a), long_b = length(r.b);
      const dvec3 n = normalize(cross(r.a, r.b));
      for (double u = 0; u < long_a; u += spacing)
        for (double v = 0; v < long_b; v += spacing) {
          const double su = u + share(random) * spacing, sv = v + share(random) * spacing;
          if (su <= long_a && sv <= long_b)
            add(r.corner + r.a * (su / long_a) + r.b * (sv / long_b), n);
        }
    }
    for (const Ball& ball : balls) {
      const int count = int(4 * double(pi) * ball.radius * ball.radius / (spacing * spacing));
      for (int i = 0; i < count; i++) {  // Fibonacci's spiral
        const double h = 1 - 2 * (i + share(random)) / count, a = i * 2.39996322972865332;
        const double w = std::sqrt(1 - h * h);
        const dvec3 n(w * std::cos(a), h, w * std::sin(a));
        add(ball.middle + n * ball.radius, n);
      }
    }
  }
};

// Returns points over the surfaces in one cube.
inline PointSet scattered(const Surfaces& surfaces, double spacing, dvec3 corner, float size,
                          uint32_t seed = 1, uint32_t color = 0xff808080) {
  PointSet set;
  set.corner = corner, set.size = size, set.spacing = float(spacing);
  surfaces.scatter(spacing, seed, [&](dvec3 p, dvec3 n) { set.add(p, vec3(n), color); });
  return set;
}

// Counts pixels of a picture against the surfaces.
struct Verdict {
  int covered = 0;   // pixels that see a surface
  int holes = 0;     // which see farther
  int fattened = 0;  // pixels more than `apart` pixels off a surface that see it
  double error = 0;  // mean of relative errors of depth, of others
};

inline Verdict judge(const scan::PointBuffer& buffer, const Surfaces& surfaces,
                     const scan::ScanCamera& view, double tolerance, double apart) {
  Verdict verdict;
  int right = 0;
  for (int y = 0; y < view.height; y++)
    for (int x = 0; x < view.width; x++) {
      const double truth = surfaces.depth_at(view, x, y);
      const double seen = double(buffer.depth[size_t(y * view.width + x)]);
      const bool is_covered = std::isfinite(truth);
      verdict.covered += is_covered;
      // Pixels at an edge may show either side.
      double least = truth, most = truth;
      for (int i = 0; i < 16; i++) {
        const double a = i * 2 * double(pi) / 16;
        const double other =
            surfaces.depth_at(view, x + apart * std::cos(a), y + apart * std::sin(a));
        least = std::min(least, other), most = std::max(most, other);
      }
      if (is_covered && !(seen <= most + tolerance)) verdict.holes++;
      if (seen < least - tolerance) verdict.fattened++;
      if (is_covered && std::abs(seen - truth) < tolerance) {
        verdict.error += std::abs(seen / truth - 1);
        right++;
      }
    }
  verdict.error /= std::max(right, 1);
  return verdict;
}

}  // namespace wellspring::test
