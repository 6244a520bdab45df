// SPDX-License-Identifier: Apache-2.0
// Runs the voice program: starts it when it is first needed, keeps it warm, and starts it again
// after a crash or a hang. One thread at a time may call; every call has a deadline. The program
// itself is GPL-3.0-or-later (voice/main.cpp); nothing of it is linked here.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "avatar/speech/protocol.h"
#include "avatar/speech/speech.h"

namespace wellspring::avatar {

struct VoiceProgram {
  std::string path;           // empty: WELLSPRING_VOICE, else wellspring_voice beside this program
  double start_seconds = 10;  // time for its first message
  double answer_seconds = 25;
  double rest_seconds = 5;  // rest after three vain starts, before the next
};

// Returns the file that is started.
std::string program_path(const VoiceProgram& program);

class SpeechProcess {
 public:
  explicit SpeechProcess(VoiceProgram program = {});
  ~SpeechProcess();
  SpeechProcess(const SpeechProcess&) = delete;
  SpeechProcess& operator=(const SpeechProcess&) = delete;

  // Blocks until the answer or a deadline. A request during which the program dies is sent once
  // more; one that hangs is not. Returns null with one sentence in `error`; logs each change of the
  // program's state once.
  std::shared_ptr<const Speech> speak(const SpeechRequest& request, std::string& error);

  int process_id() const;                             // 0: not running
  const std::vector<std::string>& languages() const;  // empty before the first start

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace wellspring::avatar
