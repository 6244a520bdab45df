// SPDX-License-Identifier: Apache-2.0
// The kiosk's program as a whole: how long an observation takes to leave it, and its memory.
#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <unistd.h>

#include "base/child.h"
#include "main_compare.h"
#include "wire/json.h"

namespace wellspring::test {
namespace {

namespace beast = boost::beast;
using tcp = boost::asio::ip::tcp;

constexpr double rate = 30;

// Returns the time as the live synthetic camera has it (kiosk/camera.h).
double clock_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::vector<std::string> words_of(const CompareOptions& options, std::vector<std::string> words) {
  words.insert(words.begin(), options.kiosk);
  if (!options.weights.empty()) words.insert(words.end(), {"--weights", options.weights});
  return words;
}

struct Program {
  Child process;
  FILE* lines = nullptr;
  Program(const CompareOptions& options, std::vector<std::string> words)
      : process({.words = words_of(options, std::move(words)), .writes = 1, .patience = 60}),
        lines(fdopen(dup(process.from()), "r")) {}
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;
  ~Program() { std::fclose(lines); }
  // The process that sees pictures.
  pid_t eye() const {
    const std::string id = std::to_string(process.id());
    for (const auto& task : std::filesystem::directory_iterator("/proc/" + id + "/task")) {
      std::ifstream file(task.path() / "children");
      if (pid_t child = 0; file >> child) return child;
    }
    throw std::runtime_error("the kiosk's program has no eye");
  }
};

double resident_mib(pid_t process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/statm");
  double size = 0, resident = 0;
  if (!(file >> size >> resident)) throw std::runtime_error("the eye's memory cannot be read");
  return resident * double(sysconf(_SC_PAGESIZE)) / (1 << 20);
}

std::optional<Observation> read(const std::string& text) {
  auto seen = read_observation(text);
  if (auto* observation = std::get_if<Observation>(&seen)) return std::move(*observation);
  return {};
}

}  // namespace

void measure_way(const CompareOptions& options) {
  boost::asio::io_context io;
  tcp::acceptor door(io, {boost::asio::ip::address_v4::loopback(), 0});
  Program program(options,
                  {"--camera", "synthetic-live", "--rate", std::to_string(rate), "--server",
                   "ws://127.0.0.1:" + std::to_string(door.local_endpoint().port())});
  beast::websocket::stream<tcp::socket> socket(door.accept());
  socket.next_layer().set_option(tcp::no_delay(true));
  socket.accept();
  std::vector<double> empty, person;  // frame times
  const double began = clock_now(), least = options.quick ? 12 : 60;
  double first = -1;

  while (clock_now() - began < least + 5) {
    beast::flat_buffer buffer;
    socket.read(buffer);
    const double now = clock_now();
    const auto seen = read(beast::buffers_to_string(buffer.data()));
    if (!seen || now - began < 2) continue;  // the beginning is slow
    if (first < 0) first = seen->time;

    (seen->people.empty() ? empty : person).push_back((now - seen->time) * rate);
    if (seen->time - first > least) break;
  }
  for (auto* ways : {&empty, &person}) {
    if (ways->empty()) continue;
    std::sort(ways->begin(), ways->end());
    const nlohmann::json fields{{"before it", ways == &empty ? "nobody" : "a visitor"},
                                {"observations", ways->size()}};
    tell("kiosk.way.frames_p50", (*ways)[ways->size() / 2], "frames", fields);
    tell("kiosk.way.frames_p95", (*ways)[ways->size() * 95 / 100], "frames", fields);
  }
}

void measure_memory(const CompareOptions& options) {
  const double minutes = options.quick ? 3 : 30;
  // Ten pictures a second: a simulated minute takes a few seconds.
  Program program(options,
                  {"--camera", "synthetic", "--rate", "10", "--no-pace", "--loop", "--print"});
  std::string line;
  double first = -1, last = 0, most = 0, next = 1;  // MiB, MiB, MiB, minutes
  for (int c; next <= minutes && (c = std::fgetc(program.lines)) != EOF;) {
    if (c != '\n') {
      line += char(c);
      continue;
    }
    const auto seen = read(line);
    line.clear();
    if (!seen || seen->time < 60 * next) continue;
    next++;
    last = resident_mib(program.eye());
    most = std::max(most, last);
    if (first < 0) first = last;
  }
  if (next <= minutes) throw std::runtime_error("the kiosk's program ended too soon");
  const nlohmann::json fields{{"minutes", minutes}};
  tell("kiosk.memory.first_mib", first, "MiB", fields);
  tell("kiosk.memory.last_mib", last, "MiB", fields);
  tell("kiosk.memory.most_mib", most, "MiB", fields);
  tell("kiosk.memory.growth_mib", last - first, "MiB", fields);
}

}  // namespace wellspring::test
