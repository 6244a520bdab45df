// SPDX-License-Identifier: Apache-2.0
// The house file of `./wellspring run --house FILE` (docs/kiosk.md), checked as an exhibit is.
#pragma once
#include <string>
#include <vector>

#include "show/exhibit/exhibit.h"
#include "show/exhibit/problem.h"
#include "show/house/house.h"

namespace wellspring::show {

// Never throws; what is wrong is in `problems`. Its `kiosks` come into the exhibit: what is said of
// one that is there already takes the place of what was said.
HouseSettings read_house(const std::string& file, Exhibit& exhibit, std::vector<Problem>& problems);

// As above. Throws ExhibitError where a problem is fatal; logs the others.
HouseSettings load_house(const std::string& file, Exhibit& exhibit);

}  // namespace wellspring::show
