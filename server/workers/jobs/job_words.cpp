// SPDX-License-Identifier: Apache-2.0
#include "workers/jobs/job_words.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <span>
#include <stdexcept>

#include "workers/jobs/job.h"

namespace wellspring::workers {
namespace {

namespace fs = std::filesystem;

enum class Value : uint8_t { none, number, text, path, paths };

struct Option {
  const char* name;
  Value value;
};

struct Program {
  const char *name, *part;  // "import", "picture"; part may be empty
  int least_paths, most_paths;
  JobMerge merge;
  std::vector<Option> options;
  const char* needs;  // an option without which shards are not the same bits; empty: none
};

constexpr int any_number = 4096;

const std::vector<Program>& programs() {
  using enum Value;
  static const std::vector<Program> all{
      {"bake", "", 1, 1, JobMerge::bake, {{"--passes", number}, {"--nodes", number}}, "--passes"},
      {"import",
       "picture",
       1,
       any_number,
       JobMerge::pictures,
       {{"--width", number}, {"--quality", number}},
       ""},
      {"import",
       "bands",
       1,
       1,
       JobMerge::none,
       {{"--name", text}, {"--width", number}, {"--bits", number}, {"--quality", number}},
       ""},
      {"import",
       "scan",
       1,
       any_number,
       JobMerge::none,
       {{"--name", text},
        {"--up", text},
        {"--unit", number},
        {"--turn", number},
        {"--memory", number}},
       ""},
      {"clip",
       "",
       2,
       2,
       JobMerge::clip,
       {{"--lang", text},
        {"--from", number},
        {"--seconds", number},
        {"--fps", number},
        {"--size", text},
        {"--spp", number},
        {"--close", none},
        {"--calm", none},
        {"--sheet-rate", number}},
       ""},
      {"lamps",
       "",
       0,
       0,
       JobMerge::places,
       {{"--picture", path},
        {"--places", number},
        {"--lamps", text},
        {"--lamp-file", paths},
        {"--adaptation", text},
        {"--wavelengths", text},
        {"--values", text}},
       "--picture"},
  };
  return all;
}

bool is_number(const std::string& word) {
  double value = 0;
  const char* end = word.data() + word.size();
  const auto [at, error] = std::from_chars(word.data(), end, value);
  return error == std::errc() && at == end;
}

bool is_text(const std::string& word) {
  constexpr std::string_view others = "._:,+*=-";
  return !word.empty() && word[0] != '-' && std::ranges::all_of(word, [&](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           others.find(c) != std::string_view::npos;
  });
}

// Says whether a path may be asked for: relative, downwards, and no option.
bool is_path(const std::string& word) {
  if (word.empty() || word[0] == '-' || word[0] == '/' || word[0] == '@') return false;
  if (std::ranges::any_of(word, [](char c) { return static_cast<unsigned char>(c) < 32; }))
    return false;
  return std::ranges::none_of(fs::path(word), [](const fs::path& part) { return part == ".."; });
}

[[noreturn]] void refuse(const std::string& word, const std::string& why) {
  throw std::invalid_argument("'" + word + "' " + why);
}

const Program& find_program(const std::vector<std::string>& words) {
  if (words.empty()) throw std::invalid_argument("a job has the words of a command");
  const auto fits = [&](const Program& program) {
    return words[0] == program.name &&
           (!*program.part || (words.size() > 1 && words[1] == program.part));
  };
  const auto program = std::ranges::find_if(programs(), fits);
  if (program == programs().end())
    refuse(words[0],
           "is no command of jobs: bake, import picture, import bands, import scan, clip, "
           "lamps --picture");
  return *program;
}

// Reads the values of an option, from `at` on.
void take_values(const Option& option, std::span<const std::string> words, size_t& at,
                 JobCommand& command) {
  if (option.value == Value::none) return;
  do {
    if (at == words.size()) refuse(option.name, "wants a value");
    const std::string& word = words[at++];
    const bool path = option.value == Value::path || option.value == Value::paths;
    if (option.value == Value::number && !is_number(word)) refuse(word, "is no number");
    if (option.value == Value::text && !is_text(word)) refuse(word, "is no plain word");
    if (path && !is_path(word)) refuse(word, "is no path below the folder of inputs");
    command.words.push_back({word, path});
  } while (option.value == Value::paths && at < words.size() && !words[at].starts_with("-"));
}

}  // namespace

std::vector<std::string> JobCommand::paths() const {
  std::vector<std::string> found;
  for (const JobWord& word : words)
    if (word.is_path) found.push_back(word.text);
  return found;
}

JobCommand check_words(const std::vector<std::string>& words, uint32_t shards) {
  const Program& program = find_program(words);
  JobCommand command{program.name, {}, program.merge};
  size_t at = 1;
  if (*program.part) command.words.push_back({words[at++], false});
  int paths = 0;
  bool has_needed = !*program.needs;
  while (at < words.size()) {
    const std::string& word = words[at++];
    if (word.size() > most_word_bytes) refuse(word.substr(0, 40), "is too long");
    if (!word.starts_with("-")) {
      if (!is_path(word)) refuse(word, "is no path below the folder of inputs");
      if (++paths > program.most_paths) refuse(word, "is one path too many");
      command.words.push_back({word, true});
      continue;
    }
    const auto option =
        std::ranges::find_if(program.options, [&](const Option& one) { return word == one.name; });
    if (option == program.options.end()) refuse(word, "is no option of jobs");
    command.words.push_back({word, false});
    has_needed = has_needed || word == program.needs;
    take_values(*option, words, at, command);
  }
  if (paths < program.least_paths) refuse(words[0], "wants a path below the folder of inputs");
  if (!has_needed) refuse(words[0], "wants " + std::string(program.needs));
  if (command.merge == JobMerge::none && shards > 1)
    refuse(words[0] + " " + program.part, "has one shard");
  return command;
}

std::optional<std::string> path_below(const std::string& folder, const std::string& path) {
  std::error_code error;
  const fs::path whole = fs::canonical(folder, error), found = fs::canonical(whole / path, error);
  if (error) return {};
  const auto [inside, rest] = std::mismatch(whole.begin(), whole.end(), found.begin(), found.end());
  if (inside != whole.end()) return {};
  return (whole / path).lexically_normal().string();
}

}  // namespace wellspring::workers
