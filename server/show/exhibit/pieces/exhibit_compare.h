// SPDX-License-Identifier: Apache-2.0
// Lets a volume show how true a model of it is: colours of the distances between both.
#pragma once
#include <string>

#include "show/exhibit/exhibit.h"

namespace wellspring::show {

// Compares the file of a model, glTF, STL or PLY, with that of the piece's volume, which was read,
// and fills the layer: its volume, comparison, and a preset that shows the surface of `outside`.
// Takes about a second. Throws LoadError that names file and place.
void compare_model(const std::string& model, const std::string& scan, const ExhibitPiece& piece,
                   const Preset& outside, PieceLayer& layer);

}  // namespace wellspring::show
