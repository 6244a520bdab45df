// SPDX-License-Identifier: Apache-2.0
// Makes speech for a running exhibit: it is asked for and fetched later, never waited for. A thread
// of its own talks to the voice program; speech that was said once is kept, in memory and, if
// wanted, in a folder.
//
//   Speaker speaker;
//   speaker.prepare(lines_of_the_exhibit);         // when it loads
//   auto answer = speaker.speak({text, lang});      // at once: a future
//   if (is_ready(answer)) use(answer.get());        // in a later tick
//
// All calls return within a lock's time and may come from any thread.
#pragma once
#include <chrono>
#include <cstdint>
#include <future>
#include <memory>
#include <string>
#include <vector>

#include "avatar/speech/process.h"

namespace wellspring::avatar {

struct SpeechAnswer {
  std::shared_ptr<const Speech> speech;  // null: `error` says why
  std::string error;
};

struct SpeakerOptions {
  VoiceProgram voice;
  size_t memory_bytes = 64 << 20;   // bytes of speech in memory; the least recently used goes first
  std::string folder;               // folder on disk for speech; made if missing; empty: none
  size_t folder_bytes = 256 << 20;  // the oldest files go first
  size_t most_waiting = 2000;       // number of requests; more are refused with an error
};

class Speaker {
 public:
  explicit Speaker(SpeakerOptions options = {});
  ~Speaker();  // waits for the request under way, at most the voice program's deadline
  Speaker(const Speaker&) = delete;
  Speaker& operator=(const Speaker&) = delete;

  // Asks for speech before everything that is only prepared. Equal requests under way share one
  // answer.
  std::shared_future<SpeechAnswer> speak(const SpeechRequest& request);
  // Asks for speech when nothing else is to do, so that speak() finds it.
  void prepare(const std::vector<SpeechRequest>& requests);
  // Returns speech that is kept in memory, or null.
  std::shared_ptr<const Speech> find(const SpeechRequest& request) const;

  struct Counts {
    int process_id = 0;   // the voice program's after the last request; 0: not running
    uint64_t starts = 0;  // starts of the voice program
    size_t waiting = 0, kept = 0, kept_bytes = 0;  // requests; speeches and bytes in memory
    uint64_t spoken = 0, from_folder = 0, from_memory = 0, failed = 0;  // since the start
  };
  Counts counts() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

inline bool is_ready(const std::shared_future<SpeechAnswer>& answer) {
  return answer.valid() && answer.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

}  // namespace wellspring::avatar
