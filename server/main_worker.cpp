// SPDX-License-Identifier: Apache-2.0
// Runs `wellspring worker --nats URL`: traces samples for servers on other machines
// (docs/workers.md). Exit status: 0 done, 1 the input is wrong, 2 the command line is wrong.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <csignal>
#include <condition_variable>
#include <filesystem>
#include <fmt/core.h>
#include <iostream>
#include <list>
#include <mutex>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <optional>
#include <unistd.h>

#include "about/version.h"
#include "base/clock.h"
#include "base/host.h"
#include "base/log.h"
#include "config/config_file.h"
#include "show/exhibit/load/exhibit_load.h"
#include "show/state/make_show.h"
#include "show/workers/workshop.h"
#include "wire/tokens.h"
#include "workers/channel.h"
#include "workers/crew.h"
#include "workers/message.h"
#include "workers/program_number.h"

using namespace wellspring;
using namespace wellspring::program;

namespace {

constexpr size_t most_waiting = 1 << 17;  // requests
constexpr double look_every = 0.02;       // seconds

std::atomic<bool> asked_to_stop = false;
void stop(int) { asked_to_stop = true; }

struct Options {
  ChannelSettings channel;
  std::string content = "content", exhibit, cache = "build/cache", name, key_file, token_file;
  int cores = 0;
  double fetch_most = 8;  // GiB
  ShowSettings show;
};

// Holds orders that wait. Those whose answers are wanted soonest come first.
class Orders {
 public:
  // Returns false if too much waits.
  bool add(TraceOrder order) {
    std::lock_guard lock(mutex_);
    if (waiting_ + order.requests.size() > most_waiting) return false;
    waiting_ += order.requests.size();
    const double now = seconds_now(), until = now + 0.001 * order.worth_ms;
    const auto after =
        std::ranges::find_if(orders_, [&](const Waiting& other) { return other.until > until; });
    orders_.insert(after, {now, until, std::move(order)});
    wake_.notify_one();
    return true;
  }
  struct Waiting {
    double came = 0, until = 0;  // seconds
    TraceOrder order;
  };
  std::optional<Waiting> take() {
    std::unique_lock lock(mutex_);
    const auto some = [this] { return !orders_.empty(); };
    if (!wake_.wait_for(lock, std::chrono::duration<double>(look_every), some)) return std::nullopt;
    Waiting first = std::move(orders_.front());
    orders_.pop_front();
    waiting_ -= first.order.requests.size();
    return first;
  }

 private:
  std::mutex mutex_;
  std::condition_variable wake_;
  std::list<Waiting> orders_;
  size_t waiting_ = 0;
};

// Returns the folders of the exhibits that are to be loaded.
std::vector<std::string> folders(const Options& options) {
  std::vector<std::string> all;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(options.content, error))
    if (std::filesystem::exists(entry.path() / "exhibit.json") &&
        (options.exhibit.empty() || entry.path().filename() == options.exhibit))
      all.push_back(entry.path());
  std::ranges::sort(all);
  return all;
}

LoadShow loader(const Options& options) {
  ShowSettings settings = options.show;
  settings.bakes = false;
  settings.weights.clear();
  return [settings](const std::string& folder, const std::string& cache) {
    ShowSettings own = settings;
    own.cache = cache;
    return make_show(load_exhibit(folder, cache), own);
  };
}

void load(const Options& options, Workshop& workshop) {
  for (const std::string& folder : folders(options)) {
    try {
      workshop.add(folder, options.cache);
    } catch (const ExhibitError& error) {
      for (const Problem& problem : error.problems)
        if (problem.fatal) std::cerr << "error: " << to_string(problem) << "\n";
    }
  }
  if (workshop.exhibits() == 0 && options.fetch_most == 0)
    throw std::runtime_error(options.content + ": no exhibit can be loaded");
}

