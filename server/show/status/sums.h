// SPDX-License-Identifier: Apache-2.0
// GET /api/v1/sums.csv?from=YYYY-MM-DD&to=YYYY-MM-DD: the daily sums, for a spreadsheet.
#pragma once
#include <functional>
#include <string>

#include "ledger/sums.h"
#include "wire/http.h"

namespace wellspring {

// Where they are read.
struct SumsDesk {
  std::string token;  // empty: everybody may read them, if `open`
  bool open = false;  // the server listens on this machine's own address alone
  // Of both days and those between; throws where the file cannot be read. Empty: nothing is kept.
  std::function<Sums(int64_t from, int64_t to)> read;
};

// 404 where no sums are kept, 401 without the right token where there is one, 403 where there is
// none on a server that others reach, 400 for what is no day, 503 where the file cannot be read.
HttpReply answer_sums(const SumsDesk& desk, const HttpQuestion& question);
// Who may read them: none, open or token.
const char* sums_access(const SumsDesk& desk);

}  // namespace wellspring
