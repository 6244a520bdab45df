// SPDX-License-Identifier: Apache-2.0
// Gives requests of a show's pictures to workers on other machines, and takes their samples: those
// of walking visitors go into the cache as late samples do; those of pictures at rest are added to
// the samples that were traced here, of a sequence of their own. Nothing waits for them, and
// without workers nothing changes.
#pragma once
#include "show/state/renderer.h"
#include "show/state/show.h"

namespace wellspring::show {

// Begins, if the settings name a NATS server. Throws std::invalid_argument for an address that is
// none. By whoever made the show, before the first tick.
void begin_workers(Show& show);

// These are called by the tick: the first in each, the second while the renderer is idle.
void mind_workers(Show& show);
void take_deliveries(Show& show);
// Returns how many requests of a picture workers would take now.
int room_of_workers(const Show& show, bool rests);

// These are called on the renderer, while the world is as the picture shows it.

// Sends what waits in a broker, at most `most` requests. Returns how many went out.
int send_waiting(Show& show, const PictureJob& job, Visitor& visitor, bool rests, int most);
// Asks for samples of a picture at rest that are traced elsewhere.
void ask_away(Show& show, const PictureJob& job, const Technique& technique,
              const TransportSettings& transport, DrawingWork& work, Visitor& visitor);
// Appends the samples that have come of a picture at rest, with their requests.
void add_away(const Show& show, const PictureJob& job, VisitorPicture& picture,
              std::vector<Request>& requests, std::vector<Sample>& samples);

}  // namespace wellspring::show
