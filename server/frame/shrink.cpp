// SPDX-License-Identifier: Apache-2.0
#include "frame/shrink.h"

#include <algorithm>
#include <cstdint>

namespace wellspring::frame {
namespace {

// Of one target: the first source, and the weights of it and of those that follow, 256 in all.
struct Span {
  int first = 0;
  std::vector<uint32_t> weights;
};

std::vector<Span> make_spans(int from, int to) {
  std::vector<Span> spans(static_cast<size_t>(to));
  const double scale = double(from) / to;
  for (int i = 0; i < to; i++) {
    const double low = i * scale, high = std::min((i + 1) * scale, double(from));
    Span& span = spans[size_t(i)];
    span.first = int(low);
    uint32_t sum = 0;
    for (int x = span.first; x < high && x < from; x++) {
      const double share = (std::min(x + 1.0, high) - std::max(double(x), low)) / (high - low);
      span.weights.push_back(uint32_t(256 * share + 0.5));
      sum += span.weights.back();
    }
    span.weights[span.weights.size() / 2] += 256 - sum;
  }
  return spans;
}

}  // namespace

Image8 shrink(const Image8& image, int width, int height) {
  const std::vector<Span> columns = make_spans(image.width, width),
                          rows = make_spans(image.height, height);
  Image8 small{width, height, {}};
  small.rgb.resize(size_t(width) * size_t(height) * 3);
  std::vector<uint32_t> line(size_t(image.width) * 3);
  uint8_t* out = small.rgb.data();
  for (const Span& row : rows) {
    std::ranges::fill(line, 0);
    for (size_t i = 0; i < row.weights.size(); i++) {
      const uint8_t* in = &image.rgb[(size_t(row.first) + i) * line.size()];
      for (size_t x = 0; x < line.size(); x++) line[x] += row.weights[i] * in[x];
    }
    for (const Span& column : columns)
      for (size_t channel = 0; channel < 3; channel++) {
        uint32_t sum = 0;
        for (size_t i = 0; i < column.weights.size(); i++)
          sum += column.weights[i] * line[(size_t(column.first) + i) * 3 + channel];
        *out++ = uint8_t((sum + (1 << 15)) >> 16);
      }
  }
  return small;
}

}  // namespace wellspring::frame
