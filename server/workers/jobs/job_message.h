// SPDX-License-Identifier: Apache-2.0
// Writes and reads what the queue of jobs holds, as little-endian bytes with a seal (sealed.h).
#pragma once
#include <string>
#include <string_view>

#include "workers/jobs/job.h"
#include "workers/sealed.h"

namespace wellspring::workers {

inline constexpr size_t most_reason_bytes = 2000;

std::string write_job(const JobOrder& order, const MessageKey& key);
std::string write_job(const ShardTask& task, const MessageKey& key);
std::string write_job(const JobEvent& event, const MessageKey& key);

// Return false if the bytes are no such message: cut off, too long, out of range, or not sealed by
// the key. Whether the words of an order may be run, check_words() says.
bool read_job(std::string_view bytes, const MessageKey& key, JobOrder& order);
bool read_job(std::string_view bytes, const MessageKey& key, ShardTask& task);
bool read_job(std::string_view bytes, const MessageKey& key, JobEvent& event);

}  // namespace wellspring::workers
