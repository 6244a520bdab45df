// SPDX-License-Identifier: Apache-2.0
// Runs `wellspring speak "TEXT"`: makes the sound of a text, and finds when each word, phoneme and
// mouth shape of it comes; or, with a recording of the text, when they come in the recording.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <sstream>

#include "about/version.h"
#include "avatar/align/align.h"
#include "avatar/speech/process.h"
#include "avatar/speech/sound_file.h"
#include "avatar/speech/speech_json.h"
#include "avatar/story/recorded_story.h"
#include "avatar/story/story_script.h"
#include "avatar/story/story_speech.h"
#include "base/load_error.h"
#include "base/log.h"
#include "base/read_file.h"
#include "base/write_file.h"

namespace wellspring::program {
namespace {

struct Options {
  SpeechRequest request;
  std::string audio, marks, wav, json, vtt, story;
};

// Prints the words with their phonemes, one line each.
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

Speech speak_text(SpeechProcess& process, const SpeechRequest& request) {
  std::string error;
  auto speech = process.speak(request, error);
  if (!speech) throw std::runtime_error(error);
  return *speech;
}

// Marks one sentence; a template at the narrator's own pace is nearer to the recording.
Speech mark_sentence(SpeechProcess& process, const Options& options, const Sound& recording) {
  Speech spoken = speak_text(process, options.request);
  SpeechRequest paced = options.request;
  double pace = measure_pace(spoken, recording);
  paced.words_per_minute = int(std::clamp(paced.words_per_minute / pace, 80.0, 450.0));
  try {
    return align_speech(speak_text(process, paced), recording);
  } catch (const LoadError&) {
    throw;
  } catch (const std::exception& error) {
    throw LoadError(options.audio, "", error.what());
  }
}

// Marks a narrator's recording of a whole story.
Speech mark_story(SpeechProcess& process, const std::vector<StoryLine>& lines,
                  const Options& options) {
  Sound recording = load_sound(options.audio);
  if (!options.marks.empty())
    return apply_marks(read_file(options.marks, most_marks_bytes, FileKind::regular_or_pipe),
                       options.marks, lines, recording);
  try {
    return mark_recording(process, lines, options.request, recording);
  } catch (const LoadError&) {
    throw;
  } catch (const std::exception& error) {
    throw LoadError(options.audio, "", error.what());
  }
}

// Speaks all sentences of a story, one after the other.
StorySpeech tell_story(const Options& options) {
  StoryScript script = load_story(options.story);
  for (const StoryNote& note : script.notes)
    std::cerr << "note: " << options.story << ": " << to_string(note.place) << ": " << note.what
              << "\n";
  SpeechProcess process;
  if (options.audio.empty())
    return join_lines(script.lines,
                      speak_lines(process, script.lines, options.request, options.story));
  StorySpeech story;
  story.speech = mark_story(process, script.lines, options);
  for (const StoryNote& note : doubtful_places(story.speech, script.lines))
    std::cerr << "note: " << options.story << ": " << to_string(note.place) << ": " << note.what
              << "\n";
  double begin = 0;
  for (const auto& part : divide_recording(story.speech, script.lines, 0)) {
    story.cues.push_back({begin, begin + part->duration, part->text, ""});
    begin += part->duration;
  }
  return story;
}

// Makes one subtitle a sentence for a text without a story's sentences.
std::vector<SubtitleCue> cues_of(const Speech& speech) {
  std::vector<SubtitleCue> cues;
  for (TextSpan span : find_sentences(speech.text)) {
    SubtitleCue cue{-1, 0, speech.text.substr(span.begin, span.end - span.begin), ""};
    for (const SpeechWord& word : speech.words) {
      if (word.text_end <= span.begin || word.text_begin >= span.end) continue;
      if (cue.begin < 0) cue.begin = word.begin;
      cue.end = word.end;
    }
    if (cue.begin >= 0) cues.push_back(std::move(cue));
  }
  return cues;
}

Speech read_marks(const Options& options, const Sound* recording) {
  std::string text = read_file(options.marks, most_marks_bytes, FileKind::regular_or_pipe);
  Speech speech = load_speech_marks(text, options.marks);
  if (speech.text != options.request.text)
    throw LoadError(options.marks, "/text", "is another text than the one given");
  if (recording) {
    double seconds = double(recording->samples.size()) / recording->rate;
    if (std::abs(seconds - speech.duration) > 0.01)
      throw LoadError(options.marks, "/duration", "is not that of " + options.audio);
    speech.pcm = to_pcm(recording->samples);
    speech.rate = recording->rate;
  }
  return speech;
}

Speech make_speech(const Options& options) {
  std::string error = check_speech_request(options.request);
  if (!error.empty()) throw std::runtime_error(error);
  Sound recording;
  if (!options.audio.empty()) recording = load_sound(options.audio);
  if (!options.marks.empty())
    return read_marks(options, options.audio.empty() ? nullptr : &recording);
  SpeechProcess process;
  if (options.audio.empty()) return speak_text(process, options.request);
  return mark_sentence(process, options, recording);
}

int run(const Options& options) {
  Speech speech;
  std::vector<SubtitleCue> cues;
  if (options.story.empty()) {
    speech = make_speech(options);
    cues = cues_of(speech);
  } else {
    StorySpeech story = tell_story(options);
    speech = std::move(story.speech);
    cues = std::move(story.cues);
  }
  if (!options.wav.empty()) {
    if (speech.pcm.empty()) throw LoadError(options.wav, "", "marks without --audio have no sound");
    write_file(options.wav, encode_wav(speech.pcm, speech.rate));
  }
  if (!options.json.empty()) {
    write_file(options.json, write_speech_json(speech));
  }
  if (!options.vtt.empty()) {
    write_file(options.vtt, write_subtitles(cues));
  }
  if (options.wav.empty() && options.json.empty() && options.vtt.empty()) print(speech);
  return 0;
}

}  // namespace
}  // namespace wellspring::program

