// SPDX-License-Identifier: Apache-2.0
// The voice program as this process sees it: started when first needed, kept warm, started again
// after a crash or a hang. One thread at a time; every call has a deadline. The program itself is
// GPL-3.0-or-later (voice/main.cpp); nothing of it is linked here.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "avatar/speech/protocol.h"
#include "avatar/speech/speech.h"

namespace wellspring::avatar {

struct VoiceProgram {
  std::string path;           // empty: WELLSPRING_VOICE, else wellspring_voice beside this program
  double start_seconds = 10;  // until it has said hello
  double answer_seconds = 25;
  double rest_seconds = 5;  // after three starts that led to nothing, before the next
};

// The file that is started.
std::string program_path(const VoiceProgram& program);

class SpeechProcess {
 public:
  explicit SpeechProcess(VoiceProgram program = {});
  ~SpeechProcess();
  SpeechProcess(const SpeechProcess&) = delete;
  SpeechProcess& operator=(const SpeechProcess&) = delete;

  // Blocks until the answer or a deadline. A request during which the program dies is asked once
  // more; one that hangs is not. Returns null with one sentence in `error`; logs what happens to
  // the program once each time it changes.
  std::shared_ptr<const Speech> speak(const SpeechRequest& request, std::string& error);

  int process_id() const;                             // 0: not running
  const std::vector<std::string>& languages() const;  // empty before the first start

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace wellspring::avatar
