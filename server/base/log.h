// SPDX-License-Identifier: Apache-2.0
// The log: one line an event on stderr, or where log.h says. WELLSPRING_LOG=debug shows
// more. Usage: log::info("exhibit {} loaded in {:.1f} s", id, seconds); Formats are checked when
// they are compiled; lines are put together in log.cpp alone, since what does that takes seconds to
// compile.
#pragma once
#include <fmt/core.h>
#include <string>
#include <vector>

#include "base/layers.h"

namespace wellspring::log {

enum class Level { debug, info, warn, error };

// One line, when lines of that level are shown. Any thread.
void write(Level level, fmt::string_view format, fmt::format_args arguments);

template <class... T>
void debug(fmt::format_string<T...> format, T&&... arguments) {
  write(Level::debug, format, fmt::make_format_args(arguments...));
}
template <class... T>
void info(fmt::format_string<T...> format, T&&... arguments) {
  write(Level::info, format, fmt::make_format_args(arguments...));
}
template <class... T>
void warn(fmt::format_string<T...> format, T&&... arguments) {
  write(Level::warn, format, fmt::make_format_args(arguments...));
}
template <class... T>
void error(fmt::format_string<T...> format, T&&... arguments) {
  write(Level::error, format, fmt::make_format_args(arguments...));
}

// Sends the log to stderr, with the journal's marks where that is the journal (systemd), and reads
// WELLSPRING_LOG. Call once at the start of main().
void start(const char* program);

// Where the log's lines go, and which are shown: for main() alone.

// Names of levels, from the most talkative.
std::vector<std::string> levels();
void set_level(const std::string& name);  // one of levels(); any thread

// From now on to the end of this file instead of stderr. Lines that cannot be written, say on a
// full disk, are lost and counted; the next that can be tells how many. Throws std::runtime_error
// where the file cannot be opened. Before other threads begin.
void send_to(const std::string& file);

// Opens that file anew, as it must after it was renamed (logrotate). Where it cannot be opened, the
// old one goes on. Any thread.
void reopen();

}  // namespace wellspring::log
