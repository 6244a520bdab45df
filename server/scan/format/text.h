// SPDX-License-Identifier: Apache-2.0
// Reads points from text, a point a line: XYZ, PTS, TXT, CSV. Blanks, tabs, commas and semicolons
// separate numbers. Lines that begin with # or // are comments. The first line may name columns, or
// say how many points follow, as in PTS of Leica; PTS may hold several clouds, each behind a count.
#pragma once
#include <memory>
#include <string>
#include <string_view>

#include "scan/points.h"

namespace wellspring::scan {

// Throws LoadError that names the line.
std::unique_ptr<PointSource> open_text(const std::string& path);

// Says whether bytes of a file's begin may be such a text.
bool may_be_text(std::string_view head);

}  // namespace wellspring::scan