int main(int argc, char** argv) {
  using namespace wellspring;
  using namespace wellspring::program;
  if (answer_version(argc, argv)) return 0;
  log::start("speak");
  CLI::App app{"Speaks a text, and tells when each word, phoneme and mouth shape of it comes."};
  Options options;
  auto* text = app.add_option("text", options.request.text, "what is to be said, UTF-8");
  auto* story =
      app.add_option("--story", options.story, "a .story, .ssml, .txt or .vtt file told instead");
  story->excludes(text);
  app.add_option("--variant", options.request.variant, "of the voice: f3, m2, ...");
  app.add_option("--vtt", options.vtt, "subtitles to write, WebVTT");
  app.add_option("--lang", options.request.lang, "language tag: en, de, sk, fr, es, ...");
  app.add_option("--words-per-minute", options.request.words_per_minute, "speed")
      ->check(CLI::Range(80, 450));
  app.add_option("--pitch", options.request.pitch, "of the voice, 0 to 100")
      ->check(CLI::Range(0, 100));
  app.add_option("--audio", options.audio,
                 "a recording of the text (WAV, FLAC, OGG, MP3): its times instead of a synthesis");
  app.add_option("--marks", options.marks,
                 "a file of --json, words perhaps moved by hand: its times, none computed");
  app.add_option("--wav", options.wav, "sound to write, 16 bits mono");
  app.add_option("--json", options.json, "times of words, phonemes and visemes to write");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  bool recorded = !options.audio.empty() || !options.marks.empty();
  if ((!*text && !*story) || (*story && recorded && options.audio.empty())) {
    std::cerr << "speak: "
              << (*story ? "--marks of a --story want its --audio" : "a text or --story is needed")
              << "\n";
    return 2;
  }
  try {
    return run(options);
  } catch (const std::exception& error) {
    std::cerr << "speak: " << error.what() << "\n";
    return 1;
  }
}
