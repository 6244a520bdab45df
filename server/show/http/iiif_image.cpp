// SPDX-License-Identifier: Apache-2.0
#include "show/http/iiif_image.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "image/srgb.h"

namespace wellspring::show {
namespace {

// A picture whose levels lie far apart is read from a coarser one rather than from more texels.
constexpr double most_read_texels = double(int64_t(1) << 26);
constexpr double least_snapped = 16;  // pixels of a side

// Encodes linear light as sRGB (IEC 61966-2-1).
class SrgbEncoder {
 public:
  SrgbEncoder() {
    for (int i = 0; i <= steps; i++) {
      const double x = double(i) / steps;
      const double c = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
      codes_[size_t(i)] = uint8_t(c * 255 + 0.5);
    }
  }
  uint8_t encode(float x) const {
    return codes_[size_t(std::clamp(x, 0.0f, 1.0f) * float(steps) + 0.5f)];
  }

 private:
  static constexpr int steps = 1 << 16;
  std::vector<uint8_t> codes_ = std::vector<uint8_t>(steps + 1);
};
const SrgbEncoder& srgb() {
  static const SrgbEncoder encoder;
  return encoder;
}

// Says which texels of a level's row, or column, each pixel covers, and by how much.
struct IiifAxis {
  struct IiifTaps {
    int64_t first = 0;
    size_t weight = 0;  // place of the first one's weight
    int count = 0;
  };
  std::vector<IiifTaps> pixels;
  std::vector<float> weights;
  int64_t begin = 0, end = 0;  // texels that are read
  bool is_copy = false;        // whether each pixel is one texel, one after the other

  // The region: `from` and `length` in texels of the level, which has `size` of them.
  IiifAxis(double from, double length, int64_t size, int count) {
    double step = length / count;
    // A tile at the edge of a level whose size was rounded is left as it is.
    if (std::abs(length - count) < 1 && (count >= least_snapped || length == count)) step = 1;
    const double half = std::max(step, 1.0) / 2;  // half of a pixel's width
    is_copy = step == 1 && from == std::floor(from) && from + count <= double(size);
    for (int i = 0; i < count; i++) {
      const double middle = from + (i + 0.5) * step;
      add(middle - half, middle + half, size);
    }
    begin = pixels.front().first;
    end = pixels.back().first + pixels.back().count;
  }

