// SPDX-License-Identifier: Apache-2.0
// Finds out what the columns of a text of points hold.
#pragma once
#include <string_view>
#include <vector>

#include "scan/format/column_source.h"

namespace wellspring::scan {

// Returns what the names in a line mean, as CloudCompare ("//X Y Z R G B") and tables have them; an
// empty list: it does not name x, y and z.
std::vector<Role> read_column_names(std::string_view line);

// Judges by number and range, as no line says: rows are the first points, equally long, at least 3.
// First is the place. Three columns whose squares sum to 1 are a normal; three of whole numbers up
// to 255, or 65535, or of 0 to 1, a colour; one column that is left is the intensity. If two places
// fit a colour, Leica's order has the intensity before it, others behind.
std::vector<Role> guess_columns(const std::vector<std::vector<double>>& rows, bool is_leica);

}  // namespace wellspring::scan
