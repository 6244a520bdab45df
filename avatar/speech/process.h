// SPDX-License-Identifier: Apache-2.0
// The voice program as this process sees it: started when first needed, kept warm, started again
// after a crash or a hang. One thread at a time; every call has a deadline. The program itself is
// GPL-3.0-or-later (voice/main.cpp); nothing of it is linked here.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "avatar/speech/speech.h"
#include "avatar/speech/style.h"

namespace wellspring {

struct SpeechRequest {
  std::string text;         // UTF-8, at most 10,000 bytes
  std::string lang = "en";  // BCP 47
  int words_per_minute = 155;  // 80 to 450
  int pitch = 45;              // 0 to 100
  std::string variant{};       // of the voice: eSpeak NG's "f3", "m2", ...; empty: its own
  std::vector<SpeechStyle> styles{};
  bool operator==(const SpeechRequest&) const = default;
};

// What is wrong with a request, in words that name it; empty when nothing is.
std::string check_speech_request(const SpeechRequest& request);

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

  int process_id() const;  // 0: not running
  const std::vector<std::string>& languages() const;  // empty before the first start

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace wellspring
