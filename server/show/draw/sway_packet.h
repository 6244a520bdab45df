// SPDX-License-Identifier: Apache-2.0
// Tells a page that draws by itself how grass sways, so that it moves between the pictures it gets.
#pragma once
#include "picture/sway_image.h"
#include "wire/packet.h"
#include "world/view.h"

namespace wellspring::show {

// Adds it to the packet of a keyframe of that view, or of its parts. Without codes, or without a
// packet, nothing is added.
void add_sway(const SwayImage& image, const View& view, Packet& packet);

}  // namespace wellspring::show
