// SPDX-License-Identifier: Apache-2.0
// GET /api/v1/sums.csv?from=YYYY-MM-DD&to=YYYY-MM-DD: the daily sums, for a spreadsheet.
#pragma once
#include <functional>

#include "base/layers.h"
#include "ledger/sums.h"
#include "wire/http.h"

namespace wellspring::show {

// Those of both days and all between; throws where the file cannot be read. Empty: none are kept.
using ReadSums = std::function<Sums(int64_t from, int64_t to)>;

// For who has Access::status (show/http/access.h): 404 where no sums are kept, 400 for what is no
// day, 503 where the file cannot be read.
HttpReply answer_sums(const ReadSums& read, const HttpQuestion& question);

}  // namespace wellspring::show
