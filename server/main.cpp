// SPDX-License-Identifier: Apache-2.0
// wellspring run: options -> load -> threads. The only place that knows both `museum` and `stream`.
#include <unistd.h>

#include <csignal>
#include <iostream>

#include "base/clock.h"
#include "base/log.h"
#include "museum/front.h"
#include "museum/museum.h"
#include "options.h"
#include "show/http/pages.h"
#include "show/status/speeds.h"
#include "show/status/sums.h"
#include "stream/stream.h"

namespace {

using namespace wellspring;

// Until it is serving there is nothing to be written before the end; sums are all that may be lost.
enum Phase : int { loading, serving, written };
volatile std::sig_atomic_t asked_to_stop = 0, phase = loading, seconds_to_drain = 0;
constexpr unsigned seconds_to_end = 4;

// The first time it ends in order, the second time at once.
void stop(int signal) {
  if (asked_to_stop != 0) _exit(128 + signal);
  asked_to_stop = 1;
  if (phase == loading) _exit(0);
  alarm(unsigned(seconds_to_drain) + seconds_to_end);
}

void end_late(int) {
  constexpr char words[] = "not all work could be ended in time; it is left\n";
  if (write(STDERR_FILENO, words, sizeof(words) - 1) < 0) _exit(1);
  _exit(phase == written ? 0 : 1);
}

// Listening to nobody but this machine.
bool is_own_address(const std::string& host) {
  return host.starts_with("127.") || host == "::1" || host == "localhost";
}

// Who may read the daily sums, and where.
SumsDesk open_sums(const ServerOptions& options, const Museum& museum) {
  SumsDesk desk;
  desk.token = options.admin_token;
  desk.open = is_own_address(options.stream.host);
  if (!options.museum.sums.empty())
    desk.read = [&museum](int64_t from, int64_t to) { return museum.read_sums(from, to); };
  return desk;
}

void say_address(const AnswerSources& sources, const StreamSettings& stream) {
  std::string names;
  for (const ServedExhibit& one : sources.exhibits)
    names += (names.empty() ? "'" : ", '") + one.exhibit->id + "'";
  std::cout << "Wellspring serves " << names << " at "
            << (stream.certificate.empty() ? "http://" : "https://") << stream.host << ":"
            << stream.port << "/" << std::endl;
}

int serve(const ServerOptions& options) {
  const auto pages = load_pages(options.web);
  Front front(pages);
  Doors doors;
  doors.answer = [&](const HttpQuestion& question) { return front.answer(question); };
  doors.answer_later = [&](const HttpQuestion& question, const std::shared_ptr<HttpAsker>& asker) {
    return front.answer_later(question, asker);
  };
  doors.slow = [](const HttpQuestion& question) { return question.path.ends_with("/sums.csv"); };
  doors.joined = [&](std::shared_ptr<Link> link) { front.join(std::move(link)); };
  StreamSettings stream = options.stream;
  auto server = std::make_unique<Server>(stream, doors);
  stream.port = server->port();  // the same, when it comes back
  Museum museum(options.museum);
  const SumsDesk sums = open_sums(options, museum);
  AnswerSources& sources = museum.sources();
  sources.pages = &pages;
  sources.desk.token = options.admin_token;
  sources.sums = [&](const HttpQuestion& question) { return answer_sums(sums, question); };
  sources.status = [&] { return museum.status(sums_access(sums)); };
  sources.speeds = [&] { return read_speeds(options.bench); };
  sources.drains = [] { return asked_to_stop != 0; };
  sources.stream_metrics = [&] { return server ? to_metrics(server->counters()) : std::string(); };
  double ends_at = 0;  // when it is drained
  const auto ended = [&] {
    if (asked_to_stop == 0) return false;
    if (ends_at == 0) ends_at = seconds_now() + options.drain;
    return seconds_now() >= ends_at;
  };
  phase = serving;
  front.open(museum);
  for (bool changed = true; changed;) {
    if (!server) server = std::make_unique<Server>(stream, doors);
    say_address(sources, stream);
    changed = museum.run(ended);
    if (!changed) phase = written, log::info("stopping");
    museum.give_up_stills();
    server->stop();
    if (!changed) continue;
    server.reset();
    museum.take_over();
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  log::start("server");
  ServerOptions options;
  if (int status = read_options(options, argc, argv); status >= 0) return status;
  seconds_to_drain = options.drain;
  std::signal(SIGINT, stop);
  std::signal(SIGTERM, stop);
  std::signal(SIGALRM, end_late);
  std::signal(SIGPIPE, SIG_IGN);
  try {
    return serve(options);
  } catch (const ExhibitError& error) {
    for (const Problem& problem : error.problems)
      std::cerr << (problem.fatal ? "error: " : "note: ") << to_string(problem) << "\n";
  } catch (const std::exception& error) {
    std::cerr << "error: " << error.what() << "\n";
  }
  return 1;
}
