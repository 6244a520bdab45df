// SPDX-License-Identifier: Apache-2.0
// Keeps daily sums in a file of SQLite: what is counted is added to what stands there, by one
// transaction now and then, on a thread of its own. Several servers may write into one file. Ended
// by force, a server loses what was counted since the last write.
#pragma once
#include <memory>
#include <string>

#include "ledger/sums.h"

namespace wellspring::ledger {

struct LedgerSettings {
  std::string file;     // its folder is made where there is none
  double seconds = 60;  // from one write to the next
  int patience = 5000;  // milliseconds for another server's write to end
};

class Ledger {
 public:
  explicit Ledger(LedgerSettings settings);
  ~Ledger();  // writes what is left

  // Never waits for the disk. Sums of a later day than those before are written at once. Those of a
  // clock that was never set, before 2020, wait for the first later day, and are its.
  void add(const Sums& sums);
  // Writes now what waits; false: could not, see problem(). It waits on.
  bool write();
  // Of the days `from` to `to`, both among them: what is kept, and what waits. Throws
  // std::runtime_error where the file cannot be read.
  Sums read(int64_t from, int64_t to) const;
  // Why the last write failed, for a technician; empty: it did not.
  std::string problem() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace wellspring::ledger
