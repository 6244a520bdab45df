// SPDX-License-Identifier: Apache-2.0
// Runs `wellspring run`: options -> load -> threads. No other file knows both `museum` and
// `stream`.
#include <algorithm>
#include <atomic>
#include <csignal>
#include <iostream>
#include <fmt/core.h>
#include <functional>
#include <sys/prctl.h>
#include <unistd.h>

#include "about/version.h"
#include "base/clock.h"
#include "base/host.h"
#include "base/log.h"
#include "museum/front.h"
#include "museum/museum.h"
#include "options.h"
#include "show/http/pages.h"
#include "show/status/status.h"
#include "stream/stream.h"

namespace {

using namespace wellspring;
using namespace wellspring::program;

// Before `serving` nothing has to be written at the end; sums are the only thing that may be lost.
enum Phase : int { loading, serving, written };
// Signals set these on any thread; others read them.
std::atomic<bool> asked_to_stop = false, asked_to_reload = false, asked_to_reopen = false;
std::atomic<int> phase = loading;
std::atomic<unsigned> seconds_to_drain = 0;
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
constexpr unsigned seconds_to_end = 4;
#else  // everything is slower, and memory leaks are looked for at the end
constexpr unsigned seconds_to_end = 60;
#endif
constexpr int most_weight = 256;  // largest weight, percent, that HAProxy takes

// Ends the program: the first signal in order, the second at once.
void stop(int signal) {
  if (asked_to_stop.exchange(true)) _exit(128 + signal);
  if (phase == loading) _exit(0);
  alarm(seconds_to_drain + seconds_to_end);
}

void end_late(int) {
  constexpr char words[] = "not all work could be ended in time; it is left\n";
  if (write(STDERR_FILENO, words, sizeof(words) - 1) < 0) _exit(1);
  _exit(phase == written ? 0 : 1);
}

// Takes care that programs that are started here get no more rights than this one has
// (set-user-ID).
void renounce_rights() {
  prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  if (geteuid() == 0)
    log::warn("runs as root, which it needs for nothing: an ordinary user is safer");
}

// Prints the address on stdout, and returns the text.
std::string say_address(const AnswerSources& sources, const StreamSettings& stream) {
  std::string names;
  for (const ServedExhibit& one : sources.exhibits)
    names += (names.empty() ? "'" : ", '") + one.exhibit->id + "'";
  const char* scheme = stream.certificate.empty() ? "http" : "https";
  std::string said =
      fmt::format("serves {} at {}://{}:{}/", names, scheme, stream.host, stream.port);
  std::cout << "Wellspring " << said << std::endl;
  return said;
}

// Serves until the program is asked to stop. `reread`: takes those settings from the configuration
// that need no restart.
int serve(const ServerOptions& options, const std::function<void()>& reread) {
  ServiceManager manager;
  const auto pages = load_pages(options.web);
  Front front(pages);
  Doors doors;
  doors.answer = [&](const HttpQuestion& question) { return front.answer(question); };
  doors.answer_later = [&](const HttpQuestion& question, const std::shared_ptr<HttpAsker>& asker) {
    return front.answer_later(question, asker);
  };
  doors.slow = [](const HttpQuestion& question) { return question.path.ends_with("/sums.csv"); };
  doors.admit = [&](const HttpQuestion& question) { return admit(options.access, question); };
  doors.joined = [&](std::shared_ptr<Link> link) { front.join(std::move(link)); };
  std::atomic<const Museum*> loaded = nullptr;
  doors.agent = [&] {
    const Museum* museum = loaded;
    return museum ? fmt::format("{}%", std::min(museum->seats(), most_weight)) : std::string();
  };
  StreamSettings stream = options.stream;
  auto server = std::make_unique<Server>(stream, doors);
  std::atomic<const Server*> counted = server.get();  // read by the server's own threads
  stream.port = server->port();                       // the same port for the next server
  Museum museum(options.museum);
  AnswerSources& sources = museum.sources();
  sources.pages = &pages;
  sources.access = options.access;
  ReadSums sums;
  if (!options.museum.sums.empty())
    sums = [&](int64_t from, int64_t to) { return museum.read_sums(from, to); };
  sources.sums = [&](const HttpQuestion& question) { return answer_sums(sums, question); };
  sources.status = [&] { return museum.status(); };
  sources.speeds = [&] { return read_speeds(options.bench); };
  sources.stream_metrics = [&] {
    const Server* now = counted;
    return museum.metrics() + (now ? to_metrics(now->counters()) : std::string());
  };
  sources.door_counts = [&] {
    const Server* now = counted;
    const StreamCounters counters = now ? now->counters() : StreamCounters{};
    return DoorCounts{counters.flood_closed, counters.accept_errors};
  };
  sources.drains = [] { return asked_to_stop.load(); };
  std::string said;
  double ends_at = 0;  // seconds; time at which draining ends
  const auto ended = [&] {
    const bool reload = asked_to_reload.exchange(false);
    if (asked_to_reopen.exchange(false) || reload) log::reopen();
    if (reload) {
      manager.say_reloading();
      reread();
      if (server) server->reread_certificate();
      museum.reload();
      manager.say_ready(said);
    }
    if (museum.has_gone_on()) manager.ping(seconds_now());
    if (!asked_to_stop) return false;
    if (ends_at == 0) ends_at = seconds_now() + options.drain;
    return seconds_now() >= ends_at;
  };
  phase = serving;
  front.open(museum);
  loaded = &museum;
  for (bool changed = true; changed;) {
    if (!server) counted = (server = std::make_unique<Server>(stream, doors)).get();
    said = say_address(sources, stream);
    manager.say_ready(said);
    changed = museum.run(ended);
    if (!changed) {
      phase = written;
      manager.say("STOPPING=1");
      log::info("stopping");
    }
    museum.give_up_stills();
    server->stop();
    if (!changed) continue;
    counted = nullptr;
    server.reset();
    museum.take_over();
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (answer_version(argc, argv, {"Boost", "CLI11", "GLM", "nlohmann-json", "stb"})) return 0;
  log::start("server");
  ServerOptions options;
  if (int status = read_options(options, argc, argv); status >= 0) return status;
  renounce_rights();
  seconds_to_drain = unsigned(options.drain);
  std::signal(SIGINT, stop);
  std::signal(SIGTERM, stop);
  std::signal(SIGALRM, end_late);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGUSR1, [](int) { asked_to_reopen = true; });
  // SIGHUP asks a service to reload; for a program in a terminal it means that the terminal is
  // gone.
  if (isatty(STDERR_FILENO)) std::signal(SIGHUP, stop);
  else std::signal(SIGHUP, [](int) { asked_to_reload = true; });
  try {
    return serve(options, [&] { reread_options(options, argc, argv); });
  } catch (const ExhibitError& error) {
    for (const Problem& problem : error.problems)
      std::cerr << (problem.fatal ? "error: " : "note: ") << to_string(problem) << "\n";
  } catch (const std::exception& error) {
    std::cerr << "error: " << error.what() << "\n";
  }
  return 1;
}
