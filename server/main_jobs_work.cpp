// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <csignal>
#include <ctime>
#include <filesystem>
#include <fmt/core.h>
#include <iostream>
#include <thread>

#include "base/clock.h"
#include "base/log.h"
#include "main_jobs_run.h"
#include "workers/message.h"

namespace wellspring::program {
namespace {

namespace fs = std::filesystem;

constexpr uint32_t most_failures = 3;
constexpr double tell_every = 1, look_for_job_every = 5;  // seconds
constexpr std::chrono::seconds refused_rest{5};
constexpr float least_news = 0.01f;  // share of a shard that is worth telling

std::atomic<bool> asked_to_stop = false;
void stop(int) { asked_to_stop = true; }

// Says whether it is one of the hours in which shards are taken.
bool is_time(const WorkSettings& settings) {
  if (settings.begin == settings.end) return true;
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  const int minute = 60 * local.tm_hour + local.tm_min;
  return settings.begin < settings.end ? minute >= settings.begin && minute < settings.end
                                       : minute >= settings.begin || minute < settings.end;
}

void rest(std::chrono::seconds most) {
  for (auto left = most * 10; left.count() > 0 && !asked_to_stop; left -= std::chrono::seconds(1))
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
}

// Says why this machine would not find the same bits; empty: it would.
std::string find_difference(const JobOrder& order, const JobCommand& command,
                            const WorkSettings& settings) {
  if (order.version != settings.version)
    return fmt::format("version: here is {}, the job wants {}", settings.version, order.version);
  if (order.instructions != instruction_set())
    return fmt::format("instructions: here are {}, the job wants {}", instruction_set(),
                       order.instructions);
  try {
    if (number_inputs(command, settings.folders) != order.inputs)
      return command.merge == JobMerge::bake ? "scene: the exhibit's files differ here"
                                             : "files: what the job reads differs here";
  } catch (const std::exception& error) {
    return fmt::format("files: {}", error.what());
  }
  return {};
}

// Returns the arguments of a shard's program, which writes its files below `files`.
std::vector<std::string> shard_words(const JobCommand& command, const Shard& shard,
                                     const JobFolders& folders, const fs::path& files) {
  std::vector<std::string> words = local_words(command, folders);
  const std::string number = std::to_string(shard.index + 1);
  if (command.merge != JobMerge::none) words.insert(words.end(), {"--shard", to_text(shard)});
  switch (command.merge) {
    case JobMerge::bake:
      words.insert(words.end(),
                   {"--out", files / (number + ".bake"), "--resume", "--cache", folders.cache});
      break;
    case JobMerge::places:
      words.insert(words.end(), {"--out", files / (number + ".places")});
      break;
    case JobMerge::clip: words.insert(words.end(), {"--out", files}); break;
    case JobMerge::pictures:
    case JobMerge::none: words.insert(words.end(), {"--out", files, "--overwrite"}); break;
  }
  return words;
}

// Does one shard after another.
class Worker {
 public:
  explicit Worker(const WorkSettings& settings) : settings_(settings), line_(settings.line) {}

  int run() {
    log::info("{} takes shards of jobs", settings_.name);
    while (!asked_to_stop) {
      if (!is_time(settings_)) {
        rest(std::chrono::seconds(1));
        continue;
      }
      const auto taken = line_.take();
      try {
        if (taken) do_shard(*taken);
        else if (settings_.until_empty && is_empty()) break;
      } catch (const LineError& error) {  // the queue hands the shard out again
        log::error("{}", error.what());
        rest(refused_rest);
      }
    }
    return 0;
  }

 private:
  bool is_empty() {
    return std::ranges::all_of(line_.read(), [](const JobState& job) {
      return job.count(JobNews::done) + job.count(JobNews::dead) == job.shards.size();
    });
  }

  void tell(const JobLine::Taken& taken, JobNews news, const std::string& reason, float share = 0) {
    line_.tell(JobEvent{taken.task.job,
                        taken.task.shard,
                        news,
                        taken.place,
                        taken.delivery,
                        share,
                        settings_.name,
                        reason,
                        0,
                        {}});
  }

  // Puts the shard into the queue again. Whoever crashed before will not be counted twice.
  uint64_t give_back(JobLine::Taken& taken, uint32_t failures) {
    const uint64_t place =
        line_.add({taken.task.job, taken.task.shard, failures},
                  fmt::format("{}.{}.{}", taken.task.job, taken.task.shard, taken.place));
    taken.end();
    return place;
  }

  void refuse(JobLine::Taken& taken, const std::string& why) {
    log::warn("{}, shard {}: refused: {}", taken.task.job, taken.task.shard + 1, why);
    tell(taken, JobNews::refused, why);
    give_back(taken, failures_of(taken));
    rest(refused_rest);
  }

