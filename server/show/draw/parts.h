// SPDX-License-Identifier: Apache-2.0
// Of a picture at rest only tiles that have changed are sent, and when they have been the same for
// a moment, once more in near-lossless quality. Each packet is small enough not to be in the way of
// what comes after, so a slow line gets a picture at rest piece by piece, and a step of the visitor
// cancels what is left. Called on the encoder's thread.
#pragma once
#include <vector>

#include "show/state/visitor.h"
#include "wire/packet.h"

namespace wellspring::show {

struct PartsOrder {
  int quality = 82;               // of what has changed
  bool full_chroma = false;       // of the same
  int fine_quality = 95;          // of what has not for a while; 0: that is left as it is
  double quiet = 0.5;             // seconds that it has been the same until it is made fine
  double now = 0;                 // seconds
  double bytes = 1e9;             // about as many at most
  double bytes_per_pixel = 0.09;  // at quality 50
  bool must = false;              // an empty packet, too, is news
};

// Writes the whole packet, or leaves it empty: there is nothing to send. What it holds is in `has`
// from then on. A packet of fine parts alone has their quality in its header.
void make_parts(const Image8& newest, const PartsOrder& order, PacketHeader header,
                BrowserPicture& has, Packet& packet);
// After a complete picture. in_full: not made smaller.
void note_complete(const Image8& newest, int quality, bool in_full, double now,
                   BrowserPicture& has);

}  // namespace wellspring::show
