// SPDX-License-Identifier: Apache-2.0
// wellspring run: flags -> load -> threads. The only place that knows both `show` and `stream`.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <iostream>
#include <fmt/core.h>

#include "base/clock.h"
#include "base/load_error.h"
#include "base/log.h"
#include "show/answer/answer.h"
#include "show/storyteller/recordings.h"
#include "show/answer/pages.h"
#include "show/exhibit/exhibit_load.h"
#include "show/state/show.h"
#include "show/answer/still.h"
#include "show/state/make_show.h"
#include "show/tick.h"
#include "show/storyteller/sounding.h"
#include "stream/stream.h"

namespace {

using namespace wellspring;

volatile std::sig_atomic_t asked_to_stop = 0;

struct Options {
  std::string content = "content", web = "web", exhibit = "castle";
  StreamSettings stream;
  ShowSettings show;
  RecordingOptions recordings;
};

int read_options(Options& options, int argc, char** argv) {
  CLI::App app{"Serves a museum exhibit to browsers and kiosks."};
  int port = 8080;
  std::string display = display_names[0];
  app.add_option("--exhibit", options.exhibit, "the exhibit's id: a folder below content")
      ->capture_default_str();
  app.add_option("--port", port, "0: any free one")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  app.add_option("--host", options.stream.host, "address to listen on")->capture_default_str();
  app.add_option("--allow-origin", options.stream.allowed_origin,
                 "a further Origin whose pages may open a visit; * for any");
  app.add_option("--content", options.content, "folder of exhibit packages")->capture_default_str();
  app.add_option("--web", options.web, "folder of the pages")->capture_default_str();
  app.add_option("--weights", options.show.weights,
                 "folder of the networks' weights; without it pictures at rest are not denoised")
      ->envname("WELLSPRING_WEIGHTS");
  app.add_option(
      "--cache", options.recordings.cache,
      "folder that keeps light, speech and words of recordings; empty: none of it is kept");
  app.add_option("--fps", options.show.fps, "pictures a second for each visitor")
      ->check(CLI::Range(1.0, 120.0))
      ->capture_default_str();
  app.add_option("--max-visitors", options.show.max_visitors)
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--technique", options.show.technique, "how light is sampled in motion")
      ->capture_default_str();
  app.add_option("--still-technique", options.show.still_technique, "how light is sampled at rest")
      ->capture_default_str();
  app.add_flag("--background,!--no-background", options.show.background,
               "pictures are drawn while visitors are shown earlier ones as they look from where "
               "they are now")
      ->capture_default_str();
  app.add_option("--display", display, "how diffuse light is shown: automatic, points or maps")
      ->check(CLI::IsMember(
          std::vector<std::string>(std::begin(display_names), std::end(display_names))))
      ->capture_default_str();
  app.add_flag("--bake,!--no-bake", options.show.bakes,
               "illumination maps are baked while nobody needs the cores");
  app.add_flag("--late-samples,!--no-late-samples", options.show.late_samples,
               "samples of a walking visitor are traced when its picture is on its way, and show "
               "in the next")
      ->capture_default_str();
  app.add_option("--max-depth", options.show.transport.max_depth)
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  options.show.display =
      Display(std::find(std::begin(display_names), std::end(display_names), display) -
              std::begin(display_names));
  for (const std::string& name : {options.show.technique, options.show.still_technique}) {
    if (find_technique(name)) continue;
    std::cerr << "--technique: there is no '" << name << "'; there are:";
    for (const Technique& technique : techniques()) std::cerr << " " << technique.name;
    std::cerr << "\n";
    return 2;
  }
  options.stream.port = uint16_t(port);
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

void read_recordings_or_fail(Exhibit& exhibit, const RecordingOptions& options) {
  std::vector<Problem> problems;
  read_recordings(exhibit, options, problems);
  if (std::any_of(problems.begin(), problems.end(),
                  [](const Problem& problem) { return problem.fatal; }))
    throw ExhibitError(std::move(problems));
  for (const Problem& problem : problems) log::warn("{}", to_string(problem));
}

int serve(const Options& options) {
  std::string folder = options.content + "/" + options.exhibit;
  auto pages = load_pages(options.web);
  Exhibit exhibit = load_exhibit(folder);
  read_recordings_or_fail(exhibit, options.recordings);
  ShowSettings settings = options.show;
  settings.cache = options.recordings.cache;
  auto show = make_show(std::move(exhibit), settings);
  SpeakerOptions speaker;
  if (!options.recordings.cache.empty()) speaker.folder = options.recordings.cache + "/speech";
  show->speech = make_speech_source(std::make_shared<Speaker>(speaker));
  show->speech.prepare(lines_of(show->exhibit));
  StillRoom stills(*show);
  ReportBoard board;
  Arrivals arrivals;
  std::unique_ptr<Server> server;

  AnswerSources sources;
  sources.exhibit = &show->exhibit;
  sources.pages = &pages;
  sources.board = &board;
  sources.make_still = [&](const StillJob& order) { return stills.make(order); };
  sources.stream_metrics = [&] { return server ? stream_metrics(*server) : std::string(); };
  Doors doors;
  doors.answer = [&](const HttpQuestion& question) { return answer(sources, question); };
  doors.slow = [](const HttpQuestion& question) { return question.path.ends_with("/still.jpg"); };
  doors.joined = [&](std::shared_ptr<Link> link) { arrivals.put(std::move(link)); };
  board.publish(make_report(*show));
  server = std::make_unique<Server>(options.stream, doors);
  std::cout << "Wellspring serves '" << options.exhibit << "' at http://" << options.stream.host
            << ":" << server->port() << "/" << std::endl;

  double reported = -1;
  while (!asked_to_stop) {
    double began = seconds_now();
    tick(*show, arrivals, began);
    if (began - reported > 0.25) {
      reported = began;
      board.publish(make_report(*show));
    }
    wait_for_tick(*show, seconds_now());
  }
  log::info("stopping");
  server->stop();
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
