// SPDX-License-Identifier: Apache-2.0
// A made place to be scanned: a hall of stone, 24 x 16 m, with windows and columns.
#pragma once
#include <cstdint>
#include <memory>

#include "scan/camera.h"
#include "scan/points.h"

namespace wellspring::test {

// Says from where it was measured: from everywhere, so that points are evenly spread, or from two
// stations, so that they are the farther apart the farther away and the more aslant they were seen.
enum class SiteScan { everywhere, stations };

// Gives so many points of its surfaces, in no order, each off by some millimetre. Metres, +Y up;
// the floor's middle is the origin.
std::unique_ptr<scan::PointSource> made_site(uint64_t points, SiteScan scan = SiteScan::everywhere);

// Returns a view of it from a corner, 1280 x 720.
scan::ScanCamera made_site_view();

}  // namespace wellspring::test
