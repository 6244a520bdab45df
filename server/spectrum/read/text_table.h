// SPDX-License-Identifier: Apache-2.0
// Takes tables of text apart: lines of cells between commas, semicolons, tabs or blanks.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/layers.h"

namespace wellspring::spectrum {

struct TextRow {
  int line = 0;  // from 1
  std::vector<std::string> cells;
};

// Holds the first line that is not all numbers as names, if there is one, and all rows after it,
// each with as many cells. Empty lines and those that begin with '#' are left out.
struct TextTable {
  std::vector<std::string> names;  // empty: the table has none
  int names_line = 0;
  std::vector<TextRow> rows;
};

// Takes a text apart. Cells may stand in quotes. Between semicolons or tabs a comma is a decimal
// point. Throws LoadError of `file` for rows of different lengths, and for more than 4096 columns
// or 4 million cells.
TextTable read_text_table(const std::string& file, std::string_view text);

// Says what a cell holds: a number, nothing ("", "NaN", "-", "n/a"), or a word.
enum class CellKind : uint8_t { number, missing, word };
CellKind read_cell(const std::string& cell, double& number);

}  // namespace wellspring::spectrum
