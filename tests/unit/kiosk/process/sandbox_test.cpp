// SPDX-License-Identifier: Apache-2.0
#include "kiosk/process/eye_process.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <functional>
#include <thread>

#include "unit/folder.h"

namespace wellspring::test {
namespace {

// Says whether the deed returns 0 in a process of its own, in the sandbox.
bool works(const std::function<int()>& deed, SandboxSettings settings = {}) {
  pid_t child = fork();
  if (child == 0) {
    try {
      enter_sandbox(settings);
    } catch (...) {
      _exit(99);
    }
    errno = 0;
    _exit(deed() >= 0 ? 0 : errno == EPERM ? 1 : 2);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_LT(WEXITSTATUS(status), 2) << "not refused by the sandbox: something else is wrong";
  return WEXITSTATUS(status) == 0;
}

struct Sandbox : testing::Test {
  test::Folder folder;
  std::string file = folder.file("there");
  void SetUp() override {
    int made = open(file.c_str(), O_CREAT | O_WRONLY, 0600);
    ASSERT_EQ(write(made, "kept", 4), 4);
    close(made);
  }
  int try_open(int flags) { return open(file.c_str(), flags, 0600); }
};

TEST_F(Sandbox, FilesAreReadAndNotWritten) {
  EXPECT_TRUE(works([&] { return try_open(O_RDONLY); }));
  for (int flags : {O_WRONLY, O_RDWR, O_RDONLY | O_TRUNC, O_WRONLY | O_CREAT, O_RDWR | O_APPEND})
    EXPECT_FALSE(works([&] { return try_open(flags); })) << flags;
  EXPECT_FALSE(works([&] { return open(folder.file("new").c_str(), O_RDONLY | O_CREAT, 0600); }));
  EXPECT_FALSE(works([&] { return open(folder.path.c_str(), O_TMPFILE | O_RDWR, 0600); }));
  EXPECT_FALSE(works([&] { return rename(file.c_str(), folder.file("other").c_str()); }));
  EXPECT_FALSE(works([&] { return symlink(file.c_str(), folder.file("other").c_str()); }));
  EXPECT_FALSE(works([&] { return mkdir(folder.file("more").c_str(), 0700); }));
  EXPECT_FALSE(works([&] { return truncate(file.c_str(), 0); }));
  EXPECT_FALSE(works([&] { return unlink(file.c_str()); }));
  char kept[8] = {};
  EXPECT_EQ(read(try_open(O_RDONLY), kept, 8), 4);
  EXPECT_STREQ(kept, "kept");
}

// A camera's device is opened to read and write; nothing is made, even so.
TEST_F(Sandbox, ADeviceMayBeOpened) {
  SandboxSettings device{true};
  EXPECT_TRUE(works([&] { return try_open(O_RDWR); }, device));
  for (int flags : {O_WRONLY, O_RDWR | O_CREAT, O_RDWR | O_TRUNC})
    EXPECT_FALSE(works([&] { return try_open(flags); }, device)) << flags;
}

TEST_F(Sandbox, ThereIsNoNetwork) {
  EXPECT_FALSE(works([] { return socket(AF_INET, SOCK_STREAM, 0); }));
  EXPECT_FALSE(works([] { return socket(AF_INET6, SOCK_DGRAM, 0); }));
  EXPECT_FALSE(works([] { return socket(AF_UNIX, SOCK_STREAM, 0); }));
  int before = socket(AF_INET, SOCK_STREAM, 0);  // one that it happens to have is of no use
  EXPECT_FALSE(works([&] {
    sockaddr_in there{};
    there.sin_family = AF_INET;
    there.sin_port = htons(9);
    there.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    return connect(before, reinterpret_cast<sockaddr*>(&there), sizeof there);
  }));
  close(before);
}

TEST_F(Sandbox, WhatIsOpenStaysOpen) {
  int pair[2];
  ASSERT_EQ(socketpair(AF_UNIX, SOCK_STREAM, 0, pair), 0);
  EXPECT_TRUE(works([&] { return int(write(pair[1], "seen", 4)); }));
  char text[8] = {};
  EXPECT_EQ(read(pair[0], text, 8), 4);
  close(pair[0]), close(pair[1]);
}

// Orders to the eye reach it there.
TEST_F(Sandbox, OrdersAreHeard) {
  EXPECT_TRUE(works([] {
    int ends[2];
    if (pipe(ends) != 0 || dup2(ends[0], STDIN_FILENO) < 0) return -1;
    Orders orders;
    if (orders.take()) return -1;
    if (!write_line(ends[1], R"({"type":"kiosk","stage":"sleep"})") ||
        !write_line(ends[1], "no order") || write(ends[1], R"({"type":"kiosk",)", 16) != 16)
      return -1;
    const auto first = orders.take();
    if (!first || first->stage != "sleep" || orders.take()) return -1;
    if (!write_line(ends[1], R"("stage":"engaged","needs":{"faces":false}})")) return -1;
    const auto second = orders.take();
    close(ends[1]);
    const bool ended = !orders.take();
    return second && second->stage == "engaged" && !second->needs.faces && ended ? 0 : -1;
  }));
}

TEST_F(Sandbox, ThreadsBeginAndProcessesDoNot) {
  EXPECT_TRUE(works([] {
    int seen = -1;
    std::thread([&] { seen = 0; }).join();
    return seen;
  }));
  EXPECT_FALSE(works([] { return int(fork()); }));
  EXPECT_FALSE(works([] { return execl("/bin/true", "true", nullptr); }));
  EXPECT_FALSE(works([] { return int(ptrace(PTRACE_TRACEME, 0, nullptr, nullptr)); }));
}

TEST_F(Sandbox, NoMemoryImageIsLeft) {
  EXPECT_TRUE(works([] {
    rlimit limit{1, 1};
    getrlimit(RLIMIT_CORE, &limit);
    return limit.rlim_max == 0 && prctl(PR_GET_DUMPABLE) == 0 ? 0 : -1;
  }));
}

// A thread that runs before is in it afterwards, too.
TEST_F(Sandbox, HoldsForThreadsThatRun) {
  pid_t child = fork();
  if (child == 0) {
    std::atomic<bool> entered = false;
    int error = 0;
    std::thread other([&] {
      while (!entered) std::this_thread::yield();
      error = try_open(O_WRONLY) < 0 ? errno : 0;
    });
    enter_sandbox();
    entered = true;
    other.join();
    _exit(error);
  }
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), EPERM);
}

}  // namespace
}  // namespace wellspring::test
