// SPDX-License-Identifier: Apache-2.0
// Shows the pictures that a visitor is sent as the page does (web/picture.js).
#pragma once
#include <cstdint>
#include <span>

#include "frame/frame.h"
#include "wire/packet.h"

namespace wellspring::test {

class Screen {
 public:
  Screen(int width, int height);  // black
  // Takes a binary message. False: it is no picture. Throws LoadError where a JPEG is damaged.
  bool receive(std::span<const uint8_t> message);
  // Returns a picture as large as the screen: pictures of other sizes are scaled, as the page
  // scales its canvas.
  Image8 picture() const;

 private:
  int width_, height_;
  Image8 canvas_;
};

// Places the parts of a picture that is not complete. Throws LoadError where a JPEG is damaged.
void paste_parts(const PacketView& packet, Image8& canvas);
// Bilinear between the middles of pixels; bytes are mixed as they are, as browsers do.
Image8 scale_picture(const Image8& picture, int width, int height);

}  // namespace wellspring::test
