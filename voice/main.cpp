// SPDX-License-Identifier: Apache-2.0
// Speaks texts for other programs through eSpeak NG, over the protocol of avatar/speech/protocol.h.
//
// Licence. eSpeak NG is GPL-3.0-or-later. This file is the only one that includes its header and
// this program the only one that links it; the source of this file is offered under Apache-2.0,
// which GPL-3.0 accepts, and the linked program may be passed on under the terms of
// GPL-3.0-or-later. The other programs of Wellspring only exchange texts and sounds with it
// through a pipe, are whole without it, and stay under Apache-2.0.
//
// Every request is spoken by a child of its own: it starts from the same warmed-up state whatever
// was asked before, so the same request gives the same samples, and a crash inside the library
// costs one answer. espeak_Terminate() can hang and is not called.
#include <espeak-ng/speak_lib.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "about/version.h"
#include "avatar/speech/protocol.h"

namespace {

namespace protocol = wellspring::avatar::speech_protocol;
using nlohmann::json;

constexpr int seconds_for_one = 20;        // a child that takes longer is ended by SIGALRM
constexpr size_t memory_bytes = 1u << 30;  // address space of one child

bool read_all(char* to, size_t size) {
  while (size > 0) {
    ssize_t got = read(STDIN_FILENO, to, size);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    to += got;
    size -= size_t(got);
  }
  return true;
}

bool write_all(const char* from, size_t size) {
  while (size > 0) {
    ssize_t put = write(STDOUT_FILENO, from, size);
    if (put < 0 && errno == EINTR) continue;
    if (put <= 0) return false;
    from += put;
    size -= size_t(put);
  }
  return true;
}

bool answer(const json& head, const std::vector<short>& sound = {}) {
  std::string text = head.dump(-1, ' ', false, json::error_handler_t::replace);
  size_t bytes = sound.size() * sizeof(short);
  std::string header = protocol::write_header(uint32_t(text.size()), uint32_t(bytes));
  return write_all(header.data(), header.size()) && write_all(text.data(), text.size()) &&
         write_all(reinterpret_cast<const char*>(sound.data()), bytes);
}

// Collects what the library's callback gets; it takes no pointer of ours.
struct Spoken {
  std::vector<short> sound;
  struct Word {
    int sample, character, characters;
  };
  struct Phoneme {
    int sample, word;
    std::string name;
  };
  std::vector<Word> words;
  std::vector<Phoneme> phonemes;
  bool too_long = false;
};
Spoken* spoken = nullptr;

int collect(short* sound, int count, espeak_EVENT* events) {
  for (; events->type != espeakEVENT_LIST_TERMINATED; events++) {
    if (events->type == espeakEVENT_WORD) {
      spoken->words.push_back({events->sample, events->text_position, events->length});
    } else if (events->type == espeakEVENT_PHONEME) {
      std::string name(events->id.string, strnlen(events->id.string, sizeof events->id.string));
      spoken->phonemes.push_back({events->sample, int(spoken->words.size()) - 1, name});
    }
  }
  if (sound && count > 0) spoken->sound.insert(spoken->sound.end(), sound, sound + count);
  spoken->too_long = spoken->sound.size() * sizeof(short) > protocol::max_sound_bytes;
  return spoken->too_long ? 1 : 0;
}

int initialise(bool ipa) {
  int names = espeakINITIALIZE_PHONEME_EVENTS | (ipa ? espeakINITIALIZE_PHONEME_IPA : 0);
  int rate =
      espeak_Initialize(AUDIO_OUTPUT_SYNCHRONOUS, 200, nullptr, names | espeakINITIALIZE_DONT_EXIT);
  espeak_SetSynthCallback(collect);
  return rate;
}

struct Language {
  std::string tag, voice, name;  // BCP 47 in small letters; file of the voice; the voice's own name
  int priority = 0;              // lower is preferred
};

std::vector<Language> list_languages() {
  std::vector<Language> languages;
  const espeak_VOICE** voices = espeak_ListVoices(nullptr);
  for (; voices && *voices; voices++) {
    const espeak_VOICE& voice = **voices;
    if (!voice.identifier || std::string(voice.identifier).compare(0, 3, "mb/") == 0) continue;
    // A byte of priority, then the tag; the list ends with a zero priority.
    for (const char* at = voice.languages; at && *at; at += std::string(at + 1).size() + 2)
      languages.push_back({at + 1, voice.identifier, voice.name ? voice.name : "", *at});
  }
  return languages;
}

std::string small(std::string text) {
  for (char& c : text) c = c == '_' ? '-' : char(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

// Finds the voice of a language tag, else of the tag without its last part (de-AT: de), else null.
// "en" is the tag of English; regions that have a voice of their own are found as written.
const Language* find_language(const std::vector<Language>& languages, std::string tag) {
  for (tag = small(tag); !tag.empty();) {
    const Language* best = nullptr;
    for (const Language& language : languages)
      if (small(language.tag) == tag && (!best || language.priority < best->priority))
        best = &language;
    if (best) return best;
    size_t dash = tag.rfind('-');
    if (dash == std::string::npos) break;
    tag.resize(dash);
  }
  return nullptr;
}

// Returns whether there is a manner of speaking by this name; they go with every voice: "f3" of
// "!v/f3".
bool has_variant(const std::string& name) {
  espeak_VOICE wanted{};
  wanted.languages = "variant";
  const espeak_VOICE** voices = espeak_ListVoices(&wanted);
  for (; voices && *voices; voices++)
    if ((*voices)->identifier && std::string((*voices)->identifier) == "!v/" + name) return true;
  return false;
}

bool speak(const json& request, const Language& language, Spoken& result) {
  std::string variant = request.value("variant", "");
  std::string voice = language.voice + (variant.empty() ? "" : "+" + variant);
  if (espeak_SetVoiceByName(voice.c_str()) != EE_OK) return false;
  espeak_SetParameter(espeakRATE, request.at("words_per_minute").get<int>(), 0);
  espeak_SetParameter(espeakPITCH, request.at("pitch").get<int>(), 0);
  const std::string& text = request.at("text").get_ref<const std::string&>();
  spoken = &result;
  const unsigned kind = request.value("ssml", false) ? espeakSSML : 0;
  return espeak_Synth(text.c_str(), text.size() + 1, 0, POS_CHARACTER, 0,
                      espeakCHARS_UTF8 | espeakENDPAUSE | kind, nullptr, nullptr) == EE_OK &&
         espeak_Synchronize() == EE_OK;
}

json make_answer(const json& request, const std::vector<Language>& languages, int rate,
                 std::vector<short>& sound) {
  json id = request.at("id");
  auto error = [&](const std::string& text) { return json{{"id", id}, {"error", text}}; };
  std::string tag = request.at("lang").get<std::string>();
  const Language* language = find_language(languages, tag);
  if (!language) return error("eSpeak NG has no voice for the language '" + tag + "'");
  std::string variant = request.value("variant", "");
  if (!variant.empty() && !has_variant(variant))
    return error("eSpeak NG has no variant '" + variant + "' of its voices");
  // The library names phonemes in one way at a time, so the text is spoken twice.
  Spoken first, second;
  if (!speak(request, *language, first)) return error("eSpeak NG cannot speak the text");
  if (first.too_long) return error("the sound of the text would be too long");
  if (first.phonemes.empty()) return error("there is nothing in the text that can be spoken");
  initialise(true);
  if (!speak(request, *language, second)) return error("eSpeak NG cannot speak the text");
  bool paired = first.phonemes.size() == second.phonemes.size();
  if (!paired) return error("eSpeak NG spoke the text in two ways");

  json words = json::array(), phonemes = json::array();
  for (const auto& word : first.words)
    words.push_back({word.sample, word.character - 1, word.characters});
  for (size_t i = 0; i < first.phonemes.size(); i++) {
    const auto& phoneme = first.phonemes[i];
    phonemes.push_back({phoneme.sample, phoneme.word, phoneme.name, second.phonemes[i].name});
  }
  sound = std::move(first.sound);
  return {{"id", id},
          {"rate", rate},
          {"voice", language->name},
          {"words", words},
          {"phonemes", phonemes}};
}

void limit_child() {
  rlimit memory{memory_bytes, memory_bytes}, none{0, 0};
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // sanitisers reserve terabytes
  setrlimit(RLIMIT_AS, &memory);
#else
  (void)memory;
#endif
  setrlimit(RLIMIT_CORE, &none);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  alarm(seconds_for_one);
}

// Ends the child: 0 when a whole answer was written.
[[noreturn]] void answer_in_child(const std::string& text, const std::vector<Language>& languages,
                                  int rate) {
  limit_child();
  bool written = false;
  try {
    std::vector<short> sound;
    json head = make_answer(json::parse(text), languages, rate, sound);
    written = answer(head, sound);
  } catch (const std::exception&) {
    _exit(2);  // nothing was written: the parent answers
  }
  _exit(written ? 0 : 1);
}

json id_of(const std::string& text) {
  json request = json::parse(text, nullptr, false);
  return request.is_object() && request.contains("id") ? request["id"] : json(nullptr);
}

// Serves one request; returns false when the connection is of no more use.
bool serve_one(const std::vector<Language>& languages, int rate) {
  unsigned char bytes[protocol::header_bytes];
  if (!read_all(reinterpret_cast<char*>(bytes), sizeof bytes)) return false;
  protocol::Header header = protocol::read_header(bytes);
  if (header.json > protocol::max_request_json || header.sound != 0) return false;
  std::string text(header.json, '\0');
  if (!read_all(text.data(), text.size())) return false;

  pid_t child = fork();
  if (child == 0) answer_in_child(text, languages, rate);
  if (child < 0) return answer({{"id", id_of(text)}, {"error", "no process for eSpeak NG"}});
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {}
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return true;
  if (WIFEXITED(status) && WEXITSTATUS(status) == 1) return false;
  // A whole answer is made before the first byte is written, so a crash leaves nothing behind.
  std::string how = WIFSIGNALED(status) ? strsignal(WTERMSIG(status)) : "a request it cannot read";
  return answer({{"id", id_of(text)}, {"error", "eSpeak NG failed on the text: " + how}});
}

}  // namespace

int main(int argc, char** argv) {
  if (wellspring::about::answer_version(argc, argv, {"nlohmann-json"})) return 0;
  signal(SIGPIPE, SIG_IGN);
  int rate = initialise(false);
  if (rate <= 0) {
    answer({{"error", "eSpeak NG cannot start: is the package espeak-ng-data installed?"}});
    return 1;
  }
  std::vector<Language> languages = list_languages();
  // Files that every child would read from disk are read once, here.
  if (const Language* language = find_language(languages, "en"))
    espeak_SetVoiceByName(language->voice.c_str());

  std::vector<std::string> tags;
  for (const Language& language : languages) tags.push_back(language.tag);
  std::sort(tags.begin(), tags.end());
  tags.erase(std::unique(tags.begin(), tags.end()), tags.end());
  if (!answer({{"engine", std::string("eSpeak NG ") + espeak_Info(nullptr)}, {"languages", tags}}))
    return 1;
  while (serve_one(languages, rate)) {}
  return 0;
}
