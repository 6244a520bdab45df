// SPDX-License-Identifier: Apache-2.0
#include "main_jobs_run.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fmt/core.h>
#include <fstream>
#include <iostream>
#include <map>
#include <regex>
#include <sodium.h>
#include <sstream>
#include <unistd.h>

#include "base/child.h"
#include "base/rng.h"

namespace wellspring::program {
namespace {

namespace fs = std::filesystem;

constexpr double look_every = 0.1, patience = 10;  // seconds
constexpr size_t tail_bytes = 4096, most_reason_lines = 4;

std::string program_file(const std::string& name) {
  return fs::canonical("/proc/self/exe").parent_path() / ("wellspring_" + name);
}

int open_output(const std::string& file) {
  const int opened = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (opened < 0) throw std::runtime_error(file + ": " + std::strerror(errno));
  return opened;
}

// Returns the end of a file; empty: there is none.
std::string read_tail(const std::string& file) {
  std::ifstream in(file, std::ios::binary | std::ios::ate);
  if (!in) return {};
  const auto size = size_t(in.tellg()), from = size > tail_bytes ? size - tail_bytes : 0;
  in.seekg(std::streamoff(from));
  std::string text(size - from, 0);
  in.read(text.data(), std::streamsize(text.size()));
  return text;
}

const std::regex& progress_pattern() {
  static const std::regex pattern(R"(\] +([0-9]{1,3}) %)");
  return pattern;
}

float share_of(const std::string& tail) {
  float share = 0;
  for (std::sregex_iterator match(tail.begin(), tail.end(), progress_pattern()), end; match != end;
       ++match)
    share = std::min(float(std::stoi((*match)[1])) / 100, 1.0f);
  return share;
}

std::string reason_of(const std::string& tail) {
  std::vector<std::string> lines;
  std::istringstream in(tail);
  for (std::string line; std::getline(in, line);)
    if (!line.empty() && !std::regex_search(line, progress_pattern())) lines.push_back(line);
  std::string reason;
  const size_t first = lines.size() > most_reason_lines ? lines.size() - most_reason_lines : 0;
  for (size_t i = first; i < lines.size(); i++) reason += (i > first ? "\n" : "") + lines[i];
  return reason;
}

// Adds a file's bytes, or those of all files below a folder with their names.
void add_path(const fs::path& path, crypto_generichash_state& state) {
  const auto add = [&](const char* bytes, size_t size) {
    crypto_generichash_update(&state, reinterpret_cast<const uint8_t*>(bytes), size);
  };
  if (fs::is_directory(path)) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::recursive_directory_iterator(path))
      if (entry.is_regular_file()) files.push_back(entry.path());
    std::ranges::sort(files);
    for (const fs::path& file : files) {
      const std::string name = file.lexically_relative(path).string();
      add(name.c_str(), name.size() + 1);
      add_path(file, state);
    }
    return;
  }
  std::ifstream in(path, std::ios::binary);
  std::vector<char> part(1 << 20);
  uint64_t all = 0;
  while (in) {
    in.read(part.data(), std::streamsize(part.size()));
    add(part.data(), size_t(in.gcount()));
    all += uint64_t(in.gcount());
  }
  if (!in.eof()) throw std::runtime_error(path.string() + ": cannot be read");
  add(reinterpret_cast<const char*>(&all), sizeof all);
}

// Asks the bake for the number of its scene.
uint64_t number_scene(const std::vector<std::string>& words, const JobFolders& folders) {
  const fs::path scratch = fs::path(folders.scratch) / fmt::format("scene-{}", getpid());
  fs::create_directories(scratch);
  const ProgramEnd end = run_program("bake", {words[0], "--scene-number", "--cache", folders.cache},
                                     scratch, [](float) { return true; });
  const std::string text = read_tail(scratch / "stdout.txt");
  fs::remove_all(scratch);
  if (end.status != 0) throw std::runtime_error(end.last_lines);
  return std::stoull(text, nullptr, 16);
}

}  // namespace

