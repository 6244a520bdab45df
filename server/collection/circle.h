// SPDX-License-Identifier: Apache-2.0
// A circle on a map becomes a ball in the collection (P06, section 5): maps distort, so items that
// lie within the circle only because of that must not widen the ball.
#pragma once
#include <span>
#include <vector>

#include "collection/distances.h"
#include "collection/layout.h"

namespace wellspring::collection {

struct CircleChoice {
  double alpha = 1;   // outliers are so many standard deviations below the mean local stress
  double lambda = 1;  // share of the non-outliers, the most similar, that the ball has to hold
};

// Holds what a circle around an item means. Indices count the items of the map.
struct CircleMeaning {
  std::vector<int> inside;           // the circle: K of the paper
  std::vector<int> outliers;         // indices that the map shows too near
  std::vector<double> local_stress;  // one for each inside (eq. 5); 1: the map is true there
  double mean = 0, deviation = 0;    // moments of the local stress
  double ball = 0;                   // the radius rho in the metric (eq. 7)
};

// Finds outliers and the ball. Equation 6 as it is printed names the outliers "non-outliers"; here
// outliers are those whose local stress is below the threshold, which the map shows too near. The
// item in the middle is never one.
CircleMeaning read_circle(const Layout& layout, const Distances& distances, int pivot,
                          double radius, const CircleChoice& choice = {});

// Says how many distances it took to find who is in a ball.
struct BallCost {
  int asked = 0, computed = 0;
};

// Returns those of `among` whose distance from `pivot` is at most `ball`: the item that the ball's
// radius is from belongs to it. `cost` may be null.
std::vector<int> select_ball(const Sets& sets, std::span<const int> among, int pivot, double ball,
                             BallCost* cost = nullptr);

}  // namespace wellspring::collection
