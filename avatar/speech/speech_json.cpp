// SPDX-License-Identifier: Apache-2.0
#include "avatar/speech/speech_json.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <system_error>
#include <vector>

#include "avatar/speech/protocol.h"
#include "avatar/speech/text.h"
#include "avatar/speech/visemes.h"
#include "base/load_error.h"
#include "base/log.h"
#include "base/rng.h"
#include "base/write_file.h"
#include "json/fields.h"

namespace wellspring::avatar {

namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr size_t most_entries = 1'000'000;
constexpr double longest = 24 * 3600;

double rounded(double value, double per_unit = 1e4) {
  return std::round(value * per_unit) / per_unit;
}

// Writes the keys of a shape at which it, or its key before or after, has a weight.
ordered_json write_visemes(const VisemeTrack& track) {
  ordered_json list = ordered_json::array();
  auto weight = [&](size_t key, size_t viseme) {
    return key < track.keys.size() ? track.keys[key].weights[viseme] : 0.0f;
  };
  for (size_t k = 0; k < track.keys.size(); k++)
    for (size_t v = 0; v < viseme_count; v++)
      if (weight(k, v) > 0 || weight(k + 1, v) > 0 || (k > 0 && weight(k - 1, v) > 0))
        list.push_back({{"time", rounded(track.keys[k].time)},
                        {"viseme", viseme_names[v]},
                        {"weight", rounded(double(weight(k, v)), 1e3)}});
  return list;
}

constexpr double slack = 2e-4;  // times are written with four decimals

// Reads a text of any length and characters.
std::string read_any_text(FieldReader& root, const char* name) {
  const auto field = root.take(name, Need::required);
  if (!field->value().is_string()) field->fail_kind("a text");
  return field->value().get<std::string>();
}

void read_span(FieldReader& entry, double after, double duration, double& begin, double& end) {
  entry.number("start", -longest, longest, begin, "", Need::required);
  entry.number("end", -longest, longest, end, "", Need::required);
  if (begin < after - slack) entry.fail("start", "is before the end of what comes before");
  if (end < begin - slack) entry.fail("end", "is before the start");
  if (end > duration + slack) entry.fail("end", "is after the end of the sound");
  begin = std::clamp(begin, after, duration);
  end = std::clamp(end, begin, duration);
}

void read_word(FieldReader& entry, const std::vector<uint32_t>& bytes, Speech& speech) {
  SpeechWord word;
  const double after = speech.words.empty() ? 0 : speech.words.back().end;
  read_span(entry, after, speech.duration, word.begin, word.end);
  const auto range = entry.numbers("characters", 2, 0, double(bytes.size() - 1));
  if (range[0] != std::floor(range[0]) || range[1] != std::floor(range[1]) || range[0] > range[1])
    entry.fail("characters", "two counts of characters are expected");
  word.text_begin = bytes[size_t(range[0])];
  word.text_end = bytes[size_t(range[1])];
  speech.words.push_back(word);
}

void read_phoneme(FieldReader& entry, Speech& speech) {
  SpeechPhoneme phoneme;
  phoneme.mnemonic = read_any_text(entry, "phoneme");
  phoneme.ipa = read_any_text(entry, "ipa");
  entry.integer("word", -1, double(speech.words.size()) - 1, phoneme.word, "", Need::required);
  if (phoneme.word < 0) {
    if (is_pause(phoneme.mnemonic)) return;  // pauses are made anew
    read_span(entry, 0, longest, phoneme.begin, phoneme.end);
    speech.phonemes.push_back(std::move(phoneme));
    return;
  }
  const auto last = std::find_if(speech.phonemes.rbegin(), speech.phonemes.rend(),
                                 [](const SpeechPhoneme& one) { return one.word >= 0; });
  const int word = last == speech.phonemes.rend() ? 0 : last->word;
  if (phoneme.word < word) entry.fail("word", "is out of order");
  // Phonemes keep only their proportions; their word may have been moved away from them.
  const double after = last == speech.phonemes.rend() || phoneme.word > word ? 0 : last->end;
  entry.number("start", 0, longest, phoneme.begin, "", Need::required);
  entry.number("end", 0, longest, phoneme.end, "", Need::required);
  if (phoneme.begin < after - slack || phoneme.end < phoneme.begin)
    entry.fail("start", "times are out of order");
  speech.phonemes.push_back(std::move(phoneme));
}

}  // namespace

