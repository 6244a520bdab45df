// SPDX-License-Identifier: Apache-2.0
#include "stream_server.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <fcntl.h>
#include <netinet/in.h>
#include <stdexcept>
#include <sys/socket.h>
#include <unistd.h>
#include <vector>

#include "base/clock.h"
#include "wire/json.h"

namespace wellspring::test {

ServerProcess::ServerProcess(const BenchOptions& options, const std::string& exhibit) {
  const std::vector<std::string>& more = options.server_words;
  const bool is_given =
      std::ranges::any_of(more, [](const auto& word) { return word.starts_with("--cache="); });
  if (!is_given) cache_.emplace();
  std::string program = options.programs + "/wellspring_server";
  std::vector<std::string> words = {program,     "--port",        "0",     "--exhibit", exhibit,
                                    "--content", options.content, "--web", options.web};
  if (cache_) words.insert(words.end(), {"--cache", cache_->path()});
  words.insert(words.end(), more.begin(), more.end());
  const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
  started = seconds_now();
  process_.emplace(ChildSettings{
      .words = std::move(words), .writes = 1, .files = {{nowhere, 2}}, .patience = 600});
  close(nowhere);
  std::string text;
  char part[256];
  while (text.find('\n') == std::string::npos) {
    ssize_t n = read(process_->from(), part, sizeof part);
    if (n <= 0) break;
    text.append(part, size_t(n));
  }
  size_t colon = text.rfind(':');
  if (colon == std::string::npos) throw std::runtime_error(program + ": did not print its address");
  port = uint16_t(std::stoi(text.substr(colon + 1)));
}

double ServerProcess::resident() const {
  std::FILE* file = std::fopen(("/proc/" + std::to_string(process_->id()) + "/statm").c_str(), "r");
  double total = 0, pages = 0;
  if (file) {
    if (std::fscanf(file, "%lf %lf", &total, &pages) != 2) pages = 0;
    std::fclose(file);
  }
  return pages * double(sysconf(_SC_PAGESIZE));
}

double ServerProcess::core_seconds() const {
  std::ifstream file("/proc/" + std::to_string(process_->id()) + "/stat");
  std::string word;
  double user = 0, system = 0;
  for (int i = 0; i < 13; i++) file >> word;  // its name has no spaces
  file >> user >> system;
  return (user + system) / double(sysconf(_SC_CLK_TCK));
}

std::string fetch(uint16_t port, const std::string& path) {
  int connection = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const std::string question =
      "GET " + path + " HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n";
  std::string text;
  if (connect(connection, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 &&
      write(connection, question.data(), question.size()) == ssize_t(question.size())) {
    char part[4096];
    for (ssize_t n; (n = read(connection, part, sizeof part)) > 0;) text.append(part, size_t(n));
  }
  close(connection);
  size_t head = text.find("\r\n\r\n");
  return head == std::string::npos ? "" : text.substr(head + 4);
}

void join_visit(WsClient& client, uint16_t port, int width, int height,
                const std::string& display) {
  WsTarget target;
  target.port = port;
  client.connect(target);
  Hello hello;
  hello.role = "visitor";
  hello.lang = "en";
  hello.width = width, hello.height = height;
  hello.parts = true;
  hello.display = display;
  client.send_text(write_message(hello));
}

double read_metric(uint16_t port, const std::string& name) {
  std::string text = "\n" + fetch(port, "/metrics");
  size_t at = text.find("\nwellspring_" + name + " ");
  return at == std::string::npos ? std::nan("") : std::atof(&text[at + name.size() + 13]);
}

}  // namespace wellspring::test
