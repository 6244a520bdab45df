// SPDX-License-Identifier: Apache-2.0
#include "options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>

#include "about/version.h"
#include "base/host.h"
#include "base/log.h"
#include "config/config_file.h"
#include "light/technique/technique.h"
#include "store/piece_store.h"
#include "workers/program_number.h"

namespace wellspring::program {
namespace {

// Holds values that are no settings yet when they are read.
struct Words {
  int port = 8080, agent_port = 0;
  double visitors_memory = 0, pieces_memory = 256;  // MiB
  std::string token_file, kiosk_token_file, workers_key_file, nats_token_file,
      display = display_names[0];
};

std::vector<std::string> technique_names() {
  std::vector<std::string> names;
  for (const Technique& technique : techniques()) names.emplace_back(technique.name);
  return names;
}

// Declares every option of the server; each is a key of the configuration file, too.
void declare_options(CLI::App& app, ServerOptions& options, Words& words) {
  ShowSettings& show = options.museum.show;
  app.option_defaults()->always_capture_default();
  app.add_option("--exhibit", options.museum.exhibit,
                 "id of the only one that is served: a folder below content; without it all are");
  app.add_option("--port", words.port, "0: any free one")->check(CLI::Range(0, 65535));
  app.add_option("--host", options.stream.host, "address to listen on");
  app.add_option(
         "--agent-port", words.agent_port,
         "tells HAProxy's agent-check how many visitors this machine serves, as a weight in "
         "percent (docs/nodes.md); 0: none")
      ->check(CLI::Range(0, 65535));
  app.add_option("--allow-origin", options.stream.allowed_origins,
                 "a further Origin whose pages may open a visit; * for any; several may be named");
  app.add_option("--allow-host", options.stream.allowed_hosts,
                 "a further name under which this server may be asked; several may be named");
  app.add_option("--trusted", options.stream.trusted,
                 "address or network without limits by address, as loopback is; several");
  app.add_option("--trusted-proxy", options.stream.proxies,
                 "reverse proxy whose X-Forwarded-For is believed; several may be named");
  app.add_option("--max-connections", options.stream.limits.connections, "of all kinds together")
      ->check(CLI::Range(16, 100000));
  app.add_option("--tls-cert", options.stream.certificate,
                 "certificate in PEM, with those that sign it; read anew when it changes and at "
                 "SIGHUP");
  app.add_option("--tls-key", options.stream.key, "its key in PEM");
  app.add_option("--content", options.museum.content, "folder of exhibit packages");
  app.add_option("--web", options.web,
                 "folder of the pages; without it web, or what was installed");
  app.add_option("--house", options.museum.house,
                 "house file: opening and quiet hours, volumes, kiosks (docs/kiosk.md)");
  app.add_option(
      "--admin-token-file", words.token_file,
      "file of the token of who may announce, and read how the server is from elsewhere; "
      "without it WELLSPRING_ADMIN_TOKEN");
  app.add_option("--kiosk-token-file", words.kiosk_token_file,
                 "file of tokens of kiosks on other machines: TOKEN, or NAME TOKEN, a line each; "
                 "without it WELLSPRING_KIOSK_TOKEN (docs/kiosk.md)");
  add_switch(app, "--open-status", options.access.open_status,
             "everybody may read /status, /metrics and the daily sums");
  app.add_option("--sums", options.museum.sums,
                 "file of daily sums for the museum's director; without it none are kept");
  app.add_option("--bench", options.bench, "report of wellspring bench that /status shows");
  add_switch(app, "--watch", show.watched,
             "a changed exhibit is shown at once; its pages tell mistakes in its files");
  app.add_option(
         "--weights", show.weights,
         "folder of the networks' weights; without it those that were installed, and without "
         "any pictures at rest are not denoised")
      ->envname("WELLSPRING_WEIGHTS");
  app.add_option(
      "--cache", options.museum.recordings.cache,
      "folder that keeps light, speech and words of recordings; empty: none of it is kept");
  app.add_option("--seal-key", options.museum.seal_key,
                 "file of the key that seals visits, made where there is none; servers that share "
                 "it take over one another's visits; without it one in the folder of --cache");
  app.add_option("--still-seconds", options.museum.stills.most_seconds,
                 "seconds of this machine that one picture over HTTP may take")
      ->check(CLI::Range(0.1, 3600.0));
  app.add_option("--drain", options.drain,
                 "seconds to go on serving after SIGTERM, while /healthz says 503, draining")
      ->check(CLI::Range(0, 3600));
  app.add_option("--fps", show.fps, "pictures a second for each visitor")
      ->check(CLI::Range(1.0, 120.0));
  CapacitySettings& capacity = options.museum.capacity;
  app.add_option("--max-visitors", capacity.most,
                 "visitors who are shown pictures at once, in all exhibits together, however many "
                 "the machine could serve")
      ->check(CLI::Range(1, 1000));
  app.add_option(
         "--least-fps", capacity.rate,
         "pictures a second that everybody is to have who walks: while the machine makes no "
         "more, newcomers wait")
      ->check(CLI::Range(0.01, 120.0));
  app.add_option(
         "--visitors-memory", words.visitors_memory,
         "MiB that pictures of all visitors may take: while newcomers need more, they wait; "
         "0: six tenths of what the process may use")
      ->check(CLI::Range(0.0, 1e6));
  app.add_option("--pieces-memory", words.pieces_memory,
                 "MiB that pieces of very large pictures may take, of all exhibits together")
      ->check(CLI::Range(16.0, 1e6));
  app.add_option("--max-waiting", options.museum.most_waiting,
                 "visitors who wait; more are told to come back")
      ->check(CLI::Range(0, 100000));
  app.add_option("--idle-after", show.idle_after,
                 "seconds until a visitor who does nothing is asked; 0: never")
      ->check(CLI::Range(0.0, 86400.0));
  app.add_option("--idle-answer", show.idle_answer, "seconds to answer in until the visit rests")
      ->check(CLI::Range(1.0, 3600.0));
  app.add_option("--hidden-after", show.hidden_after,
                 "seconds until a visit rests whose page is hidden; 0: never")
      ->check(CLI::Range(0.0, 86400.0));
  app.add_option("--technique", show.technique, "how light is sampled in motion")
      ->check(CLI::IsMember(technique_names()));
  app.add_option("--still-technique", show.still_technique, "how light is sampled at rest")
      ->check(CLI::IsMember(technique_names()));
  app.add_option("--display", words.display, "how light is shown: automatic, points or maps")
      ->check(CLI::IsMember(
          std::vector<std::string>(std::begin(display_names), std::end(display_names))));
  add_switch(app, "--bake,!--no-bake", show.bakes,
             "illumination maps are baked while nobody needs the cores");
  add_switch(app, "--late-samples,!--no-late-samples", show.late_samples,
             "samples of a walking visitor are traced when its picture is on its way, and show "
             "in the next");
  ChannelSettings& nats = show.workers.channel;
  app.add_option("--workers", nats.url,
                 "address of the NATS server that workers listen to, e.g. nats://10.0.0.5:4222 "
                 "(docs/workers.md); empty: there are none");
  app.add_option("--workers-key", words.workers_key_file,
                 "file of the secret that seals messages to workers and back; without it "
                 "WELLSPRING_WORKERS_KEY");
  add_switch(app, "--workers-exact", show.workers.exact,
             "workers whose processors have other instructions are not asked: their samples are of "
             "the same light, but not the same bits");
  add_switch(
      app, "--verify-workers", show.workers.verifies,
      "traces here, too, what workers trace, and counts samples that differ: to find faults, "
      "since it takes more time than it saves");
  app.add_option("--nats-token-file", words.nats_token_file,
                 "file of the token that NATS asks for; without it WELLSPRING_NATS_TOKEN");
  app.add_option("--nats-ca", nats.authority, "certificates in PEM that sign that of NATS");
  app.add_option("--nats-cert", nats.certificate, "certificate in PEM that is shown to NATS");
  app.add_option("--nats-key", nats.key, "its key in PEM");
  app.add_option("--log", options.log,
                 "file of the log, opened anew at SIGUSR1 and SIGHUP; empty: stderr");
  app.add_option("--log-level", options.log_level, "of the least urgent lines that are logged")
      ->envname("WELLSPRING_LOG")
      ->check(CLI::IsMember(log::levels()));
  app.add_option("--max-depth", show.transport.max_depth,
                 "of light's walks, in reflections; what glass does is none")
      ->check(CLI::Range(1, 64));
}

// Reads the command line and the file. Throws CLI::ParseError, ConfigError or std::runtime_error.
void parse_options(CLI::App& app, ServerOptions& options, Words& words, int argc, char** argv) {
  declare_options(app, options, words);
  add_config(app, installed_config("server.conf"));
  parse_with_config(app, argc, argv);
  const auto display = std::find(std::begin(display_names), std::end(display_names), words.display);
  options.museum.show.display = Display(display - std::begin(display_names));
  options.stream.port = uint16_t(words.port);
  options.stream.agent_port = uint16_t(words.agent_port);
  options.museum.capacity.memory = words.visitors_memory * 1024 * 1024;
  set_shared_budget(size_t(words.pieces_memory * 1024 * 1024));
  if (options.web.empty()) options.web = installed_share("web");
  if (options.web.empty()) options.web = "web";
  std::string& weights = options.museum.show.weights;
  if (weights.empty()) weights = installed_share("weights");
  options.settings = config_values(app);
}

}  // namespace

int read_options(ServerOptions& options, int argc, char** argv) {
  CLI::App app{"Serves a museum exhibit to browsers and kiosks."};
  Words words;
  try {
    parse_options(app, options, words, argc, argv);
    options.access.admin_token = read_token(words.token_file, "WELLSPRING_ADMIN_TOKEN");
    options.access.kiosk_tokens = read_tokens(words.kiosk_token_file, "WELLSPRING_KIOSK_TOKEN");
    options.museum.show.kiosk_tokens = options.access.kiosk_tokens;
    CrewSettings& workers = options.museum.show.workers;
    workers.secret = read_token(words.workers_key_file, "WELLSPRING_WORKERS_KEY");
    workers.channel.token = read_token(words.nats_token_file, "WELLSPRING_NATS_TOKEN");
    workers.channel.name = "wellspring server";
    workers.version = program_number(version_number());
    log::set_level(options.log_level);
    if (!options.log.empty()) log::send_to(options.log);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const ConfigError& error) {
    for (const std::string& problem : error.problems) std::cerr << "error: " << problem << "\n";
    return 1;
  } catch (const std::exception& error) {
    std::cerr << "error: " << error.what() << "\n";
    return 1;
  }
  return -1;
}

void reread_options(ServerOptions& options, int argc, char** argv) {
  CLI::App app;
  Words words;
  ServerOptions now;
  try {
    parse_options(app, now, words, argc, argv);
  } catch (const ConfigError& error) {
    for (const std::string& problem : error.problems) log::error("{}", problem);
    return;
  } catch (const std::exception& error) {
    log::error("{}", error.what());
    return;
  }
  log::set_level(options.log_level = now.log_level);
  std::string changed;
  for (const auto& [key, value] : now.settings)
    if (key != "log-level" && options.settings[key] != value)
      changed += (changed.empty() ? "" : ", ") + key;
  if (!changed.empty()) log::warn("needs a restart to count: {}", changed);
}

}  // namespace wellspring::program
