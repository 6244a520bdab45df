// SPDX-License-Identifier: Apache-2.0
// A ledger's file of SQLite.
#include <filesystem>

#include "fuzz/fuzz.h"
#include "ledger/sums_file.h"

namespace wellspring::fuzz {

void fuzz_sums_file(Bytes bytes) {
  const std::string file = write_file("fuzz.sqlite", bytes);
  try {
    write_csv(read_from_file(file, -1'000'000, 1'000'000, 10));
  } catch (const std::runtime_error&) {}
  for (const char* end : {"-wal", "-shm", "-journal"}) std::filesystem::remove(file + end);
}

}  // namespace wellspring::fuzz
