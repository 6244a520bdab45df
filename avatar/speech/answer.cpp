// SPDX-License-Identifier: Apache-2.0
#include "avatar/speech/answer.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "avatar/speech/text.h"
#include "avatar/speech/visemes.h"

namespace wellspring::avatar {

namespace {

constexpr double window = 0.0025;         // seconds
constexpr double quiet = 1e-4;            // share of the loudest window's energy
constexpr double longest_closure = 0.15;  // seconds
constexpr double least_left = 0.02;       // seconds of the sound before that must remain

bool is_voiceless_stop(const SpeechPhoneme& phoneme) {
  for (std::string_view stop : {"p", "t", "k", "c", "q", "ʈ", "ʔ"})
    if (std::string_view(phoneme.ipa).starts_with(stop)) return true;
  return false;
}

std::vector<double> window_energies(const Speech& speech) {
  size_t length = std::max<size_t>(1, size_t(window * speech.rate));
  std::vector<double> energy(speech.pcm.size() / length);
  for (size_t i = 0; i < energy.size(); i++)
    for (size_t k = i * length; k < (i + 1) * length; k++)
      energy[i] += double(speech.pcm[k]) * double(speech.pcm[k]);
  return energy;
}

}  // namespace

void include_closures(Speech& speech) {
  std::vector<double> energy = window_energies(speech);
  if (energy.empty()) return;
  double threshold = quiet * *std::max_element(energy.begin(), energy.end());
  double length = double(std::max<size_t>(1, size_t(window * speech.rate))) / speech.rate;
  for (size_t i = 1; i < speech.phonemes.size(); i++) {
    SpeechPhoneme &stop = speech.phonemes[i], &before = speech.phonemes[i - 1];
    if (!is_voiceless_stop(stop)) continue;
    double begin = stop.begin;
    if (is_pause(before.mnemonic)) {
      begin = std::max(before.begin, stop.begin - usual_closure);
    } else {
      double earliest = std::max(before.begin + least_left, stop.begin - longest_closure);
      // The window with the burst is passed over.
      for (size_t k = std::min(size_t(stop.begin / length), energy.size());
           k-- > 0 && energy[k] <= threshold && double(k) * length >= earliest;)
        begin = double(k) * length;
    }
    stop.begin = before.end = std::min(begin, stop.begin);
  }
  std::erase_if(speech.phonemes, [](const SpeechPhoneme& phoneme) {
    return is_pause(phoneme.mnemonic) && phoneme.end <= phoneme.begin;
  });
}

namespace {

using nlohmann::json;

// Returns a whole number, cut off towards 0.
int whole(const json& value) {
  const double number = value.get<double>();
  if (!(std::abs(number) < 2e9)) throw std::runtime_error("a number is too large");
  return int(number);
}

// This is a group of words that the engine said as one ("of the" is one entry of its dictionary).
struct SaidAsOne {
  int first = 0, count = 1;  // indices into Speech::words
};

void time_words(Speech& speech) {
  std::vector<bool> timed(speech.words.size());
  for (SpeechPhoneme& phoneme : speech.phonemes) {
    if (phoneme.word < 0) continue;
    SpeechWord& word = speech.words[size_t(phoneme.word)];
    if (!timed[size_t(phoneme.word)]) word.begin = phoneme.begin;
    word.end = phoneme.end;
    timed[size_t(phoneme.word)] = true;
  }
  // A word without a sound of its own (punctuation read as a pause) is no word.
  std::vector<int> moved(speech.words.size(), -1);
  std::vector<SpeechWord> words;
  for (size_t i = 0; i < speech.words.size(); i++)
    if (timed[i]) {
      moved[i] = int(words.size());
      words.push_back(speech.words[i]);
    }
  for (SpeechPhoneme& phoneme : speech.phonemes)
    if (phoneme.word >= 0) phoneme.word = moved[size_t(phoneme.word)];
  speech.words = std::move(words);
}

// Returns whether the script has no spaces from here on (Chinese, Japanese and their like).
bool is_spaceless(const std::string& text, uint32_t byte) {
  return static_cast<unsigned char>(text[byte]) >= 0xe3;
}

struct Event {
  uint32_t byte = 0;
  size_t token = 0;
};

// Finds the word of the text for each word of the answer. The engine may say a word in several
// parts (1786), two words as one ("of the"), and counts characters its own way after numbers and
// phrases ("so much": both in "so"). A part inside a word is one of the words that follow, if the
// answer does not name these otherwise; else it belongs to the word it lies in.
void match_events(std::vector<Event>& events, const std::vector<SpeechWord>& tokens) {
  size_t last = 0;
  for (Event& event : events) {
    while (event.token + 1 < tokens.size() && tokens[event.token + 1].text_begin <= event.byte)
      event.token++;
    event.token = last = std::max(event.token, last);
  }
  for (size_t i = 1; i < events.size(); i++) {
    size_t before = events[i - 1].token;
    if (events[i].token > before) continue;
    size_t next = i + 1;
    while (next < events.size() && events[next].token <= before) next++;
    size_t limit = next < events.size() ? events[next].token : tokens.size();
    bool inside = events[i].byte > tokens[before].text_begin;
    events[i].token = inside && before + 1 < limit ? before + 1 : before;
  }
}

// Reads the words of the text as they are heard, and gives each word of the answer its group.
// `starts` holds the byte of the text that each character of the request stands for.
std::vector<int> read_words(const json& list, const std::vector<uint32_t>& starts, Speech& speech,
                            std::vector<SaidAsOne>& groups) {
  std::vector<Event> events;
  std::vector<uint32_t> cuts;
  for (const json& entry : list) {
    long character = std::clamp<long>(whole(entry.at(1)), 0, long(starts.size()) - 1);
    uint32_t byte = skip_spaces(speech.text, starts[size_t(character)]);
    bool named = whole(entry.at(2)) > 0 && byte < speech.text.size();
    if (!named) byte = events.empty() ? 0 : events.back().byte;
    events.push_back({byte, 0});
    if (named) cuts.push_back(byte);
  }
  speech.words = words_of(speech.text, [&](uint32_t byte, bool begins) {
    return (begins || is_spaceless(speech.text, byte)) &&
           std::find(cuts.begin(), cuts.end(), byte) != cuts.end();
  });
  std::vector<int> group_of;
  if (speech.words.empty()) return std::vector<int>(events.size(), -1);
  match_events(events, speech.words);
  for (size_t i = 0; i < events.size(); i++) {
    int first = int(events[i].token);
    if (groups.empty() || groups.back().first < first) {
      if (!groups.empty()) groups.back().count = first - groups.back().first;
      groups.push_back({first, int(speech.words.size()) - first});
    }
    group_of.push_back(int(groups.size()) - 1);
  }
  return group_of;
}

// Gives each phoneme, which names a group, its word: within a group by the length of the words in
// letters, which is a guess, but one about two or three short words.
void name_words(Speech& speech, const std::vector<SaidAsOne>& groups) {
  for (size_t i = 0; i < speech.phonemes.size();) {
    int group = speech.phonemes[i].word;
    size_t end = i, sounds = 0;
    for (; end < speech.phonemes.size() && speech.phonemes[end].word == group; end++)
      sounds += !is_pause(speech.phonemes[end].mnemonic);
    if (group >= 0) {
      const SaidAsOne& words = groups[size_t(group)];
      auto letters = [&](int word) {
        const SpeechWord& w = speech.words[size_t(words.first + word)];
        return double(w.text_end - w.text_begin);
      };
      double all = 0, said = 0, until = 0;
      for (int k = 0; k < words.count; k++) all += letters(k);
      int word = 0;
      until = words.count > 0 ? letters(0) : 0;
      for (size_t k = i; k < end; k++) {
        SpeechPhoneme& phoneme = speech.phonemes[k];
        if (is_pause(phoneme.mnemonic) || words.count == 0) {
          phoneme.word = -1;
          continue;
        }
        while (word + 1 < words.count && (said + 0.5) / double(sounds) > until / all)
          until += letters(++word);
        phoneme.word = words.first + word;
        said++;
      }
    }
    i = end;
  }
}

// Names sounds between others that the engine does not write: the glide from vowel to vowel ("the
// oldest") and the murmur in a cluster of consonants.
std::string name_nameless(const std::string& mnemonic) {
  return mnemonic == ";" ? "j" : mnemonic == "@-" ? "ə" : "";
}

// Adds a phoneme. Every one lasts until the next; pauses that follow each other are one.
void add_phoneme(Speech& speech, SpeechPhoneme phoneme) {
  if (!speech.phonemes.empty()) {
    SpeechPhoneme& last = speech.phonemes.back();
    if (is_pause(phoneme.mnemonic) && is_pause(last.mnemonic)) return;
    last.end = phoneme.begin;
  }
  speech.phonemes.push_back(std::move(phoneme));
}

}  // namespace

std::shared_ptr<const Speech> read_speech_answer(const SpeechRequest& request,
                                                 std::string_view json_text,
                                                 std::vector<int16_t> pcm, std::string& error) {
  try {
    json answer = json::parse(json_text);
    if (answer.contains("error")) {
      error = answer.at("error").get<std::string>();
      if (error.empty()) error = "the voice program refuses without saying why";
      return nullptr;
    }
    auto speech = std::make_shared<Speech>();
    speech->text = request.text;
    speech->lang = request.lang;
    speech->rate = whole(answer.at("rate"));
    if (speech->rate < 4000 || speech->rate > 192000) throw std::runtime_error("sample rate");
    speech->duration = double(pcm.size()) / speech->rate;
    speech->pcm = std::move(pcm);
    std::vector<SaidAsOne> groups;
    std::vector<uint32_t> starts = request.styles.empty()
                                       ? character_starts(request.text)
                                       : make_ssml(request.text, request.styles).source;
    std::vector<int> group_of = read_words(answer.at("words"), starts, *speech, groups);
    double last = 0;
    for (const json& entry : answer.at("phonemes")) {
      SpeechPhoneme phoneme;
      phoneme.begin = std::clamp(entry.at(0).get<double>() / speech->rate, last, speech->duration);
      last = phoneme.begin;
      int word = whole(entry.at(1));
      if (word >= 0 && word < int(group_of.size())) phoneme.word = group_of[size_t(word)];
      phoneme.mnemonic = entry.at(2).get<std::string>();
      phoneme.ipa = entry.at(3).get<std::string>();
      // The engine has phonemes without a name that only make a pause.
      if (phoneme.mnemonic.empty()) phoneme.mnemonic = "_";
      if (phoneme.ipa.empty()) phoneme.ipa = name_nameless(phoneme.mnemonic);
      // The engine writes a change of language inside a word as "(en)"; it sounds like nothing.
      if (phoneme.ipa.starts_with('(')) continue;
      add_phoneme(*speech, std::move(phoneme));
    }
    if (speech->phonemes.empty()) throw std::runtime_error("no phonemes");
    speech->phonemes.back().end = speech->duration;
    double first = speech->phonemes.front().begin;
    if (first > 0) speech->phonemes.insert(speech->phonemes.begin(), {0, first, "_", "", -1});
    std::erase_if(speech->phonemes, [](const SpeechPhoneme& phoneme) {
      return is_pause(phoneme.mnemonic) && phoneme.end <= phoneme.begin;
    });
    include_closures(*speech);
    name_words(*speech, groups);
    time_words(*speech);
    fill_visemes(*speech);
    return speech;
  } catch (const std::exception& problem) {
    error = std::string("the voice program gave an answer that makes no sense: ") + problem.what();
    return nullptr;
  }
}

}  // namespace wellspring::avatar
