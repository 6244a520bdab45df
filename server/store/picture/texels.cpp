// SPDX-License-Identifier: Apache-2.0
#include "store/picture/texels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "base/parallel.h"

namespace wellspring::store {
namespace {

const uint8_t* texel_at(const Piece& piece, int x, int y) {
  return &piece.bytes[(size_t(y) * size_t(piece.width) + size_t(x)) * 4];
}

// Holds sRGB (IEC 61966-2-1) both ways.
struct SrgbTables {
  static constexpr int steps = 1 << 16;
  std::array<float, 256> linear;
  std::vector<uint8_t> code = std::vector<uint8_t>(steps + 1);

  SrgbTables() {
    for (int i = 0; i < 256; i++) {
      const double c = i / 255.0;
      linear[size_t(i)] = float(c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4));
    }
    for (int i = 0; i <= steps; i++) {
      const double x = double(i) / steps;
      const double c = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
      code[size_t(i)] = uint8_t(c * 255 + 0.5);
    }
  }
  uint8_t encode(float x) const { return code[size_t(std::min(x, 1.0f) * steps + 0.5f)]; }
};

const SrgbTables& srgb_tables() {
  static const SrgbTables tables;
  return tables;
}

}  // namespace

std::vector<Covered> cover(int from, int to) {
  std::vector<Covered> covered(static_cast<size_t>(to));
  for (int64_t at = 0; at < to; at++) {
    Covered& c = covered[size_t(at)];
    // Places are counted in parts of a texel, of which `to` make one.
    const int64_t begin = at * from, end = begin + from;
    c.first = int(begin / to);
    for (int64_t i = c.first; i * to < end && c.count < 3; i++)
      c.share[c.count++] =
          float(std::min(end, (i + 1) * to) - std::max(begin, i * to)) / float(from);
  }
  return covered;
}

void write_srgb(const float* red, const float* green, const float* blue, size_t count,
                uint8_t* rgba) {
  const SrgbTables& srgb = srgb_tables();
  for (size_t i = 0; i < count; i++, rgba += 4) {
    rgba[0] = srgb.encode(std::max(red[i], 0.0f));
    rgba[1] = srgb.encode(std::max(green[i], 0.0f));
    rgba[2] = srgb.encode(std::max(blue[i], 0.0f));
    rgba[3] = 255;
  }
}

Piece make_piece(int width, int height) {
  return {width, height, std::vector<uint8_t>(size_t(width) * size_t(height) * 4)};
}

Piece to_piece(image::ImageCodes&& codes) {
  Piece piece{codes.width, codes.height, std::move(codes.codes8)};
  if (piece.bytes.empty()) {
    piece.bytes.resize(codes.codes16.size());
    std::ranges::transform(codes.codes16, piece.bytes.begin(), to_8_bits);
  }
  return piece;
}

Piece cut(const Piece& from, const image::ImagePart& part) {
  Piece piece = make_piece(part.width, part.height);
  paste(from, part, 0, 0, piece);
  return piece;
}

void paste(const Piece& from, const image::ImagePart& part, int x, int y, Piece& into) {
  const int left = std::max({0, -x, -part.x}), top = std::max({0, -y, -part.y});
  const int right = std::min({part.width, into.width - x, from.width - part.x});
  const int bottom = std::min({part.height, into.height - y, from.height - part.y});
  if (right <= left) return;
  for (int row = top; row < bottom; row++)
    std::memcpy(const_cast<uint8_t*>(texel_at(into, x + left, y + row)),
                texel_at(from, part.x + left, part.y + row), size_t(right - left) * 4);
}

Piece turn(Piece stored, Orientation orientation) {
  if (orientation.is_upright()) return stored;
  const bool swaps = orientation.swaps_sides();
  Piece shown =
      swaps ? make_piece(stored.height, stored.width) : make_piece(stored.width, stored.height);
  uint8_t* to = shown.bytes.data();
  for (int y = 0; y < shown.height; y++)
    for (int x = 0; x < shown.width; x++, to += 4) {
      int column = swaps ? y : x, row = swaps ? x : y;
      if (orientation.mirrors_columns()) column = stored.width - 1 - column;
      if (orientation.mirrors_rows()) row = stored.height - 1 - row;
      std::memcpy(to, texel_at(stored, column, row), 4);
    }
  return shown;
}

Piece halve(const Piece& from) {
  const SrgbTables& srgb = srgb_tables();
  Piece half = make_piece((from.width + 1) / 2, (from.height + 1) / 2);
  const std::vector<Covered> columns = cover(from.width, half.width);
  const std::vector<Covered> rows = cover(from.height, half.height);
  parallel_ranges(half.height, 16, [&](int begin, int end) {
    for (int y = begin; y < end; y++) {
      uint8_t* to = const_cast<uint8_t*>(texel_at(half, 0, y));
      const Covered& down = rows[size_t(y)];
      for (const Covered& across : columns) {
        float red = 0, green = 0, blue = 0, alpha = 0;
        for (int j = 0; j < down.count; j++)
          for (int i = 0; i < across.count; i++) {
            const uint8_t* texel = texel_at(from, across.first + i, down.first + j);
            const float weight = across.share[i] * down.share[j] * float(texel[3]);
            red += weight * srgb.linear[texel[0]];
            green += weight * srgb.linear[texel[1]];
            blue += weight * srgb.linear[texel[2]];
            alpha += weight;
          }
        if (alpha > 0) {
          to[0] = srgb.encode(red / alpha);
          to[1] = srgb.encode(green / alpha);
          to[2] = srgb.encode(blue / alpha);
          to[3] = uint8_t(std::min(alpha, 255.0f) + 0.5f);
        }
        to += 4;
      }
    }
  });
  return half;
}

}  // namespace wellspring::store
