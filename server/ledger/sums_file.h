// SPDX-License-Identifier: Apache-2.0
// The file of a ledger: a table of day, what, key and value, in write-ahead mode. It is opened for
// each use, so that it may be copied, moved or mended while servers run.
#pragma once
#include <string>

#include "ledger/sums.h"

namespace wellspring::ledger {

// Adds to what stands there, in one transaction; makes file and folder. A damaged file is renamed
// to FILE.damaged-YYYYMMDD-HHMMSS, logged, and begun anew. Throws std::runtime_error where it
// cannot be written, or is locked for longer than `patience` milliseconds: then nothing is.
void add_to_file(const std::string& file, const Sums& sums, int patience);

// Nothing, where there is no file. Throws std::runtime_error where it cannot be read.
Sums read_from_file(const std::string& file, int64_t from, int64_t to, int patience);

}  // namespace wellspring::ledger
