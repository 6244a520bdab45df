// SPDX-License-Identifier: Apache-2.0
#include "avatar/story/recorded_story.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "avatar/align/align.h"
#include "avatar/align/features.h"
#include "avatar/speech/speech_json.h"
#include "avatar/story/story_speech.h"
#include "base/load_error.h"

namespace wellspring::avatar {

namespace {

constexpr double doubtful_rate = 2;   // factor over or under the sentences' median rate
constexpr double doubtful_words = 2;  // seconds of words that are not in the text
constexpr double doubtful_word = 3;   // factor over the time that its letters let expect
constexpr double shortest_overlap = 1e-3;

// Finds the words of the lines' text: those of line i are [first[i], first[i + 1]).
std::vector<size_t> first_words(const Speech& marked, const std::vector<StoryLine>& lines) {
  std::vector<size_t> first;
  size_t byte = 0, word = 0;
  for (const StoryLine& line : lines) {
    while (word < marked.words.size() && marked.words[word].text_begin < byte) word++;
    first.push_back(word);
    byte += line.text.size() + 1;
  }
  first.push_back(marked.words.size());
  return first;
}

std::string seconds(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f s", value);
  return text;
}

Speech speak_all(SpeechProcess& process, const std::vector<StoryLine>& lines,
                 const SpeechRequest& voice) {
  return join_lines(lines, speak_lines(process, lines, voice, "")).speech;
}

// Cuts out a speech from `from` to `to` seconds, with the words [first, last) and `text`.
std::shared_ptr<const Speech> cut(const Speech& all, double from, double to, size_t first,
                                  size_t last, uint32_t byte, const std::string& text) {
  auto part = std::make_shared<Speech>();
  part->text = text;
  part->lang = all.lang;
  part->rate = all.rate;
  part->recorded = true;
  size_t begin = std::min(size_t(std::llround(from * all.rate)), all.pcm.size());
  size_t end = std::clamp(size_t(std::llround(to * all.rate)), begin, all.pcm.size());
  part->pcm.assign(all.pcm.begin() + ptrdiff_t(begin), all.pcm.begin() + ptrdiff_t(end));
  part->duration = double(part->pcm.size()) / part->rate;
  auto local = [&](double time) { return std::clamp(time - from, 0.0, part->duration); };
  for (size_t w = first; w < last; w++) {
    SpeechWord word = all.words[w];
    word.begin = local(word.begin);
    word.end = local(word.end);
    word.text_begin -= byte;
    word.text_end -= byte;
    part->words.push_back(word);
  }
  for (SpeechPhoneme phoneme : all.phonemes) {
    bool own = phoneme.word >= int(first) && phoneme.word < int(last);
    bool pause = phoneme.word < 0 && phoneme.begin < to - shortest_overlap &&
                 phoneme.end > from + shortest_overlap;
    if (!own && !pause) continue;
    phoneme.begin = local(phoneme.begin);
    phoneme.end = local(phoneme.end);
    if (own) phoneme.word -= int(first);
    part->phonemes.push_back(std::move(phoneme));
  }
  fill_visemes(*part);
  return part;
}

}  // namespace

std::string text_of(const std::vector<StoryLine>& lines) {
  std::string text;
  for (const StoryLine& line : lines) text += (text.empty() ? "" : "\n") + line.text;
  return text;
}

Speech mark_recording(SpeechProcess& process, const std::vector<StoryLine>& lines,
                      const SpeechRequest& voice, const Sound& recording) {
  Speech spoken = speak_all(process, lines, voice);
  if (eval_fit(spoken, recording) < least_fit)
    throw std::runtime_error("the recording does not say this text");
  // A template at the narrator's own pace is nearer to the recording.
  SpeechRequest paced = voice;
  double pace = measure_pace(spoken, recording);
  paced.words_per_minute = int(std::clamp(paced.words_per_minute / pace, 80.0, 450.0));
  Speech marked = align_speech(speak_all(process, lines, paced), recording);
  marked.lang = voice.lang;
  return marked;
}

Speech apply_marks(std::string_view json, const std::string& file,
                   const std::vector<StoryLine>& lines, const Sound& recording) {
  Speech marked = load_speech_marks(json, file);
  if (marked.text != text_of(lines))
    throw LoadError(file, "/text",
                    "is another text than the one told; move the file away to have it made anew");
  double length = double(recording.samples.size()) / recording.rate;
  if (std::abs(length - marked.duration) > 0.01)
    throw LoadError(file, "/duration",
                    "is " + seconds(marked.duration) + ", the recording's is " + seconds(length));
  marked.pcm = to_pcm(recording.samples);
  marked.rate = recording.rate;
  marked.duration = length;
  return marked;
}

std::vector<StoryNote> doubtful_places(const Speech& marked, const std::vector<StoryLine>& lines) {
  std::vector<StoryNote> notes;
  std::vector<size_t> first = first_words(marked, lines);
  std::vector<double> rate(lines.size());  // seconds a byte, pauses within left out
  for (size_t i = 0; i < lines.size(); i++) {
    double sum = 0;
    for (size_t w = first[i]; w < first[i + 1]; w++)
      sum += marked.words[w].end - marked.words[w].begin;
    rate[i] = sum / double(std::max<size_t>(lines[i].text.size(), 1));
  }
  std::vector<double> sorted = rate;
  std::nth_element(sorted.begin(), sorted.begin() + ptrdiff_t(sorted.size() / 2), sorted.end());
  double median = sorted.empty() ? 0 : sorted[sorted.size() / 2];
  for (size_t i = 0; i < lines.size(); i++) {
    if (first[i] == first[i + 1]) continue;
    bool fast = rate[i] * doubtful_rate<median, slow = rate[i]> median * doubtful_rate;
    if (fast || slow)
      notes.push_back({lines[i].place, std::string("this sentence is said unusually ") +
                                           (fast ? "fast" : "slowly") + " in the recording, at " +
                                           seconds(marked.words[first[i]].begin) +
                                           "; is it the same there?"});
  }
  // Words that are not in the text lie between those that are, or are taken for a part of one.
  Features features = make_features(from_pcm(marked.pcm), marked.rate);
  std::vector<float> chance = speech_chance(features);
  auto speech_between = [&](double from, double to) {
    double sum = 0;
    for (size_t t = size_t(from / feature_hop); t < size_t(to / feature_hop) && t < chance.size();
         t++)
      sum += double(chance[t]) * feature_hop;
    return sum;
  };
  double last = 0;
  for (size_t i = 0; i < lines.size(); i++) {
    double since = last, foreign = 0;
    for (size_t w = first[i]; w < first[i + 1]; w++) {
      const SpeechWord& word = marked.words[w];
      double usual = median * double(word.text_end - word.text_begin + 1);
      foreign += speech_between(last, word.begin) +
                 std::max(word.end - word.begin - doubtful_word * usual, 0.0);
      last = word.end;
    }
    if (i + 1 == lines.size()) foreign += speech_between(last, marked.duration);
    if (foreign > doubtful_words)
      notes.push_back({lines[i].place, "about " + seconds(foreign) +
                                           " are heard near this sentence that the text " +
                                           "does not have, after " + seconds(since) +
                                           " of the recording"});
  }
  return notes;
}

std::vector<std::shared_ptr<const Speech>> divide_recording(const Speech& marked,
                                                            const std::vector<StoryLine>& lines,
                                                            double lead) {
  std::vector<size_t> first = first_words(marked, lines);
  std::vector<std::shared_ptr<const Speech>> parts;
  double from = 0;
  uint32_t byte = 0;
  for (size_t i = 0; i < lines.size(); i++) {
    double said = first[i + 1] > first[i] ? marked.words[first[i + 1] - 1].end : from,
           to = marked.duration, next = to;
    if (first[i + 1] < marked.words.size() && i + 1 < lines.size()) {
      double silence = std::max(marked.words[first[i + 1]].begin - said, 0.0);
      double left_out = std::clamp(silence - 0.05, 0.0, lead);
      to = said + (silence - left_out) / 2;
      next = to + left_out;
    }
    parts.push_back(cut(marked, from, to, first[i], first[i + 1], byte, lines[i].text));
    byte += uint32_t(lines[i].text.size()) + 1;
    from = next;
  }
  return parts;
}

}  // namespace wellspring::avatar
