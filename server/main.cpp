// SPDX-License-Identifier: Apache-2.0
// wellspring run: options -> load -> threads. The only place that knows both `museum` and `stream`.
#include <csignal>
#include <iostream>

#include "base/log.h"
#include "museum/museum.h"
#include "options.h"
#include "show/http/pages.h"
#include "show/status/speeds.h"
#include "show/status/sums.h"
#include "stream/stream.h"

namespace {

using namespace wellspring;

volatile std::sig_atomic_t asked_to_stop = 0;

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
  try_port(options.stream);  // before what takes seconds
  auto pages = load_pages(options.web);
  Museum museum(options.museum);
  const SumsDesk sums = open_sums(options, museum);
  std::unique_ptr<Server> server;
  AnswerSources& sources = museum.sources();
  sources.pages = &pages;
  sources.desk.token = options.admin_token;
  sources.sums = [&](const HttpQuestion& question) { return answer_sums(sums, question); };
  sources.status = [&] { return museum.status(sums_access(sums)); };
  sources.speeds = [&] { return read_speeds(options.bench); };
  sources.stream_metrics = [&] {
    return museum.metrics() + (server ? to_metrics(server->counters()) : std::string());
  };
  Doors doors;
  doors.answer = [&](const HttpQuestion& question) { return answer(sources, question); };
  doors.slow = [](const HttpQuestion& question) {
    return question.path.ends_with("/still.jpg") || question.path.ends_with("/sums.csv");
  };
  doors.joined = [&](std::shared_ptr<Link> link) { museum.join(std::move(link)); };
  StreamSettings stream = options.stream;
  for (bool changed = true; changed;) {
    server = std::make_unique<Server>(stream, doors);
    stream.port = server->port();  // the same, when it comes back
    say_address(sources, stream);
    changed = museum.run([] { return asked_to_stop != 0; });
    if (!changed) log::info("stopping");
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
  std::signal(SIGINT, [](int) { asked_to_stop = 1; });
  std::signal(SIGTERM, [](int) { asked_to_stop = 1; });
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
