// SPDX-License-Identifier: Apache-2.0
// Where the log's lines go, and which are shown: for main() alone.
#pragma once
#include <string>
#include <vector>

namespace wellspring::log {

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
