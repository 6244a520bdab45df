// SPDX-License-Identifier: Apache-2.0
// Defines a job, what is told of its shards, and its state: a function of all that was told, in
// whatever order and however often it arrives.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "base/shard.h"

namespace wellspring::workers {

inline constexpr size_t most_job_words = 512, most_word_bytes = 512, most_shard_files = 4096;

struct JobOrder {
  std::string job;                    // name, is_job_name()
  std::string version, instructions;  // as in Sameness
  uint64_t inputs = 0;                // number of all that it reads; the same on all machines
  uint32_t shards = 1;
  std::vector<std::string> words;  // "bake", "content/ID", "--passes", "64"
};

// Is one shard in the queue.
struct ShardTask {
  std::string job;
  uint32_t shard = 0, failures = 0;
};

using FileDigest = std::array<uint8_t, 32>;  // BLAKE2b of all its bytes
struct ShardFile {
  std::string name;
  FileDigest digest{};
  uint64_t size = 0;  // bytes
  bool operator==(const ShardFile&) const = default;
};

// Kinds stand in the order in which they follow one another in one attempt.
enum class JobNews : uint8_t { waits, works, refused, failed, dead, done };
inline constexpr int job_news = 6;
const char* to_word(JobNews news);

// Tells what happened to a shard. An attempt is the place of its message in the queue, and how
// often that message was handed out.
struct JobEvent {
  std::string job;
  uint32_t shard = 0;
  JobNews news = JobNews::waits;
  uint64_t place = 0, delivery = 0;
  float share = 0;               // share of its work that is done, while it works
  std::string worker;            // name
  std::string reason;            // why it was refused, failed or is dead
  float seconds = 0;             // time that a done shard took
  std::vector<ShardFile> files;  // made by a done shard
};

// Returns whether `a` tells more recent things of a shard than `b`. A done shard stays done.
bool is_later(const JobEvent& a, const JobEvent& b);

// Holds a job and the last that is known of each shard.
struct JobState {
  JobOrder order;
  std::vector<JobEvent> shards;
  explicit JobState(JobOrder order);
  void take(const JobEvent& event);  // is dropped if it is of another job
  size_t count(JobNews news) const;
  double share() const;  // share of all its work that is done
};

// Returns whether the text can be a job's name: 1 to 64 letters, digits and '-'.
bool is_job_name(std::string_view name);
// Returns whether the text can be the name of a file of a shard: letters, digits, '.', '-' and '_',
// which begin with no dot.
bool is_file_name(std::string_view name);

}  // namespace wellspring::workers
