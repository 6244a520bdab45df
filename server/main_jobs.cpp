// SPDX-License-Identifier: Apache-2.0
// Runs `wellspring jobs`: long work in shards under a queue of NATS JetStream (docs/jobs.md).
// Without a command it lists jobs. Exit status: 0 done, 1 the input is wrong or a shard is dead, 2
// the command line is wrong.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <fmt/core.h>
#include <iostream>
#include <nlohmann/json.hpp>
#include <random>
#include <sched.h>
#include <thread>
#include <unistd.h>

#include "about/version.h"
#include "base/clock.h"
#include "base/log.h"
#include "main_jobs_run.h"
#include "wire/tokens.h"
#include "workers/message.h"
#include "workers/program_number.h"

using namespace wellspring;
using namespace wellspring::program;

namespace {

constexpr double submit_patience = 20;  // seconds
constexpr std::chrono::milliseconds look_every{500};

struct Options {
  LineSettings line;
  JobFolders folders;
  std::string key_file, token_file, job, name, hours, out;
  std::vector<std::string> words;
  int shards = 1, cores = 0;
  bool json = false, until_empty = false;
};

using WrongOption = CLI::ValidationError;

std::string join(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

JobState find_job(JobLine& line, const std::string& job) {
  if (is_job_name(job))
    if (std::vector<JobState> found = line.read(job); !found.empty()) return found[0];
  throw std::runtime_error("there is no job '" + job + "'; `./wellspring jobs` lists them");
}

// Makes a name of what is done, what with, and chance.
std::string make_name(const JobCommand& command) {
  std::string name = command.program + "-";
  const std::vector<std::string> paths = command.paths();
  if (!paths.empty())
    for (const char c : std::filesystem::path(paths[0]).stem().string().substr(0, 32))
      name += is_job_name(std::string_view(&c, 1)) ? c : '-';
  return name + fmt::format("-{:06x}", std::random_device()() & 0xffffff);
}

int submit(const Options& options) {
  const JobCommand command = check_words(options.words, uint32_t(options.shards));
  const JobOrder order{make_name(command),       program_number(version_number()),
                       instruction_set(),        number_inputs(command, options.folders),
                       uint32_t(options.shards), options.words};
  LineSettings settings = options.line;
  const double until = seconds_now() + submit_patience;
  settings.goes_on = [until] { return seconds_now() < until; };
  JobLine line(settings);
  line.tell(order);
  for (uint32_t i = 0; i < order.shards; i++)
    line.add({order.job, i, 0}, fmt::format("{}.{}", order.job, i));
  std::cout << order.job << "\n";
  return 0;
}

nlohmann::ordered_json to_json(const JobState& job) {
  nlohmann::ordered_json out{{"job", job.order.job},
                             {"command", job.order.words},
                             {"version", job.order.version},
                             {"share", job.share()}};
  out["shards"] = nlohmann::ordered_json::array();
  for (const JobEvent& shard : job.shards) {
    nlohmann::ordered_json one{{"shard", shard.shard + 1}, {"state", to_word(shard.news)}};
    if (!shard.worker.empty()) one["worker"] = shard.worker;
    if (!shard.reason.empty()) one["reason"] = shard.reason;
    if (shard.news == JobNews::works) one["share"] = shard.share;
    if (shard.news == JobNews::done) one["seconds"] = shard.seconds;
    out["shards"].push_back(std::move(one));
  }
  return out;
}

void print_job(const JobState& job) {
  std::string text = fmt::format("{}  {:.0f} %  {} of {} shards done", job.order.job,
                                 100 * job.share(), job.count(JobNews::done), job.shards.size());
  for (const auto& [news, words] :
       {std::pair(JobNews::works, "at work"), std::pair(JobNews::waits, "wait"),
        std::pair(JobNews::refused, "wait for another machine"),
        std::pair(JobNews::failed, "wait to be tried again"),
        std::pair(JobNews::dead, "failed for good")})
    if (const size_t count = job.count(news)) text += fmt::format(", {} {}", count, words);
  std::cout << text << "\n  " << join(job.order.words) << "\n";
  for (const JobEvent& shard : job.shards)
    if (!shard.reason.empty())
      std::cout << fmt::format("  shard {} {} at {}: {}\n", shard.shard + 1, to_word(shard.news),
                               shard.worker, shard.reason);
  if (job.count(JobNews::dead) > 0)
    std::cout << fmt::format("  ./wellspring jobs retry {} tries them again\n", job.order.job);
}

int list(JobLine& line, const Options& options) {
  const std::vector<JobState> jobs = line.read();
  if (options.json) {
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    for (const JobState& job : jobs) all.push_back(to_json(job));
    std::cout << all.dump(2) << "\n";
    return 0;
  }
  for (const JobState& job : jobs) print_job(job);
  if (jobs.empty()) std::cout << "no jobs\n";
  return 0;
}

int wait_for(const Options& options) {
  LineSettings settings = options.line;
  JobLine line(settings);
  settings.goes_on = [] { return true; };
  JobLine patient(settings);
  find_job(line, options.job);
  Progress progress(options.job, 10);
  while (true) {
    const JobState job = find_job(patient, options.job);
    if (job.count(JobNews::done) == job.shards.size()) return 0;
    if (job.count(JobNews::dead) > 0) {
      progress.clear();
      print_job(job);
      return 1;
    }
    progress.tell(job.share(),
                  fmt::format("{} of {} shards", job.count(JobNews::done), job.shards.size()));
    std::this_thread::sleep_for(look_every);
  }
}

int fetch(const Options& options) {
  JobLine line(options.line);
  const JobState job = find_job(line, options.job);
  if (job.count(JobNews::done) < job.shards.size())
    throw std::runtime_error(fmt::format("{}: {} of {} shards are done", options.job,
                                         job.count(JobNews::done), job.shards.size()));
  return fetch_job(line, job, options.folders, options.out.empty() ? options.job : options.out);
}

int retry(const Options& options) {
  JobLine line(options.line);
  const JobState job = find_job(line, options.job);
  size_t count = 0;
  for (const JobEvent& shard : job.shards) {
    if (shard.news != JobNews::dead) continue;
    const uint64_t place = line.add({options.job, shard.shard, 0},
                                    fmt::format("{}.{}.{}", options.job, shard.shard, shard.place));
    line.tell(JobEvent{options.job, shard.shard, JobNews::waits, place, 0, 0, "", "", 0, {}});
    count++;
  }
  std::cout << fmt::format("{} shards wait again\n", count);
  return 0;
}

int remove(const Options& options) {
  JobLine line(options.line);
  line.remove(find_job(line, options.job), line.read());
  std::cout << options.job << " is removed\n";
  return 0;
}

// Leaves the other cores to others, here and in programs that are started. Processes begin at
// different cores, so that several on a machine have their own.
void keep_to_cores(int cores) {
  cpu_set_t all;
  CPU_ZERO(&all);
  if (cores == 0 || sched_getaffinity(0, sizeof all, &all) != 0) return;
  std::vector<int> allowed;
  for (int i = 0; i < CPU_SETSIZE; i++)
    if (CPU_ISSET(i, &all)) allowed.push_back(i);
  if (size_t(cores) >= allowed.size()) return;
  cpu_set_t own;
  CPU_ZERO(&own);
  for (int i = 0; i < cores; i++) CPU_SET(allowed[size_t(getpid() + i) % allowed.size()], &own);
  sched_setaffinity(0, sizeof own, &own);
}

int work(const Options& options) {
  WorkSettings settings{options.line, options.folders, options.name,
                        program_number(version_number())};
  settings.until_empty = options.until_empty;
  int from_hour = 0, from_minute = 0, to_hour = 0, to_minute = 0;
  char rest = 0;
  if (!options.hours.empty() &&
      (std::sscanf(options.hours.c_str(), "%d:%d-%d:%d%c", &from_hour, &from_minute, &to_hour,
                   &to_minute, &rest) != 4 ||
       std::min({from_hour, from_minute, to_hour, to_minute}) < 0 ||
       std::max(from_hour, to_hour) > 23 || std::max(from_minute, to_minute) > 59))
    throw WrongOption("--hours " + options.hours, "FROM-TO is expected, e.g. 20:00-07:30");
  settings.begin = 60 * from_hour + from_minute, settings.end = 60 * to_hour + to_minute;
  if (!is_worker_name(options.name))
    throw WrongOption("--name", "1 to 32 letters, digits, - and _ are expected");
  keep_to_cores(options.cores);
  return work_on_jobs(settings);
}

void add_options(CLI::App& app, Options& o) {
  app.fallthrough();
  app.add_option("--nats", o.line.channel.url, "address of NATS, e.g. nats://10.0.0.5:4222")
      ->envname("WELLSPRING_NATS")
      ->required();
  app.add_option("--workers-key", o.key_file,
                 "file of the secret that seals messages; without it WELLSPRING_WORKERS_KEY");
  app.add_option("--nats-token-file", o.token_file,
                 "file of the token that NATS asks for; without it WELLSPRING_NATS_TOKEN");
  app.add_option("--nats-ca", o.line.channel.authority, "certificates that sign that of NATS");
  app.add_option("--nats-cert", o.line.channel.certificate, "this client's certificate in PEM");
  app.add_option("--nats-key", o.line.channel.key, "its key in PEM");
  app.add_option("--store", o.line.store_gib,
                 "GiB that files of shards may take at NATS, when its streams are made")
      ->check(CLI::Range(0.001, 1e6))
      ->capture_default_str();
  app.add_option("--folder", o.folders.inputs, "below it lies all that jobs read")
      ->capture_default_str();
  app.add_option("--scratch", o.folders.scratch, "folder for shards that are worked on")
      ->capture_default_str();
  app.add_option("--cache", o.folders.cache, "folder where servers look for bakes")
      ->capture_default_str();
  app.add_flag("--json", o.json, "lists jobs for programs");
}

}  // namespace

int main(int argc, char** argv) {
  if (answer_version(argc, argv)) return 0;
  log::start("jobs");
  CLI::App app{"Does long work in shards on many machines; without a command it lists jobs."};
  Options options;
  options.name = default_worker_name();
  add_options(app, options);
  app.require_subcommand(0, 1);
  CLI::App& submits = *app.add_subcommand("submit", "queues a job and prints its name");
  submits.add_option("--shards", options.shards, "parts that machines may do side by side")
      ->check(CLI::Range(1, most_shards))
      ->capture_default_str();
  submits
      .add_option("words", options.words, "after --: the command, e.g. bake content/ID --passes 64")
      ->required();
  CLI::App& works = *app.add_subcommand("work", "does shards, one after another");
  works.add_option("--name", options.name, "of this machine in lists")->capture_default_str();
  works.add_option("--cores", options.cores, "that it may use; 0: all")->check(CLI::Range(0, 1024));
  works.add_option("--hours", options.hours, "of the day only, e.g. 20:00-07:30");
  works.add_flag("--until-empty", options.until_empty, "ends when no job has anything left to do");
  CLI::App& waits = *app.add_subcommand("wait", "waits until a job is done, or a shard is dead");
  CLI::App& fetches =
      *app.add_subcommand("fetch", "brings a job's files home and puts them together");
  fetches.add_option("--out", options.out,
                     "folder of pictures and clips; without it the job's name");
  CLI::App& retries = *app.add_subcommand("retry", "queues a job's dead shards again");
  CLI::App& removes = *app.add_subcommand("remove", "ends a job and forgets it");
  for (CLI::App* one : {&waits, &fetches, &retries, &removes})
    one->add_option("job", options.job, "name of the job")->required();
  try {
    app.parse(argc, argv);
    options.line.key = make_message_key(read_token(options.key_file, "WELLSPRING_WORKERS_KEY"));
    options.line.channel.token = read_token(options.token_file, "WELLSPRING_NATS_TOKEN");
    options.line.channel.name = "wellspring jobs " + options.name;
    if (submits.parsed()) return submit(options);
    if (works.parsed()) return work(options);
    if (waits.parsed()) return wait_for(options);
    if (fetches.parsed()) return fetch(options);
    if (retries.parsed()) return retry(options);
    if (removes.parsed()) return remove(options);
    JobLine line(options.line);
    return list(line, options);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const std::exception& error) {
    std::cerr << "wellspring jobs: " << error.what() << "\n";
    return 1;
  }
}
