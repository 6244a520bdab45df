// SPDX-License-Identifier: Apache-2.0
// wellspring speak "TEXT": the sound of a text, and when each word, phoneme and mouth shape of it
// comes; or, with a recording of the text, when they come in the recording.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <iostream>

#include "avatar/speech_json.h"
#include "avatar/speech_process.h"
#include "avatar/speech_shapes.h"
#include "avatar/speech_sound.h"
#include "base/load_error.h"
#include "base/log.h"

namespace wellspring {
namespace {

struct Options {
  SpeechRequest request;
  std::string wav, json;
};

// The words with their phonemes, one line each.
void print(const Speech& speech) {
  std::printf("%.3f s, %zu words, %zu phonemes\n", speech.duration, speech.words.size(),
              speech.phonemes.size());
  for (size_t i = 0; i < speech.words.size(); i++) {
    const SpeechWord& word = speech.words[i];
    std::string text = speech.text.substr(word.text_begin, word.text_end - word.text_begin);
    std::printf("%8.3f %8.3f  %s ", word.begin, word.end, text.c_str());
    for (const SpeechPhoneme& phoneme : speech.phonemes)
      if (phoneme.word == int(i)) std::printf(" %s@%.3f", phoneme.ipa.c_str(), phoneme.begin);
    std::printf("\n");
  }
}

int run(const Options& options) {
  SpeechProcess process;
  std::string error;
  auto speech = process.speak(options.request, error);
  if (!speech) {
    std::cerr << "speak: " << error << "\n";
    return 1;
  }
  if (!options.wav.empty()) {
    auto wav = encode_wav(speech->pcm, speech->rate);
    save_file(options.wav, wav.data(), wav.size());
  }
  if (!options.json.empty()) {
    std::string json = write_speech_json(*speech);
    save_file(options.json, json.data(), json.size());
  }
  if (options.wav.empty() && options.json.empty()) print(*speech);
  return 0;
}

}  // namespace
}  // namespace wellspring

int main(int argc, char** argv) {
  using namespace wellspring;
  log::start("speak");
  CLI::App app{"Speaks a text, and tells when each word, phoneme and mouth shape of it comes."};
  Options options;
  app.add_option("text", options.request.text, "what is to be said, UTF-8")->required();
  app.add_option("--lang", options.request.lang, "language tag: en, de, sk, fr, es, ...");
  app.add_option("--words-per-minute", options.request.words_per_minute, "speed")
      ->check(CLI::Range(80, 450));
  app.add_option("--pitch", options.request.pitch, "of the voice, 0 to 100")
      ->check(CLI::Range(0, 100));
  app.add_option("--wav", options.wav, "sound to write, 16 bits mono");
  app.add_option("--json", options.json, "times of words, phonemes and visemes to write");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    return run(options);
  } catch (const std::exception& error) {
    std::cerr << "speak: " << error.what() << "\n";
    return 1;
  }
}
