// SPDX-License-Identifier: Apache-2.0
#include "show/storyteller/recordings.h"

#include <cstdio>
#include <cstring>
#include <filesystem>

#include "avatar/speech/speech_json.h"
#include "avatar/story/recorded_story.h"
#include "base/load_error.h"
#include "base/log.h"
#include "base/read_file.h"
#include "base/write_file.h"
#include "base/rng.h"
#include "show/storyteller/voice.h"

namespace wellspring::show {

namespace fs = std::filesystem;

namespace {

constexpr uint64_t method = 1;  // grows when the same recording gets other marks than before
constexpr int best_rate = 48000;

// Returns a name made of all that marks depend on: the sound, the text and how it is pronounced.
std::string cache_name(const Sound& sound, const std::vector<StoryLine>& lines,
                       const SpeechRequest& voice) {
  uint64_t a = method, b = uint64_t(sound.rate);
  auto add = [&](uint64_t value) { a = mix64(a ^ value), b = mix64(b + value); };
  for (float sample : sound.samples) {
    uint32_t bits;
    std::memcpy(&bits, &sample, sizeof bits);
    add(bits);
  }
  for (const StoryLine& line : lines) {
    SpeechRequest request = voice;
    request.text = line.text;
    request.styles = line.styles;
    for (char c : speech_key(request)) add(static_cast<unsigned char>(c));
    add(256);
  }
  char name[64];
  std::snprintf(name, sizeof name, "%016llx%016llx.marks.json", static_cast<unsigned long long>(a),
                static_cast<unsigned long long>(b));
  return name;
}

void keep(const std::string& folder, const std::string& path, const Speech& marked) {
  std::error_code code;
  fs::create_directories(folder, code);
  try {
    write_file(path, write_speech_json(marked));
  } catch (const std::exception& error) {
    log::warn("marks of a recording cannot be kept: {}", error.what());
  }
}

struct Reader {
  const Exhibit& exhibit;
  const RecordingOptions& options;
  std::vector<Problem>& problems;
  SpeechProcess process;

  Speech find_marks(const std::string& recording, const std::vector<StoryLine>& lines,
                    const SpeechRequest& voice, const Sound& sound) {
    std::string edited = marks_file_of(recording);
    std::error_code code;
    if (fs::exists(edited, code))
      return apply_marks(read_file(edited, most_marks_bytes), edited, lines, sound);
    std::string kept =
        options.cache.empty() ? "" : options.cache + "/" + cache_name(sound, lines, voice);
    if (!kept.empty() && fs::exists(kept, code)) {
      try {
        return apply_marks(read_file(kept, most_marks_bytes), kept, lines, sound);
      } catch (const LoadError& error) {
        log::warn("{}; it is made anew", error.what());
      }
    }
    log::info("finding the words of {} ({:.0f} s)", recording,
              double(sound.samples.size()) / sound.rate);
    Speech marked = mark_recording(process, lines, voice, sound);
    if (!kept.empty()) keep(options.cache, kept, marked);
    return marked;
  }

  void read(const LocalText& recordings, LocalScript& script, const VoiceManner& manner) {
    for (const auto& [lang, file] : recordings) {
      auto lines = script.find(lang);
      if (lines == script.end()) continue;  // noted when the package was read
      try {
        Sound sound = load_sound(file);
        if (sound.rate > best_rate)
          sound = {best_rate, resample(sound.samples, sound.rate, best_rate)};
        SpeechRequest voice;
        voice.lang = lang;
        voice.pitch = manner.pitch;
        voice.variant = manner.variant;
        Speech marked = find_marks(file, lines->second, voice, sound);
        for (const StoryNote& note : doubtful_places(marked, lines->second)) {
          const std::string& source = lines->second.front().file;
          problems.push_back({source, to_string(note.place), note.what, false});
        }
        auto parts = divide_recording(marked, lines->second, double(speech_lead));
        for (size_t i = 0; i < parts.size(); i++) lines->second[i].recording = parts[i];
      } catch (const LoadError& error) {
        problems.push_back({error.file, error.where, error.what_});
      } catch (const std::exception& error) {
        problems.push_back({file, "", std::string(error.what()) + " (" + lang + ")"});
      }
    }
  }
};

}  // namespace

std::string marks_file_of(const std::string& recording) {
  return fs::path(recording).replace_extension(".marks.json").string();
}

void read_recordings(Exhibit& exhibit, const RecordingOptions& options,
                     std::vector<Problem>& problems) {
  Reader reader{exhibit, options, problems, SpeechProcess(options.voice)};
  auto manner = [&](int storyteller_index) {
    size_t index = size_t(std::max(storyteller_index, 0));
    return index < exhibit.storytellers.size() ? exhibit.storytellers[index].voice : VoiceManner{};
  };
  for (StoryText& story : exhibit.stories)
    reader.read(story.sound, story.text, manner(story.storyteller_index));
  for (TourPlan& tour : exhibit.tours)
    for (TourStop& stop : tour.stops) {
      reader.read(stop.way_sound, stop.way_text, manner(-1));
      reader.read(stop.sound, stop.text, manner(-1));
    }
}

}  // namespace wellspring::show
