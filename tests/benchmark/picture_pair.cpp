// SPDX-License-Identifier: Apache-2.0
#include "picture_pair.h"

#include <cmath>

namespace wellspring::test {
namespace {

constexpr int block = 8;

double luminance_at(const Frame& frame, size_t i) { return double(luminance(frame.color[i])); }

}  // namespace

// If errors are independent, the difference has twice the variance.
double noise(const PicturePair& pair) {
  double sum = 0;
  for (size_t i = 0; i < pair.a.color.size(); i++) {
    dvec3 d = dvec3(pair.a.color[i]) - dvec3(pair.b.color[i]);
    sum += dot(d, d) / 3;
  }
  return std::sqrt(sum / double(pair.a.color.size()) / 2);
}

Agreement compare_pairs(const PicturePair& ours, const PicturePair& theirs) {
  int width = ours.a.width, height = ours.a.height;
  int across = width / block, down = height / block;
  std::vector<double> z;
  double difference = 0, total = 0, variance = 0, squares = 0;
  for (int by = 0; by < down; by++)
    for (int bx = 0; bx < across; bx++) {
      double d = 0, v = 0;
      for (int y = by * block; y < (by + 1) * block; y++)
        for (int x = bx * block; x < (bx + 1) * block; x++) {
          size_t i = size_t(y) * size_t(width) + size_t(x);
          double o1 = luminance_at(ours.a, i), o2 = luminance_at(ours.b, i);
          double t1 = luminance_at(theirs.a, i), t2 = luminance_at(theirs.b, i);
          d += (o1 + o2 - t1 - t2) / 2;
          v += ((o1 - o2) * (o1 - o2) + (t1 - t2) * (t1 - t2)) / 4;
          total += (t1 + t2) / 2;
        }
      difference += d;
      variance += v;
      z.push_back(v > 0 ? d / std::sqrt(v) : 0);
      squares += z.back() * z.back();
    }
  Agreement result;
  result.relative_mean = difference / total;
  result.relative_error = std::sqrt(variance) / total;
  result.block_z = std::sqrt(squares / double(z.size()));
  double products = 0, pairs = 0;
  for (int y = 0; y < down; y++)
    for (int x = 0; x < across; x++) {
      double here = z[size_t(y * across + x)];
      if (x + 1 < across) products += here * z[size_t(y * across + x + 1)], pairs++;
      if (y + 1 < down) products += here * z[size_t((y + 1) * across + x)], pairs++;
    }
  result.correlation = products / pairs / (squares / double(z.size()));
  result.correlation_error = 1 / std::sqrt(pairs);
  return result;
}

}  // namespace wellspring::test