std::string write_speech_json(const Speech& speech) {
  ordered_json words = ordered_json::array(), phonemes = ordered_json::array();
  std::string_view text = speech.text;
  auto character = [&](uint32_t byte) { return count_characters(text, byte); };
  for (const SpeechWord& word : speech.words)
    words.push_back({{"text", text.substr(word.text_begin, word.text_end - word.text_begin)},
                     {"start", rounded(word.begin)},
                     {"end", rounded(word.end)},
                     {"characters", {character(word.text_begin), character(word.text_end)}}});
  for (const SpeechPhoneme& phoneme : speech.phonemes)
    phonemes.push_back({{"phoneme", phoneme.mnemonic},
                        {"ipa", phoneme.ipa},
                        {"start", rounded(phoneme.begin)},
                        {"end", rounded(phoneme.end)},
                        {"word", phoneme.word}});
  auto text_of = [](const ordered_json& value) {
    return value.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
  };
  // One entry a line lets a person find and change it.
  std::string out = "{\"version\": 1";
  auto add = [&](const char* name, const ordered_json& value) {
    out += std::string(",\n \"") + name + "\": " + text_of(value);
  };
  add("text", speech.text);
  add("lang", speech.lang);
  add("rate", speech.rate);
  add("duration", rounded(speech.duration));
  auto add_list = [&](const char* name, const ordered_json& list) {
    out += std::string(",\n \"") + name + "\": [";
    for (size_t i = 0; i < list.size(); i++) out += (i ? ",\n  " : "\n  ") + text_of(list[i]);
    out += "\n ]";
  };
  add_list("words", words);
  add_list("phonemes", phonemes);
  add_list("visemes", write_visemes(speech.visemes));
  return out + "\n}\n";
}

Speech load_speech_marks(std::string_view text, const std::string& file) {
  const json parsed = parse_json_file(file, text);
  Faults faults(file);
  FieldReader root(parsed, faults);
  Speech speech;
  int version = 1;
  root.integer("version", 1, 1, version, "", Need::required);
  speech.text = read_any_text(root, "text");
  if (find_broken_utf8(speech.text) != std::string::npos) root.fail("text", "is no UTF-8");
  speech.lang = read_any_text(root, "lang");
  root.integer("rate", 4000, 192000, speech.rate, "", Need::required);
  root.number("duration", 0, longest, speech.duration, "", Need::required);
  const std::vector<uint32_t> bytes = character_starts(speech.text);
  for (const JsonValue& one : root.list("words", 0, most_entries, "words", Need::required))
    root.read_object(one, [&](FieldReader& entry) { read_word(entry, bytes, speech); });
  for (const JsonValue& one : root.list("phonemes", 0, most_entries, "phonemes", Need::required))
    root.read_object(one, [&](FieldReader& entry) { read_phoneme(entry, speech); });
  fit_phonemes(speech);
  fill_visemes(speech);
  return speech;
}

namespace fs = std::filesystem;
namespace protocol = speech_protocol;

