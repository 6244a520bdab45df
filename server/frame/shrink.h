// SPDX-License-Identifier: Apache-2.0
// A picture in fewer pixels: each is the mean of the area that it covers.
#pragma once
#include "frame/frame.h"

namespace wellspring::frame {

// width and height: at least 1, at most the picture's. Bytes are averaged as they are, in sRGB:
// what is shown small for a moment need not be exact.
Image8 shrink(const Image8& image, int width, int height);

}  // namespace wellspring::frame
