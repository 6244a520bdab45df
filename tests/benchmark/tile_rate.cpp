// SPDX-License-Identifier: Apache-2.0
#include "tile_rate.h"

#include <algorithm>
#include <cstdlib>
#include <fcntl.h>
#include <fstream>
#include <mutex>
#include <netinet/in.h>
#include <random>
#include <stdexcept>
#include <sys/socket.h>
#include <thread>
#include <unistd.h>

#include "base/clock.h"

namespace wellspring::test {
namespace {

// A connection that stays open from question to question.
class TileLine {
 public:
  explicit TileLine(uint16_t port) : port_(port) {}
  ~TileLine() { drop(); }
  TileLine(const TileLine&) = delete;
  TileLine& operator=(const TileLine&) = delete;

  // Returns whether the answer is a picture. Throws std::runtime_error if nobody listens.
  bool ask(const std::string& path) {
    const std::string question = "GET " + path + " HTTP/1.1\r\nHost: localhost\r\n\r\n";
    // The server may have ended a connection that rested.
    for (int i = 0; i < 2; i++) {
      if (socket_ < 0) open();
      if (send(socket_, question.data(), question.size(), MSG_NOSIGNAL) ==
              ssize_t(question.size()) &&
          receive())
        return answer_.starts_with("HTTP/1.1 200");
      drop();
    }
    return false;
  }

 private:
  void open() {
    socket_ = socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port_);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) return;
    drop();
    throw std::runtime_error("nobody listens on port " + std::to_string(port_));
  }
  void drop() {
    if (socket_ >= 0) close(socket_);
    socket_ = -1;
  }
  // Receives an answer whose length is told.
  bool receive() {
    answer_.clear();
    size_t wanted = std::string::npos;
    char part[1 << 16];
    while (answer_.size() < wanted) {
      const ssize_t n = read(socket_, part, sizeof part);
      if (n <= 0) return false;
      answer_.append(part, size_t(n));
      const size_t head = answer_.find("\r\n\r\n");
      if (wanted != std::string::npos || head == std::string::npos) continue;
      std::string fields = answer_.substr(0, head);
      std::ranges::transform(fields, fields.begin(), [](char c) { return char(std::tolower(c)); });
      const std::string length = "\r\ncontent-length:";
      const size_t at = fields.find(length);
      if (at == std::string::npos) return false;
      wanted = head + 4 + size_t(std::atol(&fields[at + length.size()]));
    }
    return true;
  }

  const uint16_t port_;
  int socket_ = -1;
  std::string answer_;
};

// Names a whole tile of one of the five finest levels, of each as often.
std::string random_tile(std::mt19937& random) {
  constexpr int levels = 5, tile = LargePictureRoom::tile;
  const int scale = 1 << random() % levels, side = tile * scale;
  const int column = int(random() % uint32_t(LargePictureRoom::width / side));
  const int row = int(random() % uint32_t(LargePictureRoom::height / side));
  return "/" + std::to_string(column * side) + "," + std::to_string(row * side) + "," +
         std::to_string(side) + "," + std::to_string(side) + "/" + std::to_string(tile) + "," +
         std::to_string(tile) + "/0/default.jpg";
}

// Returns a port that is free by now.
uint16_t free_port() {
  const int listener = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  auto* any = reinterpret_cast<sockaddr*>(&address);
  const bool found = bind(listener, any, size) == 0 && getsockname(listener, any, &size) == 0;
  close(listener);
  return found ? ntohs(address.sin_port) : 0;
}

}  // namespace

TileRate ask_for_tiles(uint16_t port, const std::string& picture, int connections, double seconds) {
  TileRate rate;
  std::string problem;
  std::mutex mutex;
  const double until = seconds_now() + seconds;
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < connections; i++)
      threads.emplace_back([&, i] {
        std::mt19937 random(uint32_t(i) + 1);
        std::vector<double> times;
        size_t refused = 0;
        try {
          TileLine line(port);
          for (double began; (began = seconds_now()) < until;) {
            if (line.ask(picture + random_tile(random)))
              times.push_back(1000 * (seconds_now() - began));
            else refused++;
          }
        } catch (const std::exception& error) {
          const std::lock_guard lock(mutex);
          problem = error.what();
        }
        const std::lock_guard lock(mutex);
        rate.times.insert(rate.times.end(), times.begin(), times.end());
        rate.refused += refused;
      });
  }
  if (!problem.empty()) throw std::runtime_error(problem);
  rate.tiles_a_second = double(rate.times.size()) / seconds;
  return rate;
}

IipServer::IipServer(const std::string& folder) {
  const std::string program = "/usr/lib/iipimage-server/iipsrv.fcgi";
  const std::string front = "/usr/sbin/lighttpd";
  if (access(program.c_str(), X_OK) != 0 || access(front.c_str(), X_OK) != 0) return;
  const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
  const std::vector<std::pair<int, int>> silent = {{nowhere, 1}, {nowhere, 2}};
  std::string hosts;
  try {
    for (unsigned i = 0; i < std::max(1u, std::thread::hardware_concurrency()); i++) {
      const std::string path = own_.path() + "/" + std::to_string(i);
      const std::vector<std::string> words = {"env",
                                              "FILESYSTEM_PREFIX=" + folder,
                                              "LOGFILE=/dev/null",
                                              "VERBOSITY=0",
                                              program,
                                              "--bind",
                                              path};
      workers_.push_back(std::make_unique<Child>(ChildSettings{.words = words, .files = silent}));
      hosts += "  (\"socket\" => \"" + path + "\", \"check-local\" => \"disable\"),\n";
    }
    const uint16_t port = free_port();
    const std::string settings = own_.path() + "/lighttpd.conf";
    std::ofstream(settings) << "server.modules = (\"mod_fastcgi\")\n"
                            << "server.document-root = \"" << own_.path() << "\"\n"
                            << "server.bind = \"127.0.0.1\"\n"
                            << "server.port = " << port << "\n"
                            << "server.max-keep-alive-requests = 1000000\n"
                            << "fastcgi.server = (\"/iip\" => (\n"
                            << hosts << "))\n";
    front_.emplace(ChildSettings{.words = {front, "-D", "-f", settings}, .files = silent});
    // They are ready when they answer.
    for (int i = 0; i < 50 && port_ == 0; i++) {
      if (front_->wait(0.1)) break;
      try {
        TileLine(port).ask("/");
        port_ = port;
      } catch (const std::runtime_error&) {
        continue;
      }
    }
  } catch (const std::runtime_error&) {
    port_ = 0;  // a program cannot be started
  }
  close(nowhere);
}

}  // namespace wellspring::test
