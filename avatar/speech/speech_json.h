// SPDX-License-Identifier: Apache-2.0
// Reads and writes speech as JSON, for people who correct marks by hand and for programs. Times are
// in seconds from the beginning of the sound; characters are Unicode code points of "text", [first,
// past the last].
//
//   {"version": 1, "text": "...", "lang": "en", "rate": 22050, "duration": 1.23,
//    "words":    [{"text": "tower", "start": 0.10, "end": 0.52, "characters": [4, 9]}, ...],
//    "phonemes": [{"phoneme": "t", "ipa": "t", "start": 0.10, "end": 0.17, "word": 0}, ...],
//    "visemes":  [{"time": 0.12, "viseme": "DD", "weight": 0.5}, ...]}
//
// A pause, or a sound that is no part of the words (a speaker stutters), has "word" -1. Visemes are
// keys: each mouth shape goes from one of its keys to its next by a smooth step (3x^2 - 2x^3);
// before its first key and after its last it keeps that key's weight.
//
// In marks edited by hand, words rule: move "start" and "end" of words; when the file is read, the
// phonemes of every word are stretched into it, pauses fill the rest, and the visemes are made
// anew. "phonemes" may be edited within a word; "visemes" and fields not named here are ignored.
#pragma once
#include <memory>
#include <string>
#include <string_view>

#include "avatar/speech/process.h"
#include "avatar/speech/speech.h"

namespace wellspring::avatar {

std::string write_speech_json(const Speech& speech);

// Reads marks without a sound: pcm is empty, duration is the file's. `file` names the source in
// errors. Throws LoadError with a JSON pointer: no JSON, wrong types, times not finite, negative,
// out of order or beyond the duration, characters outside the text, more than a million entries.
Speech load_speech_marks(std::string_view json, const std::string& file);

// Keeps speech on disk from one start of an exhibit to the next, one file a request. A file that is
// damaged, or belongs to another request with the same name, counts as missing. Nothing here
// throws; a folder that cannot be written is logged once.

// Returns everything that decides the sound of a request, as one string.
std::string speech_key(const SpeechRequest& request);

class SpeechFolder {
 public:
  // `path` empty: keeps nothing. Files beyond `most_bytes` are removed, the oldest first. Files
  // older than the file `made_by`, the voice program, count as missing: it may speak otherwise now.
  SpeechFolder(std::string path, size_t most_bytes, std::string made_by = {});
  std::shared_ptr<const Speech> load(const SpeechRequest& request) const;
  void save(const SpeechRequest& request, const Speech& speech);

 private:
  std::string path_;
  size_t most_bytes_ = 0;
  std::string made_by_;
  bool said_ = false;  // whether a failure to write was logged
};

}  // namespace wellspring::avatar
