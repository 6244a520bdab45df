// SPDX-License-Identifier: Apache-2.0
// The log: one line an event on stderr, level names as spdlog's. WELLSPRING_LOG=debug shows more.
// Usage: log::info("exhibit {} loaded in {:.1f} s", id, seconds);
#pragma once
#include <spdlog/spdlog.h>

namespace wellspring::log {
using spdlog::debug;
using spdlog::error;
using spdlog::info;
using spdlog::warn;

// Sends the log to stderr and reads WELLSPRING_LOG. Call once at the start of main().
void start(const char* program);
}  // namespace wellspring::log
