// SPDX-License-Identifier: Apache-2.0
// The Earth Mover's Distance of two sets (P06, eq. 1): the least work by which the masses of one
// become those of the other. Since masses sum to 1 and the ground distance is a metric, it is one,
// too.
#pragma once
#include <cmath>

#include "collection/set_item.h"

namespace wellspring::collection {

// Returns the distance; exact but for rounding. Shortest augmenting paths over the transportation
// problem: masses are whole numbers of a unit, so that each path moves some and none is lost.
// If the distance is above `enough`, any number above `enough` may come back, sooner: prices of the
// dual problem prove that it is farther.
double earth_mover(const SetView& a, const SetView& b, int dims, double enough = INFINITY);

// Returns the distance of the sets' weighted means, which is never above that of the sets.
double mean_distance(const SetView& a, const SetView& b, int dims);

}  // namespace wellspring::collection
