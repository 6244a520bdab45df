// SPDX-License-Identifier: Apache-2.0
// wellspring run: flags -> load -> threads. The only place that knows both `museum` and `stream`.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <fmt/core.h>

#include "base/log.h"
#include "museum/museum.h"
#include "show/http/pages.h"
#include "show/status/speeds.h"
#include "show/status/sums.h"
#include "stream/stream.h"

namespace {

using namespace wellspring;

volatile std::sig_atomic_t asked_to_stop = 0;

struct Options {
  std::string web = "web", admin_token, bench;
  StreamSettings stream;
  MuseumSettings museum;
};

// The token of a file, or of the environment, from which it is taken: programs that are started
// here need not know it. Throws std::runtime_error for one that is too short.
std::string read_admin_token(const std::string& file) {
  const char* variable = "WELLSPRING_ADMIN_TOKEN";
  std::string token = getenv(variable) ? getenv(variable) : "";
  unsetenv(variable);
  std::string place = variable;
  if (!file.empty()) {
    place = file;
    std::ifstream in(file);
    if (!in || !(in >> token)) throw std::runtime_error(file + ": holds no token");
  }
  if (!token.empty() && token.size() < least_token_bytes)
    throw std::runtime_error(place + ": a token has at least 16 characters");
  return token;
}

int read_options(Options& options, int argc, char** argv) {
  ShowSettings& show = options.museum.show;
  CLI::App app{"Serves a museum exhibit to browsers and kiosks."};
  int port = 8080;
  std::string token_file;
  std::string display = display_names[0];
  app.add_option("--exhibit", options.museum.exhibit,
                 "id of the only one that is served: a folder below content; without it all are");
  app.add_option("--port", port, "0: any free one")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  app.add_option("--host", options.stream.host, "address to listen on")->capture_default_str();
  app.add_option("--allow-origin", options.stream.allowed_origin,
                 "a further Origin whose pages may open a visit; * for any");
  app.add_option("--content", options.museum.content, "folder of exhibit packages")
      ->capture_default_str();
  app.add_option("--web", options.web, "folder of the pages")->capture_default_str();
  app.add_option("--house", options.museum.house,
                 "house file: opening and quiet hours, volumes, kiosks (docs/kiosk.md)");
  app.add_option("--admin-token-file", token_file,
                 "file of the token of those who may announce; without it WELLSPRING_ADMIN_TOKEN");
  app.add_option("--sums", options.museum.sums,
                 "file of daily sums for the museum's director; without it none are kept");
  app.add_option("--bench", options.bench, "report of wellspring bench that /status shows");
  app.add_flag("--watch", show.watched,
               "a changed exhibit is shown at once; its pages tell mistakes in its files");
  app.add_option("--weights", show.weights,
                 "folder of the networks' weights; without it pictures at rest are not denoised")
      ->envname("WELLSPRING_WEIGHTS");
  app.add_option(
      "--cache", options.museum.recordings.cache,
      "folder that keeps light, speech and words of recordings; empty: none of it is kept");
  app.add_option("--fps", show.fps, "pictures a second for each visitor")
      ->check(CLI::Range(1.0, 120.0))
      ->capture_default_str();
  app.add_option("--max-visitors", show.max_visitors)
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--technique", show.technique, "how light is sampled in motion")
      ->capture_default_str();
  app.add_option("--still-technique", show.still_technique, "how light is sampled at rest")
      ->capture_default_str();
  app.add_flag("--background,!--no-background", show.background,
               "pictures are drawn while visitors are shown earlier ones as they look from where "
               "they are now")
      ->capture_default_str();
  app.add_option("--display", display, "how light is shown: automatic, points, maps or corrected")
      ->check(CLI::IsMember(
          std::vector<std::string>(std::begin(display_names), std::end(display_names))))
      ->capture_default_str();
  app.add_flag("--bake,!--no-bake", show.bakes,
               "illumination maps are baked while nobody needs the cores");
  app.add_flag("--late-samples,!--no-late-samples", show.late_samples,
               "samples of a walking visitor are traced when its picture is on its way, and show "
               "in the next")
      ->capture_default_str();
  app.add_option("--max-depth", show.transport.max_depth)
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  show.display = Display(std::find(std::begin(display_names), std::end(display_names), display) -
                         std::begin(display_names));
  for (const std::string& name : {show.technique, show.still_technique}) {
    if (find_technique(name)) continue;
    std::cerr << "--technique: there is no '" << name << "'; there are:";
    for (const Technique& technique : techniques()) std::cerr << " " << technique.name;
    std::cerr << "\n";
    return 2;
  }
  options.stream.port = uint16_t(port);
  try {
    options.admin_token = read_admin_token(token_file);
  } catch (const std::exception& error) {
    std::cerr << "error: " << error.what() << "\n";
    return 1;
  }
  return -1;
}

std::string stream_metrics(const Server& server) {
  StreamCounters counters = server.counters();
  auto line = [](const char* name, const char* type, uint64_t value) {
    return fmt::format("# TYPE wellspring_{0} {1}\nwellspring_{0} {2}\n", name, type, value);
  };
  return line("connections_accepted_total", "counter", counters.accepted) +
         line("connections_refused_total", "counter", counters.refused) +
         line("connections", "gauge", counters.open) +
         line("http_requests_total", "counter", counters.http_requests) +
         line("websockets_total", "counter", counters.websockets) +
         line("slow_readers_closed_total", "counter", counters.slow_closed);
}

// Listening to nobody but this machine.
bool is_own_address(const std::string& host) {
  return host.starts_with("127.") || host == "::1" || host == "localhost";
}

// Who may read the daily sums, and where.
SumsDesk open_sums(const Options& options, const Museum& museum) {
  SumsDesk desk;
  desk.token = options.admin_token;
  desk.open = is_own_address(options.stream.host);
  if (!options.museum.sums.empty())
    desk.read = [&museum](int64_t from, int64_t to) { return museum.read_sums(from, to); };
  return desk;
}

void say_address(const AnswerSources& sources, const std::string& host, uint16_t port) {
  std::string names;
  for (const ServedExhibit& one : sources.exhibits)
    names += (names.empty() ? "'" : ", '") + one.exhibit->id + "'";
  std::cout << "Wellspring serves " << names << " at http://" << host << ":" << port << "/"
            << std::endl;
}

int serve(const Options& options) {
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
  sources.stream_metrics = [&] { return server ? stream_metrics(*server) : std::string(); };
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
    say_address(sources, stream.host, stream.port);
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
  Options options;
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
