// SPDX-License-Identifier: Apache-2.0
// Makes parts of pictures at rest: only tiles that have changed are sent, and when they have been
// the same for a moment, once more in near-lossless quality. Each packet is small enough not to be
// in the way of what comes after, so a slow line gets a picture at rest piece by piece, and a step
// of the visitor cancels what is left. Called on the encoder's thread.
#pragma once
#include <vector>

#include "show/state/visitor.h"
#include "wire/packet.h"

namespace wellspring::show {

struct PartsOrder {
  int quality = 82;          // JPEG quality of tiles that have changed
  bool full_chroma = false;  // likewise for these tiles
  // quality of tiles that have not changed for a while; 0: they are left as they are
  int fine_quality = 95;
  double quiet = 0.5;             // seconds without a change until a tile is made fine
  double now = 0;                 // seconds
  double bytes = 1e9;             // bytes of the packet at most, about
  double bytes_per_pixel = 0.09;  // at quality 50
  bool must = false;              // an empty packet, too, is news
};

// Writes the whole packet, or leaves it empty if there is nothing to send. `has` then holds what
// the packet holds. A packet of fine parts alone has their quality in its header.
void make_parts(const Image8& newest, const PartsOrder& order, PacketHeader header,
                BrowserPicture& has, Packet& packet);
// Notes a complete picture in `has`. in_full: it was not made smaller.
void note_complete(const Image8& newest, int quality, bool in_full, double now,
                   BrowserPicture& has);

}  // namespace wellspring::show
