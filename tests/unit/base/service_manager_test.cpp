// SPDX-License-Identifier: Apache-2.0
#include "base/host.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>
#include <vector>

#include "unit/folder.h"

namespace wellspring::test {
namespace {

// The manager's end.
struct Manager {
  test::Folder folder;
  std::string name = folder.file("notify");
  int socket = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK, 0);
  Manager() {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strcpy(address.sun_path, name.c_str());
    EXPECT_EQ(bind(socket, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  }
  ~Manager() { close(socket); }
  std::vector<std::string> heard() {
    std::vector<std::string> all;
    char text[200];
    for (ssize_t size; (size = recv(socket, text, sizeof text, 0)) >= 0;)
      all.emplace_back(text, size_t(size));
    return all;
  }
};

using Lines = std::vector<std::string>;

TEST(ServiceManager, SaysWhatItIsToldInDatagrams) {
  Manager manager;
  setenv("NOTIFY_SOCKET", manager.name.c_str(), 1);
  ServiceManager said;
  EXPECT_EQ(std::getenv("NOTIFY_SOCKET"), nullptr);
  said.say_ready("serves");
  said.say_reloading();
  said.ping(1);
  const Lines heard = manager.heard();
  ASSERT_EQ(heard.size(), 2u) << "no pings where nobody asks for them";
  EXPECT_EQ(heard[0], "READY=1\nSTATUS=serves");
  EXPECT_EQ(heard[1].rfind("RELOADING=1\nMONOTONIC_USEC=", 0), 0u);
}

TEST(ServiceManager, PingsFourTimesInTheWatchdogsTime) {
  Manager manager;
  setenv("NOTIFY_SOCKET", manager.name.c_str(), 1);
  setenv("WATCHDOG_USEC", "4000000", 1);
  ServiceManager said;
  EXPECT_EQ(std::getenv("WATCHDOG_USEC"), nullptr);
  for (double now = 10; now < 13; now += 0.125) said.ping(now);
  EXPECT_EQ(manager.heard(), Lines(3, "WATCHDOG=1"));
}

TEST(ServiceManager, IsSilentForAnotherProcessAndWithoutAManager) {
  Manager manager;
  setenv("NOTIFY_SOCKET", manager.name.c_str(), 1);
  setenv("WATCHDOG_USEC", "4000000", 1);
  setenv("WATCHDOG_PID", std::to_string(getppid()).c_str(), 1);
  ServiceManager().ping(10);
  EXPECT_EQ(manager.heard(), Lines{});
  setenv("NOTIFY_SOCKET", (manager.name + "/none").c_str(), 1);
  ServiceManager().say("READY=1");
  unsetenv("NOTIFY_SOCKET");
  ServiceManager().say("READY=1");
}

}  // namespace
}  // namespace wellspring::test
