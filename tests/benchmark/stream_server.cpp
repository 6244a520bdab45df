// SPDX-License-Identifier: Apache-2.0
#include "stream_server.h"

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <fcntl.h>
#include <netinet/in.h>
#include <spawn.h>
#include <stdexcept>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

#include "base/clock.h"
#include "wire/json.h"

extern char** environ;

namespace wellspring::test {

ServerProcess::ServerProcess(const BenchOptions& options, const std::string& exhibit) {
  const std::vector<std::string>& more = options.server_words;
  const bool is_given =
      std::ranges::any_of(more, [](const auto& word) { return word.starts_with("--cache="); });
  if (!is_given) cache_.emplace();
  int out[2];
  if (pipe(out) != 0) throw std::runtime_error("pipe failed");
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, out[1], 1);
  posix_spawn_file_actions_addclose(&actions, out[0]);
  posix_spawn_file_actions_addopen(&actions, 2, "/dev/null", O_WRONLY, 0);
  std::string program = options.programs + "/wellspring_server";
  std::vector<std::string> words = {program,     "--port",        "0",     "--exhibit", exhibit,
                                    "--content", options.content, "--web", options.web};
  if (cache_) words.insert(words.end(), {"--cache", cache_->path()});
  words.insert(words.end(), more.begin(), more.end());
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  started = seconds_now();
  int failed = posix_spawn(&pid_, program.c_str(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(out[1]);
  if (failed) throw std::runtime_error(program + ": cannot be started; build all programs first");
  std::string text;
  char part[256];
  while (text.find('\n') == std::string::npos) {
    ssize_t n = read(out[0], part, sizeof part);
    if (n <= 0) break;
    text.append(part, size_t(n));
  }
  close(out[0]);
  size_t colon = text.rfind(':');
  if (colon == std::string::npos) throw std::runtime_error(program + ": did not print its address");
  port = uint16_t(std::stoi(text.substr(colon + 1)));
}

ServerProcess::~ServerProcess() {
  kill(pid_, SIGTERM);
  waitpid(pid_, nullptr, 0);
}

double ServerProcess::resident() const {
  std::FILE* file = std::fopen(("/proc/" + std::to_string(pid_) + "/statm").c_str(), "r");
  double total = 0, pages = 0;
  if (file) {
    if (std::fscanf(file, "%lf %lf", &total, &pages) != 2) pages = 0;
    std::fclose(file);
  }
  return pages * double(sysconf(_SC_PAGESIZE));
}

double ServerProcess::core_seconds() const {
  std::ifstream file("/proc/" + std::to_string(pid_) + "/stat");
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