namespace {

constexpr const char* extension = ".speech";

// Returns a file's name. A file is a frame of the voice protocol: JSON {"key": ..., "marks": text
// of speech_json}, and the sound.
std::string file_name(const std::string& key) {
  uint64_t a = 1, b = 2;
  for (char c : key) {
    a = mix64(a ^ static_cast<unsigned char>(c));
    b = mix64(b + static_cast<unsigned char>(c));
  }
  char name[40];
  std::snprintf(name, sizeof name, "%016llx%016llx", static_cast<unsigned long long>(a),
                static_cast<unsigned long long>(b));
  return std::string(name) + extension;
}

struct Entry {
  fs::path path;
  fs::file_time_type time;
  uintmax_t bytes = 0;
};

void remove_oldest(const std::string& folder, size_t most_bytes) {
  std::vector<Entry> entries;
  uintmax_t sum = 0;
  std::error_code code;
  for (const auto& item : fs::directory_iterator(folder, code)) {
    std::error_code time_code, size_code;
    if (item.path().extension() != extension) continue;
    Entry entry{item.path(), item.last_write_time(time_code), item.file_size(size_code)};
    if (time_code || size_code) continue;
    sum += entry.bytes;
    entries.push_back(entry);
  }
  std::sort(entries.begin(), entries.end(),
            [](const Entry& a, const Entry& b) { return a.time < b.time; });
  for (size_t i = 0; i < entries.size() && sum > most_bytes; i++) {
    fs::remove(entries[i].path, code);
    sum -= entries[i].bytes;
  }
}

}  // namespace

std::string speech_key(const SpeechRequest& request) {
  return request.lang + "\n" + std::to_string(request.words_per_minute) + "\n" +
         std::to_string(request.pitch) + "\n" + request.variant + "\n" + request.text +
         (request.styles.empty() ? "" : "\n\n" + describe_styles(request.styles));
}

SpeechFolder::SpeechFolder(std::string path, size_t most_bytes, std::string made_by)
    : path_(std::move(path)), most_bytes_(most_bytes), made_by_(std::move(made_by)) {}

std::shared_ptr<const Speech> SpeechFolder::load(const SpeechRequest& request) const {
  if (path_.empty()) return nullptr;
  std::string key = speech_key(request), file = (fs::path(path_) / file_name(key)).string();
  std::ifstream in(file, std::ios::binary);
  unsigned char bytes[protocol::header_bytes];
  if (!in.read(reinterpret_cast<char*>(bytes), sizeof bytes)) return nullptr;
  protocol::Header header = protocol::read_header(bytes);
  std::error_code code, none;
  if (auto made = fs::last_write_time(made_by_, none);
      !none && fs::last_write_time(file, code) < made)
    return nullptr;
  uintmax_t size = fs::file_size(file, code);
  if (code || size != sizeof bytes + uintmax_t(header.json) + header.sound ||
      header.json > protocol::max_answer_json || header.sound > protocol::max_sound_bytes ||
      header.sound % 2 != 0)
    return nullptr;
  std::string text(header.json, '\0');
  auto speech = std::make_shared<Speech>();
  std::vector<int16_t> pcm(header.sound / 2);
  if (!in.read(text.data(), std::streamsize(text.size())) ||
      !in.read(reinterpret_cast<char*>(pcm.data()), std::streamsize(header.sound)))
    return nullptr;
  try {
    auto json = nlohmann::json::parse(text);
    if (json.at("key").get<std::string>() != key) return nullptr;
    *speech = load_speech_marks(json.at("marks").get<std::string>(), file);
  } catch (const std::exception&) {
    return nullptr;
  }
  speech->pcm = std::move(pcm);
  if (std::abs(double(speech->pcm.size()) / speech->rate - speech->duration) > 1e-3) return nullptr;
  return speech;
}

void SpeechFolder::save(const SpeechRequest& request, const Speech& speech) {
  if (path_.empty()) return;
  std::string key = speech_key(request), file = (fs::path(path_) / file_name(key)).string();
  std::string text = nlohmann::json{{"key", key}, {"marks", write_speech_json(speech)}}.dump();
  size_t sound = speech.pcm.size() * sizeof(int16_t);
  std::string bytes = protocol::write_header(uint32_t(text.size()), uint32_t(sound)) + text;
  bytes.append(reinterpret_cast<const char*>(speech.pcm.data()), sound);
  std::error_code code;
  fs::create_directories(path_, code);
  try {
    write_file(file, bytes);
    remove_oldest(path_, most_bytes_);
  } catch (const std::exception& error) {
    if (!said_) log::warn("speech: not kept on disk: {}", error.what());
    said_ = true;
  }
}

}  // namespace wellspring::avatar
