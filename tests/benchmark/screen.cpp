// SPDX-License-Identifier: Apache-2.0
#include "screen.h"

#include <algorithm>
#include <cmath>

#include "image/image.h"

namespace wellspring::test {
namespace {

Image8 make_black(int width, int height) {
  return {width, height, std::vector<uint8_t>(3 * size_t(width) * size_t(height))};
}

// Places `part` at (x, y), as far as the canvas goes.
void paste(const Image8& part, int x, int y, Image8& canvas) {
  const int columns = std::min(part.width, canvas.width - x);
  const int rows = std::min(part.height, canvas.height - y);
  for (int row = 0; row < rows; row++) {
    const auto from = part.rgb.begin() + 3 * ptrdiff_t(row) * part.width;
    std::copy_n(from, 3 * std::max(columns, 0),
                canvas.rgb.begin() + 3 * (ptrdiff_t(y + row) * canvas.width + x));
  }
}

}  // namespace

Screen::Screen(int width, int height)
    : width_(width), height_(height), canvas_(make_black(width, height)) {}

bool Screen::receive(std::span<const uint8_t> message) {
  const auto packet = read_packet(message);
  if (!packet) return false;
  const PacketHeader& header = packet->header;
  if (header.flags & packet_complete) {
    canvas_ = decode_jpeg(packet->payload, "a picture of the server's");
    return true;
  }
  canvas_ = scale_picture(canvas_, header.width, header.height);
  paste_parts(*packet, canvas_);
  return true;
}

Image8 Screen::picture() const { return scale_picture(canvas_, width_, height_); }

void paste_parts(const PacketView& packet, Image8& canvas) {
  size_t at = 0;
  for (const PicturePart& part : packet.parts) {
    paste(decode_jpeg(packet.payload.subspan(at, part.bytes), "a part of the server's"), part.x,
          part.y, canvas);
    at += part.bytes;
  }
}

Image8 scale_picture(const Image8& picture, int width, int height) {
  if (picture.width == width && picture.height == height) return picture;
  Image8 scaled = make_black(width, height);
  const float across = float(picture.width) / float(width);
  const float down = float(picture.height) / float(height);
  for (int y = 0; y < height; y++)
    for (int x = 0; x < width; x++) {
      const float u = std::clamp((float(x) + 0.5f) * across - 0.5f, 0.0f, float(picture.width - 1));
      const float v = std::clamp((float(y) + 0.5f) * down - 0.5f, 0.0f, float(picture.height - 1));
      const int left = int(u), top = int(v);
      const int right = std::min(left + 1, picture.width - 1);
      const int bottom = std::min(top + 1, picture.height - 1);
      for (int c = 0; c < 3; c++) {
        auto at = [&](int column, int row) {
          return float(picture.rgb[size_t(3 * (row * picture.width + column) + c)]);
        };
        const float upper = std::lerp(at(left, top), at(right, top), u - float(left));
        const float lower = std::lerp(at(left, bottom), at(right, bottom), u - float(left));
        scaled.rgb[size_t(3 * (y * width + x) + c)] =
            uint8_t(std::lround(std::lerp(upper, lower, v - float(top))));
      }
    }
  return scaled;
}

}  // namespace wellspring::test