ProgramEnd run_program(const std::string& name, const std::vector<std::string>& words,
                       const std::string& folder, const std::function<bool(float)>& goes_on) {
  fs::create_directories(folder);
  const std::string errors = folder + "/stderr.txt";
  const int out = open_output(folder + "/stdout.txt"), err = open_output(errors);
  ChildSettings settings;
  // It ends with this program, whatever ends it; and gives way to all others.
  settings.words = {"setpriv", "--pdeathsig", "KILL", "nice", "-n", "10", program_file(name)};
  settings.words.insert(settings.words.end(), words.begin(), words.end());
  settings.files = {{out, 1}, {err, 2}};
  settings.apart = true, settings.patience = patience;
  ProgramEnd end;
  {
    Child child(settings);
    close(out), close(err);
    while (true) {
      if (const auto status = child.wait(look_every)) {
        end.status = *status;
        break;
      }
      if (goes_on(share_of(read_tail(errors)))) continue;
      end.was_stopped = true;
      break;
    }
  }
  end.last_lines = reason_of(read_tail(errors));
  return end;
}

std::vector<std::string> local_words(const JobCommand& command, const JobFolders& folders) {
  std::vector<std::string> words;
  for (const JobWord& word : command.words) {
    if (!word.is_path) {
      words.push_back(word.text);
      continue;
    }
    const auto path = path_below(folders.inputs, word.text);
    if (!path) throw std::runtime_error(word.text + " is not below " + folders.inputs);
    words.push_back(*path);
  }
  return words;
}

uint64_t number_inputs(const JobCommand& command, const JobFolders& folders) {
  const std::vector<std::string> words = local_words(command, folders);
  if (command.merge == JobMerge::bake) return number_scene(words, folders);
  // Files are read once, as long as they do not change.
  static std::map<std::string, uint64_t> known;
  std::string title;
  for (size_t i = 0; i < words.size(); i++) {
    if (!command.words[i].is_path) continue;
    title += words[i];
    if (fs::is_regular_file(words[i]))
      title += fmt::format(" {} {}\n", fs::file_size(words[i]),
                           fs::last_write_time(words[i]).time_since_epoch().count());
    else title.clear(), i = words.size();
  }
  if (const auto found = known.find(title); !title.empty() && found != known.end())
    return found->second;
  crypto_generichash_state state;
  uint64_t number = 0;
  static_assert(crypto_generichash_BYTES_MIN > sizeof number);
  std::array<uint8_t, crypto_generichash_BYTES> digest;
  crypto_generichash_init(&state, nullptr, 0, digest.size());
  for (size_t i = 0; i < words.size(); i++)
    if (command.words[i].is_path) add_path(words[i], state);
  crypto_generichash_final(&state, digest.data(), digest.size());
  std::memcpy(&number, digest.data(), sizeof number);
  if (!title.empty()) known[title] = number;
  return number;
}

int fetch_job(JobLine& line, const JobState& job, const JobFolders& folders,
              const std::string& out) {
  const JobCommand command = check_words(job.order.words, job.order.shards);
  if (number_inputs(command, folders) != job.order.inputs)
    throw std::runtime_error("what the job reads has changed here since it was submitted");
  const fs::path home = fs::path(folders.scratch) / job.order.job;
  const bool beside = command.merge == JobMerge::pictures || command.merge == JobMerge::none;
  std::vector<std::string> words = local_words(command, folders), files, shards;
  for (const JobEvent& shard : job.shards) {
    const fs::path folder =
        beside ? fs::path(out) : home / fmt::format("shard-{}", shard.shard + 1);
    shards.push_back(folder);
    for (const ShardFile& file : shard.files) {
      if (command.merge == JobMerge::bake && !file.name.ends_with(".bake")) continue;
      files.push_back(folder / file.name);
      line.get_file(file, files.back());
      std::cerr << fmt::format("{}: {} bytes\n", files.back(), file.size);
    }
  }
  if (command.merge == JobMerge::none) return 0;
  if (command.merge == JobMerge::bake) words = {words[0], "--cache", folders.cache};
  if (command.merge == JobMerge::pictures || command.merge == JobMerge::clip)
    words.insert(words.end(), {"--out", out});
  words.push_back("--merge");
  if (command.merge == JobMerge::bake || command.merge == JobMerge::places)
    words.insert(words.end(), files.begin(), files.end());
  if (command.merge == JobMerge::clip) words.insert(words.end(), shards.begin(), shards.end());
  const fs::path merge = home / "merge";
  const ProgramEnd end = run_program(command.program, words, merge, [](float) { return true; });
  std::cerr << end.last_lines << (end.last_lines.empty() ? "" : "\n");
  std::cout << std::ifstream(merge / "stdout.txt").rdbuf();
  std::cout.clear();  // nothing was printed
  if (end.status == 0) fs::remove_all(home);
  return end.status == 0 ? 0 : 1;
}

}  // namespace wellspring::program
