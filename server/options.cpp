// SPDX-License-Identifier: Apache-2.0
#include "options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iostream>

#include "base/installed.h"
#include "config/config_file.h"

namespace wellspring {
namespace {

// What is no setting yet when it is read.
struct Words {
  int port = 8080;
  std::string token_file, display = display_names[0];
};

std::vector<std::string> technique_names() {
  std::vector<std::string> names;
  for (const Technique& technique : techniques()) names.emplace_back(technique.name);
  return names;
}

// Every option of the server; each is a key of the configuration file, too.
void declare_options(CLI::App& app, ServerOptions& options, Words& words) {
  ShowSettings& show = options.museum.show;
  app.option_defaults()->always_capture_default();
  app.add_option("--exhibit", options.museum.exhibit,
                 "id of the only one that is served: a folder below content; without it all are");
  app.add_option("--port", words.port, "0: any free one")->check(CLI::Range(0, 65535));
  app.add_option("--host", options.stream.host, "address to listen on");
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
                 "certificate in PEM, with those that sign it; read anew when it changes");
  app.add_option("--tls-key", options.stream.key, "its key in PEM");
  app.add_option("--content", options.museum.content, "folder of exhibit packages");
  app.add_option("--web", options.web, "folder of the pages");
  app.add_option("--house", options.museum.house,
                 "house file: opening and quiet hours, volumes, kiosks (docs/kiosk.md)");
  app.add_option("--admin-token-file", words.token_file,
                 "file of the token of those who may announce; without it WELLSPRING_ADMIN_TOKEN");
  app.add_option("--sums", options.museum.sums,
                 "file of daily sums for the museum's director; without it none are kept");
  app.add_option("--bench", options.bench, "report of wellspring bench that /status shows");
  add_switch(app, "--watch", show.watched,
             "a changed exhibit is shown at once; its pages tell mistakes in its files");
  app.add_option("--weights", show.weights,
                 "folder of the networks' weights; without it pictures at rest are not denoised")
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
  app.add_option("--max-visitors", show.max_visitors, "in all exhibits together")
      ->check(CLI::Range(1, 1000));
  app.add_option("--technique", show.technique, "how light is sampled in motion")
      ->check(CLI::IsMember(technique_names()));
  app.add_option("--still-technique", show.still_technique, "how light is sampled at rest")
      ->check(CLI::IsMember(technique_names()));
  add_switch(app, "--background,!--no-background", show.background,
             "pictures are drawn while visitors are shown earlier ones as they look from where "
             "they are now");
  app.add_option("--display", words.display,
                 "how light is shown: automatic, points, maps or corrected")
      ->check(CLI::IsMember(
          std::vector<std::string>(std::begin(display_names), std::end(display_names))));
  add_switch(app, "--bake,!--no-bake", show.bakes,
             "illumination maps are baked while nobody needs the cores");
  add_switch(app, "--late-samples,!--no-late-samples", show.late_samples,
             "samples of a walking visitor are traced when its picture is on its way, and show "
             "in the next");
  app.add_option("--max-depth", show.transport.max_depth, "of light's walks, in reflections")
      ->check(CLI::Range(1, 64));
}

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

}  // namespace

int read_options(ServerOptions& options, int argc, char** argv) {
  CLI::App app{"Serves a museum exhibit to browsers and kiosks."};
  Words words;
  declare_options(app, options, words);
  add_config(app, installed_config("server.conf"));
  try {
    parse_with_config(app, argc, argv);
    const auto display =
        std::find(std::begin(display_names), std::end(display_names), words.display);
    options.museum.show.display = Display(display - std::begin(display_names));
    options.stream.port = uint16_t(words.port);
    options.admin_token = read_admin_token(words.token_file);
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

}  // namespace wellspring
