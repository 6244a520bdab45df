// SPDX-License-Identifier: Apache-2.0
// What surfaces emit where points lie (Sample::glow): kept while pictures are made of points alone,
// which then show it. Who is drawn pictures keeps none, as drawing knows it from texel to texel, so
// that points remember the same light (PointColor::rest) whichever way pictures are made.
#pragma once
#include "cache/point_cache.h"

namespace wellspring {

struct Surface;

// Whether points of this instance may emit light and reflect other light, too, as it looks now.
bool may_glow(const World& world, uint32_t instance);
// Finds anew what all points emit, by where they lie on the world's surfaces and by the tint that
// their reflectance has of panes before them; of light that panes emit themselves nothing is known
// until the next sample. Takes memory only where something does. Microseconds for each point of an
// object that shines somewhere, on many threads.
void learn_glow(PointCache& points, const World& world);
// Points keep it from now on, none of them any yet.
void begin_glow(PointCache& points);
void forget_glow(PointCache& points);
// Of a surface with a point whose reflectance is packed `albedo`.
uint32_t pack_glow(const World& world, const Surface& surface, uint32_t albedo);

}  // namespace wellspring