  // Counts attempts that failed, and those that ended with the machine or the program that made
  // them.
  static uint32_t failures_of(const JobLine::Taken& taken) {
    return taken.task.failures + uint32_t(taken.delivery - 1);
  }

  void fail(JobLine::Taken& taken, const std::string& why) {
    log::warn("{}, shard {}: failed: {}", taken.task.job, taken.task.shard + 1, why);
    const uint32_t failures = failures_of(taken) + 1;
    if (failures < most_failures) {
      tell(taken, JobNews::failed, why);
      give_back(taken, failures);
      return;
    }
    tell(taken, JobNews::dead, why);
    taken.end();
  }

  void do_shard(JobLine::Taken& taken) {
    const std::vector<JobState> found = line_.read(taken.task.job);
    if (found.empty() || taken.task.shard >= found[0].order.shards ||
        found[0].shards[taken.task.shard].news == JobNews::done)
      return taken.end();  // was removed, or is done
    const JobOrder& order = found[0].order;
    JobCommand command;
    try {
      command = check_words(order.words, order.shards);
    } catch (const std::exception& error) {
      tell(taken, JobNews::dead, fmt::format("command: {}", error.what()));
      return taken.end();
    }
    if (failures_of(taken) >= most_failures) {
      const std::string& before = found[0].shards[taken.task.shard].reason;
      tell(taken, JobNews::dead,
           fmt::format("who took it ended without a word, {} times in all{}{}", most_failures,
                       before.empty() ? "" : "; last reason: ", before));
      return taken.end();
    }
    tell(taken, JobNews::works, "");
    if (const std::string why = find_difference(order, command, settings_); !why.empty())
      return refuse(taken, why);
    try {
      run_shard(taken, order, command);
    } catch (const LineError& error) {
      refuse(taken, error.what());  // its files stay here
    } catch (const std::exception& error) {
      fail(taken, error.what());
    }
  }

  void run_shard(JobLine::Taken& taken, const JobOrder& order, const JobCommand& command) {
    const double began = seconds_now();
    const Shard shard{int(taken.task.shard), int(order.shards)};
    const fs::path folder =
        fs::path(settings_.folders.scratch) / order.job / fmt::format("work-{}", shard.index + 1);
    const fs::path files = folder / "files";
    fs::create_directories(files);
    double told = began, looked = began;
    float share = 0;
    bool removed = false;
    const ProgramEnd end =
        run_program(command.program, shard_words(command, shard, settings_.folders, files), folder,
                    [&](float now_share) {
                      const double now = seconds_now();
                      if (now - told > tell_every && now_share > share + least_news) {
                        told = now, share = now_share;
                        tell(taken, JobNews::works, "", share);
                      }
                      if (now - looked > look_for_job_every) {
                        looked = now;
                        removed = line_.read(order.job).empty();
                      }
                      return !asked_to_stop && !removed && is_time(settings_);
                    });
    if (removed) {
      fs::remove_all(folder.parent_path());
      return taken.end();
    }
    if (end.was_stopped) {
      const uint64_t place = give_back(taken, failures_of(taken));
      return line_.tell(JobEvent{
          order.job, taken.task.shard, JobNews::waits, place, 0, 0, settings_.name, "", 0, {}});
    }
    if (end.status != 0)
      return fail(taken, !end.last_lines.empty() ? end.last_lines
                         : end.status < 0        ? fmt::format("ended by signal {}", -end.status)
                                                 : fmt::format("exit status {}", end.status));
    if (command.merge == JobMerge::none) fs::rename(folder / "stdout.txt", files / "printed.txt");
    JobEvent done{order.job,
                  taken.task.shard,
                  JobNews::done,
                  taken.place,
                  taken.delivery,
                  1,
                  settings_.name,
                  "",
                  0,
                  {}};
    std::vector<fs::path> made;
    for (const auto& entry : fs::directory_iterator(files))
      if (entry.is_regular_file()) made.push_back(entry.path());
    std::ranges::sort(made);
    for (const fs::path& file : made)
      done.files.push_back(line_.put_file(file, file.filename().string()));
    done.seconds = float(seconds_now() - began);
    line_.tell(done);
    taken.end();
    fs::remove_all(folder);
    std::error_code others;
    fs::remove(folder.parent_path(), others);  // unless other shards are there
    log::info("{}, shard {}: done in {:.1f} s", order.job, shard.index + 1, done.seconds);
  }

  const WorkSettings& settings_;
  JobLine line_;
};

}  // namespace

int work_on_jobs(const WorkSettings& given) {
  WorkSettings settings = given;
  settings.line.goes_on = [] { return !asked_to_stop; };
  std::signal(SIGINT, stop);
  std::signal(SIGTERM, stop);
  Worker worker(settings);
  std::cout << fmt::format("Wellspring worker {} takes shards of jobs", settings.name) << std::endl;
  return worker.run();
}

}  // namespace wellspring::program
