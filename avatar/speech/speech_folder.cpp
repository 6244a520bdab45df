// SPDX-License-Identifier: Apache-2.0
#include "avatar/speech/speech_folder.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <system_error>
#include <vector>

#include "avatar/speech/speech_json.h"
#include "avatar/speech/protocol.h"
#include "avatar/speech/sound_file.h"
#include "base/load_error.h"
#include "base/log.h"
#include "base/rng.h"

namespace wellspring::avatar {

namespace fs = std::filesystem;
namespace protocol = speech_protocol;

namespace {

constexpr const char* extension = ".speech";

// A file is a frame of the voice protocol: JSON {"key": ..., "marks": text of speech_json}, and the
// sound.
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
    save_file(file + ".new", bytes.data(), bytes.size());
    fs::rename(file + ".new", file);
    remove_oldest(path_, most_bytes_);
  } catch (const std::exception& error) {
    fs::remove(file + ".new", code);
    if (!said_) log::warn("speech: not kept on disk: {}", error.what());
    said_ = true;
  }
}

}  // namespace wellspring::avatar
