// SPDX-License-Identifier: Apache-2.0
// A sentence and how it was spoken, kept in a folder.
#pragma once
#include <filesystem>

#include "avatar/speech/speech_json.h"
#include "base/layers.h"

namespace wellspring::fuzz {

inline SpeechRequest spoken_request() { return {.text = "The tower."}; }

// The name of the file in which `folder` keeps it.
inline std::string keep_speech(const std::string& folder) {
  Speech speech;
  speech.text = spoken_request().text;
  speech.lang = "en";
  speech.rate = 16000;
  speech.pcm.assign(800, 100);
  speech.duration = 0.05;
  speech.words = {{0, 0.02, 0, 3}, {0.02, 0.05, 4, 9}};
  SpeechFolder(folder, 1 << 20).save(spoken_request(), speech);
  return std::filesystem::directory_iterator(folder)->path().filename().string();
}

}  // namespace wellspring::fuzz
