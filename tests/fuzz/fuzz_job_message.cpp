// SPDX-License-Identifier: Apache-2.0
// What a queue of jobs may hold: orders, shards, news of them; and the words of an order, which are
// checked before anything runs.
#include <stdexcept>

#include "fuzz/fuzz.h"
#include "workers/jobs/job_message.h"
#include "workers/jobs/job_words.h"

namespace wellspring::fuzz {

void fuzz_job_message(Bytes bytes) {
  const std::string text = text_of(bytes);
  const MessageKey none;
  JobOrder order;
  if (read_job(text, none, order)) {
    require(is_job_name(order.job), "names are letters and digits");
    JobOrder again;
    require(read_job(write_job(order, none), none, again), "what is read can be written");
    try {
      for (const std::string& path : check_words(order.words, order.shards).paths())
        require(path[0] != '/' && path[0] != '-', "paths go downwards");
    } catch (const std::invalid_argument&) {
      // Most words are not allowed.
    }
  }
  ShardTask task;
  if (read_job(text, none, task)) require(task.shard < uint32_t(most_shards), "shards");
  JobEvent event;
  if (!read_job(text, none, event)) return;
  for (const ShardFile& file : event.files)
    require(is_file_name(file.name), "files lie in one folder");
  JobState state(JobOrder{event.job, "", "", 0, 4, {}});
  state.take(event);
  require(state.share() >= 0 && state.share() <= 1, "shares");
}

}  // namespace wellspring::fuzz