 private:
  void add(double low, double high, int64_t size) {
    const double most = double(size);
    low = std::clamp(low, 0.0, most), high = std::clamp(high, 0.0, most);
    if (high - low < 1e-6) low = low > 0.5 ? most - 1 : 0, high = low + 1;
    IiifTaps taps{std::min(int64_t(low + 1e-9), size - 1), weights.size(), 0};
    float sum = 0;
    for (int64_t i = taps.first; i < size && double(i) < high - 1e-9; i++) {
      const float share = float(std::min(high, double(i + 1)) - std::max(low, double(i)));
      weights.push_back(share);
      sum += share;
      taps.count++;
    }
    for (size_t i = taps.weight; i < weights.size(); i++) weights[i] /= sum;
    pixels.push_back(taps);
  }
};

// Holds a level and the part of it that a request asks for.
struct IiifSource {
  int level = 0;
  IiifAxis across, down;
};

// Returns how many texels of a level one of the finest is wide, or high.
double shrunk(int64_t side, int64_t finest, int64_t scale) {
  return scale > 0 ? 1 / double(scale) : double(side) / double(finest);
}

int choose_level(const std::vector<PyramidLevel>& levels, const IiifRequest& request) {
  const PyramidLevel& finest = levels[0];
  const auto texels = [&](size_t i, bool is_width) {
    const int64_t scale = iiif_scale(levels[i], finest);
    return is_width
               ? double(request.region_width) * shrunk(levels[i].width, finest.width, scale)
               : double(request.region_height) * shrunk(levels[i].height, finest.height, scale);
  };
  const auto suffices = [](double texels, int pixels) {
    return texels + std::min(1.0, 0.02 * pixels) >= pixels;
  };
  size_t chosen = levels.size() - 1;
  while (chosen > 0 && !(suffices(texels(chosen, true), request.width) &&
                         suffices(texels(chosen, false), request.height)))
    chosen--;
  while (chosen + 1 < levels.size() &&
         texels(chosen, true) * texels(chosen, false) > most_read_texels)
    chosen++;
  return int(chosen);
}

IiifSource choose_source(const PicturePyramid& pyramid, const IiifRequest& request) {
  const std::vector<PyramidLevel>& levels = pyramid.levels();
  const int chosen = choose_level(levels, request);
  const PyramidLevel& level = levels[size_t(chosen)];
  const int64_t scale = iiif_scale(level, levels[0]);
  const double across = shrunk(level.width, levels[0].width, scale);
  const double down = shrunk(level.height, levels[0].height, scale);
  return {chosen,
          IiifAxis(double(request.x) * across, double(request.region_width) * across, level.width,
                   request.width),
          IiifAxis(double(request.y) * down, double(request.region_height) * down, level.height,
                   request.height)};
}

// Calls use(tile, x, y) for each tile that the axes touch and that is there; x and y are the place
// of its upper left corner in the level.
template <class Use>
void each_tile(const PicturePyramid& pyramid, const IiifSource& source, const Use& use) {
  const PyramidLevel& level = pyramid.levels()[size_t(source.level)];
  const int64_t wide = level.tile_width, high = level.tile_height;
  for (int64_t row = source.down.begin / high; row * high < source.down.end; row++)
    for (int64_t column = source.across.begin / wide; column * wide < source.across.end; column++)
      if (const Fetched tile = pyramid.fetch({1, source.level, uint32_t(column), uint32_t(row)});
          tile.piece)
        use(*tile.piece, column * wide, row * high);
}

// Returns what white has more than a channel of a texel has, in linear light.
inline float missing(const uint8_t* texel, int channel) {
  return float(texel[3]) * (1.0f / 255) * (1 - image::decode_srgb(texel[channel]));
}

// Copies texels that are pixels.
void copy_tile(const Piece& tile, int64_t x, int64_t y, const IiifSource& source, Image8& image) {
  const int64_t left = std::max(x, source.across.begin);
  const int64_t right = std::min(x + tile.width, source.across.end);
  const int64_t bottom = std::min(y + tile.height, source.down.end);
  for (int64_t row = std::max(y, source.down.begin); row < bottom; row++) {
    const uint8_t* from = &tile.bytes[size_t((row - y) * tile.width + left - x) * 4];
    uint8_t* to =
        &image
             .rgb[size_t((row - source.down.begin) * image.width + left - source.across.begin) * 3];
    for (int64_t i = left; i < right; i++, from += 4, to += 3) {
      if (from[3] == 255) {
        std::copy_n(from, 3, to);
        continue;
      }
      for (int c = 0; c < 3; c++) to[c] = srgb().encode(1 - missing(from, c));
    }
  }
}

// Returns the range of pixels that cover texels from `begin` to before `end`.
std::pair<size_t, size_t> covered(const IiifAxis& axis, int64_t begin, int64_t end) {
  const auto low = std::ranges::partition_point(axis.pixels, [&](const IiifAxis::IiifTaps& taps) {
    return taps.first + taps.count <= begin;
  });
  const auto high = std::ranges::partition_point(
      axis.pixels, [&](const IiifAxis::IiifTaps& taps) { return taps.first < end; });
  return {size_t(low - axis.pixels.begin()), size_t(high - axis.pixels.begin())};
}

// Takes a tile's part of linear colours away from white: each of its rows is averaged across, and
// that down into the rows of pixels that cover it.
void average_tile(const Piece& tile, int64_t x, int64_t y, const IiifSource& source, int width,
                  std::vector<float>& colors) {
  const auto columns = covered(source.across, x, x + tile.width);
  const size_t left = columns.first, right = columns.second;
  if (left >= right) return;
  const auto [top, bottom] = covered(source.down, y, y + tile.height);
  const int64_t first = std::max(source.across.pixels[left].first, x);
  const IiifAxis::IiifTaps& rightmost = source.across.pixels[right - 1];
  const int64_t last = std::min(rightmost.first + rightmost.count, x + tile.width);
  std::vector<float> texels(size_t(last - first) * 3), averages((right - left) * 3);
  int64_t averaged = -1;  // row of the tile that `averages` holds
  const auto average_row = [&](int64_t row) {
    averaged = row;
    const uint8_t* codes = &tile.bytes[size_t(row * tile.width + first - x) * 4];
    for (size_t i = 0; i < texels.size(); i += 3, codes += 4)
      for (int c = 0; c < 3; c++) texels[i + size_t(c)] = missing(codes, c);
    for (size_t i = left; i < right; i++) {
      const IiifAxis::IiifTaps& taps = source.across.pixels[i];
      const int64_t begin = std::max(taps.first, x);
      const int64_t end = std::min(taps.first + taps.count, x + tile.width);
      const float* weights = &source.across.weights[taps.weight + size_t(begin - taps.first)];
      const float* texel = &texels[size_t(begin - first) * 3];
      float red = 0, green = 0, blue = 0;
      for (int64_t k = begin; k < end; k++, texel += 3, weights++)
        red += *weights * texel[0], green += *weights * texel[1], blue += *weights * texel[2];
      float* average = &averages[(i - left) * 3];
      average[0] = red, average[1] = green, average[2] = blue;
    }
  };
  for (size_t j = top; j < bottom; j++) {
    const IiifAxis::IiifTaps& taps = source.down.pixels[j];
    const int64_t begin = std::max(taps.first, y);
    const int64_t end = std::min(taps.first + taps.count, y + tile.height);
    float* to = &colors[(j * size_t(width) + left) * 3];
    for (int64_t k = begin; k < end; k++) {
      if (averaged != k - y) average_row(k - y);
      const float weight = source.down.weights[taps.weight + size_t(k - taps.first)];
      for (size_t i = 0; i < averages.size(); i++) to[i] -= weight * averages[i];
    }
  }
}

// Turns colours into greys of the same luminance (ITU-R BT.709), or into black and white.
void take_color(Image8& image, bool is_bitonal) {
  for (size_t i = 0; i < image.rgb.size(); i += 3) {
    const uint8_t* rgb = &image.rgb[i];
    const uint8_t grey =
        srgb().encode(0.2126f * image::decode_srgb(rgb[0]) + 0.7152f * image::decode_srgb(rgb[1]) +
                      0.0722f * image::decode_srgb(rgb[2]));
    std::fill_n(&image.rgb[i], 3, is_bitonal ? uint8_t(grey < 128 ? 0 : 255) : grey);
  }
}

// Mirrors, then turns clockwise.
Image8 turned(Image8 image, bool is_mirrored, int quarters) {
  if (!is_mirrored && quarters == 0) return image;
  Image8 made{image.width, image.height, std::vector<uint8_t>(image.rgb.size())};
  if (quarters % 2 == 1) std::swap(made.width, made.height);
  uint8_t* to = made.rgb.data();
  for (int y = 0; y < made.height; y++)
    for (int x = 0; x < made.width; x++, to += 3) {
      int column = x, row = y;
      if (quarters == 1) column = y, row = image.height - 1 - x;
      else if (quarters == 2) column = image.width - 1 - x, row = image.height - 1 - y;
      else if (quarters == 3) column = image.width - 1 - y, row = x;
      if (is_mirrored) column = image.width - 1 - column;
      std::copy_n(&image.rgb[(size_t(row) * size_t(image.width) + size_t(column)) * 3], 3, to);
    }
  return made;
}

bool is_rounded(int64_t side, int64_t finest, int64_t scale) {
  return side == std::max<int64_t>(finest / scale, 1) || side == (finest + scale - 1) / scale;
}

}  // namespace

int64_t iiif_scale(const PyramidLevel& level, const PyramidLevel& finest) {
  const double ratio =
      double(std::max(finest.width, finest.height)) / double(std::max(level.width, level.height));
  for (const int64_t scale : {int64_t(1) << std::llround(std::log2(std::max(ratio, 1.0))),
                              int64_t(std::llround(std::max(ratio, 1.0)))})
    if (is_rounded(level.width, finest.width, scale) &&
        is_rounded(level.height, finest.height, scale))
      return scale;
  return 0;
}

std::vector<uint8_t> find_iiif_tile(const PicturePyramid& pyramid, const IiifRequest& request) {
  if (!request.is_plain() || request.format != IiifRequest::Format::jpg) return {};
  const std::vector<PyramidLevel>& levels = pyramid.levels();
  for (size_t i = 0; i < levels.size(); i++) {
    const PyramidLevel& level = levels[i];
    const int64_t scale = iiif_scale(level, levels[0]);
    if (scale == 0) continue;
    const int64_t wide = level.tile_width * scale, high = level.tile_height * scale;
    const int64_t column = request.x / wide, row = request.y / high;
    if (request.x % wide != 0 || request.y % high != 0 || column >= level.columns() ||
        row >= level.rows() ||
        request.region_width != std::min(wide, levels[0].width - request.x) ||
        request.region_height != std::min(high, levels[0].height - request.y) ||
        request.width != level.width_at(int(column)) || request.height != level.height_at(int(row)))
      continue;
    return pyramid.stored_jpeg({1, int(i), uint32_t(column), uint32_t(row)});
  }
  return {};
}

int64_t iiif_cost(const PicturePyramid& pyramid, const IiifRequest& request) {
  const PyramidLevel& finest = pyramid.levels()[0];
  const PyramidLevel& level = pyramid.levels()[size_t(choose_level(pyramid.levels(), request))];
  const double share = double(request.region_width) / double(finest.width) *
                       double(request.region_height) / double(finest.height);
  return int64_t(share * double(level.width) * double(level.height)) +
         int64_t(request.width) * request.height;
}

Image8 make_iiif_image(const PicturePyramid& pyramid, const IiifRequest& request) {
  const IiifSource source = choose_source(pyramid, request);
  Image8 image{request.width, request.height, {}};
  const size_t codes = size_t(request.width) * size_t(request.height) * 3;
  if (source.across.is_copy && source.down.is_copy) {
    image.rgb.assign(codes, 255);
    each_tile(pyramid, source, [&](const Piece& tile, int64_t x, int64_t y) {
      copy_tile(tile, x, y, source, image);
    });
  } else {
    std::vector<float> colors(codes, 1.0f);
    each_tile(pyramid, source, [&](const Piece& tile, int64_t x, int64_t y) {
      average_tile(tile, x, y, source, request.width, colors);
    });
    image.rgb.resize(codes);
    std::ranges::transform(colors, image.rgb.begin(),
                           [&encoder = srgb()](float color) { return encoder.encode(color); });
  }
  if (request.quality != IiifRequest::Quality::color)
    take_color(image, request.quality == IiifRequest::Quality::bitonal);
  return turned(std::move(image), request.is_mirrored, request.quarter_turns);
}

}  // namespace wellspring::show
