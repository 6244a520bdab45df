// SPDX-License-Identifier: Apache-2.0
// A ledger's file of SQLite, read and written.
#include <filesystem>

#include "fuzz/fuzz.h"
#include "ledger/sums.h"

namespace wellspring::fuzz {

void fuzz_sums_file(Bytes bytes) {
  constexpr int64_t first = -1'000'000, last = 1'000'000;
  std::filesystem::create_directory(folder().path / "sums");  // for what is put aside, too
  const std::string file = write_file("sums/fuzz.sqlite", bytes);
  try {
    write_csv(read_from_file(file, first, last, 10));
  } catch (const std::runtime_error&) {}
  const SumKey key{20000, "visits", "fuzz"};
  try {
    add_to_file(file, {{key, 1}}, 10);
    require(read_from_file(file, first, last, 10).contains(key), "what was added is there");
  } catch (const std::runtime_error&) {}
  std::filesystem::remove_all(folder().path / "sums");
}

}  // namespace wellspring::fuzz