void run(const Options& options) {
  const MessageKey key = make_message_key(read_token(options.key_file, "WELLSPRING_WORKERS_KEY"));
  Workshop workshop(program_number(version_number()), options.name, options.cache,
                    uint64_t(options.fetch_most * (1 << 30)), loader(options));
  load(options, workshop);
  Orders orders;
  Channel* line = nullptr;
  std::atomic<bool> ready = false;  // `line` is set
  std::atomic<uint64_t> refused_messages = 0;
  const auto send = [&](std::string_view to, std::string message,
                        const std::string& reply_to = {}) {
    if (ready && !to.empty()) line->send(std::string(to), reply_to, std::move(message));
  };
  Subscription calls{call_subject, "", [&](std::string_view message, std::string_view reply_to) {
                       RollCall call;
                       if (!read_message(message, key, call)) return void(refused_messages++);
                       const CallAnswer here{call.server,       call.number,
                                             options.name,      program_number(version_number()),
                                             instruction_set(), uint32_t(options.cores)};
                       send(reply_to, write_message(here, key));
                     }};
  Subscription work{
      orders_subject(options.name), "workers", [&](std::string_view message, std::string_view) {
        TraceOrder order;
        if (!read_message(message, key, order)) return void(refused_messages++);
        const uint64_t server = order.server, number = order.number;
        if (orders.add(std::move(order))) return;
        send(
            answers_subject(server),
            write_message(TraceAnswer{server, number, options.name, Refusal::busy, 0, 0, {}}, key));
      }};
  const std::string parts_subject = fmt::format("wellspring.files.{}-{}", options.name, getpid());
  const auto ask_for_files = [&] {
    if (const auto question = workshop.fetch().ask(seconds_now()))
      send(answers_subject(question->server), write_message(*question, key), parts_subject);
  };
  Subscription files{parts_subject, "", [&](std::string_view message, std::string_view) {
                       FilePart part;
                       if (!read_message(message, key, part)) return void(refused_messages++);
                       workshop.fetch().take(part, seconds_now());
                       ask_for_files();
                     }};
  ChannelSettings settings = options.channel;
  settings.name = "wellspring worker " + options.name;
  Channel channel(settings, {calls, work, files});
  line = &channel, ready = true;
  std::cout << fmt::format("Wellspring worker {}: {} exhibits, {} cores, {}", options.name,
                           workshop.exhibits(), options.cores, instruction_set())
            << std::endl;
  uint64_t samples = 0, refusals = 0;
  while (!asked_to_stop) {
    const std::optional<Orders::Waiting> next = orders.take();
    workshop.advance();
    ask_for_files();
    if (!next) continue;
    const TraceAnswer answer = workshop.answer(next->order, seconds_now() - next->came);
    samples += answer.samples.size();
    if (answer.refusal != Refusal::none && refusals++ == 0)
      log::warn("refused an order of '{}': {}", next->order.exhibit, to_word(answer.refusal));
    send(answers_subject(answer.server), write_message(answer, key));
  }
  ready = false;
  log::info("{} samples traced, {} orders refused, {} messages that were none", samples, refusals,
            refused_messages.load());
}

}  // namespace

int main(int argc, char** argv) {
  if (answer_version(argc, argv)) return 0;
  log::start("worker");
  CLI::App app{"Traces samples of exhibits for servers on other machines."};
  Options options;
  app.option_defaults()->always_capture_default();
  app.add_option("--nats", options.channel.url, "address of NATS, e.g. nats://10.0.0.5:4222");
  app.add_option("--content", options.content, "folder of exhibit packages, as the server's");
  app.add_option("--exhibit", options.exhibit, "id of the only one that is loaded at the start");
  app.add_option("--cache", options.cache,
                 "folder of kept illumination maps, and of exhibits that are fetched from servers");
  app.add_option("--fetch-most", options.fetch_most,
                 "GiB of an exhibit that may be fetched; 0: none is")
      ->check(CLI::Range(0.0, 1024.0));
  app.add_option("--name", options.name,
                 "of this worker; those of one name share its orders; empty: a name of its own");
  app.add_option("--cores", options.cores, "that it may use; 0: all")->check(CLI::Range(0, 1024));
  app.add_option("--technique", options.show.technique, "as the server's");
  app.add_option("--still-technique", options.show.still_technique, "as the server's");
  app.add_option("--workers-key", options.key_file,
                 "file of the secret that seals messages; without it WELLSPRING_WORKERS_KEY");
  app.add_option("--nats-token-file", options.token_file,
                 "file of the token that NATS asks for; without it WELLSPRING_NATS_TOKEN");
  app.add_option("--nats-ca", options.channel.authority, "certificates that sign that of NATS");
  app.add_option("--nats-cert", options.channel.certificate, "this client's certificate in PEM");
  app.add_option("--nats-key", options.channel.key, "its key in PEM");
  add_config(app, installed_config("worker.conf"));
  try {
    parse_with_config(app, argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const ConfigError& error) {
    std::cerr << "error: " << error.what() << "\n";
    return 1;
  }
  if (options.channel.url.empty()) {
    std::cerr << "wellspring worker: --nats is missing: the address of NATS\n";
    return 2;
  }
  if (options.name.empty()) options.name = default_worker_name();
  if (!is_worker_name(options.name)) {
    std::cerr << "--name " << options.name << ": 1 to 32 letters, digits, - and _ are expected\n";
    return 2;
  }
  const int all = oneapi::tbb::info::default_concurrency();
  if (options.cores == 0 || options.cores > all) options.cores = all;
  const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism,
                                          size_t(options.cores));
  std::signal(SIGINT, stop);
  std::signal(SIGTERM, stop);
  try {
    options.channel.token = read_token(options.token_file, "WELLSPRING_NATS_TOKEN");
    run(options);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "wellspring worker: " << error.what() << "\n";
    return 1;
  }
}
