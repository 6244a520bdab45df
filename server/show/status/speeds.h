// SPDX-License-Identifier: Apache-2.0
// GET /api/v1/speeds: speed against error of all techniques, from a file of `./wellspring bench`.
#pragma once
#include <string>

namespace wellspring::show {

// {"date", "commit", "cpu", "cores", "points": [{technique, scene, spp, seconds (of all threads),
// flip}]}, or {"problem"}: why there are none. Reads the file each time.
std::string read_speeds(const std::string& file);

}  // namespace wellspring::show
