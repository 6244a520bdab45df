// SPDX-License-Identifier: Apache-2.0
#include "avatar/story/story_speech.h"

#include <algorithm>
#include <cmath>

#include "base/load_error.h"
#include "base/read_file.h"
#include "base/worker.h"

namespace wellspring::avatar {

namespace {

constexpr double seconds_a_byte = 0.06;  // reading time of text that nobody says

// Appends `line`, said at `at` seconds, to `all`.
void append(Speech& all, const Speech& line, double at) {
  uint32_t bytes = uint32_t(all.text.size());
  int words = int(all.words.size());
  all.text += line.text;
  for (SpeechWord word : line.words) {
    word.begin += at;
    word.end += at;
    word.text_begin += bytes;
    word.text_end += bytes;
    all.words.push_back(word);
  }
  for (SpeechPhoneme phoneme : line.phonemes) {
    phoneme.begin += at;
    phoneme.end += at;
    if (phoneme.word >= 0) phoneme.word += words;
    all.phonemes.push_back(std::move(phoneme));
  }
  for (VisemeKey key : line.visemes.keys) {
    key.time += at;
    if (all.visemes.keys.empty() || key.time > all.visemes.keys.back().time)
      all.visemes.keys.push_back(key);
  }
  all.pcm.insert(all.pcm.end(), line.pcm.begin(), line.pcm.end());
}

}  // namespace

std::vector<std::shared_ptr<const Speech>> speak_lines(SpeechProcess& process,
                                                       const std::vector<StoryLine>& lines,
                                                       SpeechRequest request,
                                                       const std::string& file) {
  std::vector<std::shared_ptr<const Speech>> spoken;
  for (const StoryLine& line : lines) {
    check_cancelled();
    request.text = line.text;
    request.styles = line.styles;
    std::string error;
    spoken.push_back(process.speak(request, error));
    if (!spoken.back()) throw LoadError(file, to_string(line.place), error);
  }
  return spoken;
}

StorySpeech join_lines(const std::vector<StoryLine>& lines,
                       const std::vector<std::shared_ptr<const Speech>>& spoken) {
  StorySpeech story;
  Speech& all = story.speech;
  for (const auto& speech : spoken)
    if (speech) {
      all.rate = speech->rate;
      all.lang = speech->lang;
      break;
    }
  for (size_t i = 0; i < lines.size(); i++) {
    if (i > 0) {
      double silence = story_breath + double(lines[i - 1].pause);
      all.pcm.resize(all.pcm.size() + size_t(std::lround(silence * all.rate)));
      all.text += '\n';
    }
    double begin = double(all.pcm.size()) / all.rate;
    story.begins.push_back(begin);
    const Speech* speech = i < spoken.size() ? spoken[i].get() : nullptr;
    if (speech && speech->rate == all.rate) {
      append(all, *speech, begin);
    } else {
      all.text += lines[i].text;
      all.pcm.resize(all.pcm.size() +
                     size_t(seconds_a_byte * double(lines[i].text.size()) * all.rate));
    }
    story.cues.push_back({begin, double(all.pcm.size()) / all.rate, lines[i].text, ""});
  }
  all.duration = double(all.pcm.size()) / all.rate;
  return story;
}

StoryScript load_story(const std::string& file) {
  const std::string text = read_file(file, most_markup_bytes, FileKind::regular_or_pipe);
  if (file.ends_with(".txt")) return read_plain_story(text, file);
  if (file.ends_with(".vtt")) return read_subtitle_story(text, file);
  return read_story(text, file);
}

}  // namespace wellspring::avatar
