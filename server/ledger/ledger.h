// SPDX-License-Identifier: Apache-2.0
// Keeps daily sums in a file of SQLite: new counts are added to the sums in the file, by one
// transaction now and then, on a thread of its own. Several servers may write into one file. A
// server that is killed loses its counts since the last write.
#pragma once
#include <memory>
#include <string>

#include "ledger/sums.h"

namespace wellspring::ledger {

struct LedgerSettings {
  std::string file;     // made with its folder if missing
  double seconds = 60;  // time from one write to the next
  int patience = 5000;  // milliseconds to wait for another server's write
};

class Ledger {
 public:
  explicit Ledger(LedgerSettings settings);
  ~Ledger();  // writes what is left

  // Adds sums, and never waits for the disk. Sums of a later day than those before are written at
  // once. Sums from before 2020, by a clock that was never set, wait for the first later day and
  // count for it.
  void add(const Sums& sums);
  // Writes waiting sums now; false: they could not be written, see problem(), and wait on.
  bool write();
  // Returns the sums of the days from `from` to `to`, both included, in the file and waiting.
  // Throws std::runtime_error if the file cannot be read.
  Sums read(int64_t from, int64_t to) const;
  // Returns why the last write failed, for a technician; empty: it did not.
  std::string problem() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace wellspring::ledger
