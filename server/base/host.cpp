// SPDX-License-Identifier: Apache-2.0
#include "base/host.h"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <sys/socket.h>
#include <sys/un.h>
#include <tuple>
#include <unistd.h>

namespace wellspring {
namespace {

namespace fs = std::filesystem;

fs::path prefix() {
  std::error_code ec;
  const fs::path folder = fs::read_symlink("/proc/self/exe", ec).parent_path();
  fs::path found;
  if (folder.filename() == "bin") found = folder.parent_path();
  else if (folder.filename() == "wellspring" && folder.parent_path().filename() == "libexec")
    found = folder.parent_path().parent_path();
  return fs::is_directory(found / "share" / "wellspring", ec) ? found : fs::path();
}

}  // namespace

std::string installed_share(const std::string& name) {
  const fs::path root = prefix();
  std::error_code ec;
  const fs::path place = root / "share" / "wellspring" / name;
  return !root.empty() && fs::exists(place, ec) ? place.string() : "";
}

std::string installed_config(const std::string& name) {
  const fs::path root = prefix();
  if (root.empty()) return "";
  const fs::path above = root.filename() == "usr" ? root.parent_path() : root;
  return (above / "etc" / "wellspring" / name).string();
}

namespace {

std::string take_variable(const char* name) {
  const char* value = std::getenv(name);
  std::string text = value ? value : "";
  unsetenv(name);
  return text;
}

// Connects to a path, or to a name of the abstract namespace, which begins with '@'. -1: no
// connection.
int connect_to(const std::string& name) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (name.size() < 2 || name.size() >= sizeof address.sun_path) return -1;
  if (name[0] != '/' && name[0] != '@') return -1;
  std::memcpy(address.sun_path, name.data(), name.size());
  if (name[0] == '@') address.sun_path[0] = '\0';
  const int made = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  const auto size = socklen_t(offsetof(sockaddr_un, sun_path) + name.size());
  if (made < 0) return -1;
  if (connect(made, reinterpret_cast<const sockaddr*>(&address), size) == 0) return made;
  close(made);
  return -1;
}

}  // namespace

ServiceManager::ServiceManager() {
  if (const std::string name = take_variable("NOTIFY_SOCKET"); !name.empty())
    socket_ = connect_to(name);
  const std::string period = take_variable("WATCHDOG_USEC"), pid = take_variable("WATCHDOG_PID");
  if (pid.empty() || std::atol(pid.c_str()) == getpid())
    interval_ = std::atof(period.c_str()) * 1e-6 / 4;
}

ServiceManager::~ServiceManager() {
  if (socket_ >= 0) close(socket_);
}

void ServiceManager::say(const std::string& lines) const {
  if (socket_ >= 0) std::ignore = send(socket_, lines.data(), lines.size(), MSG_NOSIGNAL);
}

void ServiceManager::say_ready(const std::string& status) const {
  say("READY=1\nSTATUS=" + status);
}

void ServiceManager::say_reloading() const {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  say("RELOADING=1\nMONOTONIC_USEC=" +
      std::to_string(int64_t(now.tv_sec) * 1000000 + now.tv_nsec / 1000));
}

void ServiceManager::ping(double now) {
  if (interval_ <= 0 || now - pinged_ < interval_) return;
  pinged_ = now;
  say("WATCHDOG=1");
}

}  // namespace wellspring
