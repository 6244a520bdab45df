// SPDX-License-Identifier: Apache-2.0
// Keeps jobs in NATS JetStream, by libnats, which connect.h shows. Three streams hold all: a work
// queue of shards, what was told of jobs (the last of each kind for each shard), and files that
// shards made, in parts by their content. All of it stands on the disk of the NATS server.
//
// A shard that somebody has taken is held by a sign of life now and then; without it the queue
// hands it to the next who asks, after a few seconds.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "workers/jobs/job.h"
#include "workers/sealed.h"
#include "workers/settings.h"

namespace wellspring::workers {

// Says in one sentence what NATS cannot do.
struct LineError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct LineSettings {
  ChannelSettings channel;
  MessageKey key;
  double store_gib = 4;  // room for files of shards on the NATS server
  // Whether what fails for want of a connection is tried again; called every half second.
  std::function<bool()> goes_on = [] { return false; };
};

class JobLine {
 public:
  // Connects and makes the streams that are not there. Throws LineError, and std::invalid_argument
  // for an address or a file that is wrong. All others may throw LineError, too.
  explicit JobLine(LineSettings settings);
  ~JobLine();
  JobLine(const JobLine&) = delete;
  JobLine& operator=(const JobLine&) = delete;

  // Puts a shard at the end of the queue. Returns its place. `once`: text by which the queue knows
  // that it has it already, for two minutes.
  uint64_t add(const ShardTask& task, const std::string& once);
  void tell(const JobOrder& order);
  void tell(const JobEvent& event);
  // Returns all jobs, or the named one if it is there, by name.
  std::vector<JobState> read(const std::string& job = "");
  // Takes the job with its shards and events out of all streams, and files that no other job has.
  void remove(const JobState& job, const std::vector<JobState>& others);

  // Holds a shard that was taken; its end gives up the sign of life.
  class Taken {
   public:
    Taken(void* message, ShardTask task, uint64_t place, uint64_t delivery);
    ~Taken();
    Taken(const Taken&) = delete;
    Taken& operator=(const Taken&) = delete;
    const ShardTask task;
    const uint64_t place, delivery;  // delivery: 1 for the first
    void end();                      // takes it out of the queue

   private:
    void* message_;
    std::jthread life_;
  };
  // Waits for a shard, at most about a second.
  std::unique_ptr<Taken> take();

  // Stores a file by its content; parts that are there already are not sent again.
  ShardFile put_file(const std::string& path, const std::string& name);
  // Writes a stored file. Throws LineError if it is not there, or its content is another.
  void get_file(const ShardFile& file, const std::string& path);

 private:
  struct Handles;
  void prepare();
  void need(const std::string& what, const std::function<int(int*)>& call);
  LineSettings settings_;
  std::unique_ptr<Handles> nats_;
};

}  // namespace wellspring::workers
