// SPDX-License-Identifier: Apache-2.0
// A report of measurements, which the technician's page shows.
#include "fuzz/fuzz.h"
#include "show/status/status.h"

namespace wellspring::fuzz {

void fuzz_bench_report(Bytes bytes) { read_speeds(write_file("fuzz.json", bytes)); }

}  // namespace wellspring::fuzz
