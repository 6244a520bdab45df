// SPDX-License-Identifier: Apache-2.0
// Speech kept on disk from one start of an exhibit to the next, one file a request. A file that is
// damaged, or of another request with the same name, counts as missing. Nothing here throws; a
// folder that cannot be written is said once.
#pragma once
#include <memory>
#include <string>

#include "avatar/speech/process.h"

namespace wellspring::avatar {

// Everything that decides the sound of a request, as one string.
std::string speech_key(const SpeechRequest& request);

class SpeechFolder {
 public:
  // `path` empty: keeps nothing. Files beyond `most_bytes` are removed, the oldest first. What is
  // older than the file `made_by`, the voice program, counts as missing: it may speak otherwise
  // now.
  SpeechFolder(std::string path, size_t most_bytes, std::string made_by = {});
  std::shared_ptr<const Speech> load(const SpeechRequest& request) const;
  void save(const SpeechRequest& request, const Speech& speech);

 private:
  std::string path_;
  size_t most_bytes_ = 0;
  std::string made_by_;
  bool said_ = false;  // that it cannot be written
};

}  // namespace wellspring::avatar
