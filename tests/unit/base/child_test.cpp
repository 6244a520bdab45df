// SPDX-License-Identifier: Apache-2.0
#include "base/child.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <stdexcept>

namespace wellspring::test {
namespace {

std::vector<std::string> shell(const std::string& script) { return {"sh", "-c", script}; }

std::string read_all(int from) {
  std::string text;
  char part[256];
  for (ssize_t count; (count = read(from, part, sizeof part)) > 0;)
    text.append(part, size_t(count));
  return text;
}

TEST(Child, ReadsAndWritesThroughPipes) {
  Child child({.words = shell("read line; echo got $line >&5"), .reads = 0, .writes = 5});
  ASSERT_EQ(write(child.to(), "this\n", 5), 5);
  EXPECT_EQ(read_all(child.from()), "got this\n");
  EXPECT_EQ(child.wait(), 0);
}

TEST(Child, HasNoFilesButThoseItIsGiven) {
  int ours[2];
  ASSERT_EQ(pipe(ours), 0);  // would be inherited
  Child child({.words = shell("ls /proc/self/fd | tr '\\n' ' '"), .writes = 1});
  EXPECT_EQ(read_all(child.from()), "0 1 2 3 ");  // the last is the folder's
  close(ours[0]), close(ours[1]);
}

TEST(Child, SaysHowItEnded) {
  EXPECT_EQ(Child({.words = shell("exit 3")}).wait(), 3);
  Child killed({.words = shell("kill -9 $$")});
  EXPECT_EQ(killed.wait(), -SIGKILL);
  EXPECT_EQ(killed.wait(), -SIGKILL);
  EXPECT_EQ(killed.id(), 0);
  Child child({.words = {"sleep", "60"}});
  EXPECT_FALSE(child.wait(0.02));
}

TEST(Child, ThatCannotBeStartedIsNamed) {
  try {
    Child child({.words = {"/none/program"}, .reads = 0, .writes = 1});
    ADD_FAILURE();
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "/none/program cannot be started: No such file or directory");
  }
}

// A pipe that a test and its children hold.
struct Shared {
  int read_end = -1, write_end = -1;
  Shared() {
    int ends[2];
    EXPECT_EQ(pipe2(ends, O_CLOEXEC), 0);
    read_end = ends[0], write_end = ends[1];
  }
  ~Shared() { close(read_end); }
  void wait_for_byte() const {
    char byte;
    EXPECT_EQ(read(read_end, &byte, 1), 1);
  }
  // Returns the rest, once no child holds it any more.
  std::string rest() {
    close(write_end);
    return read_all(read_end);
  }
};

TEST(Child, EndsWithItsValueAndWithItsGroup) {
  Shared shared;
  {
    Child child({.words = shell("sleep 600 & echo; wait"),
                 .files = {{shared.write_end, 1}},
                 .apart = true});
    shared.wait_for_byte();
  }
  EXPECT_EQ(shared.rest(), "");
}

TEST(Child, IsAskedToEndBeforeItIsKilled) {
  Shared shared;
  for (const char* trap : {"trap '' TERM", "trap 'echo asked; exit' TERM"}) {
    Child child({.words = shell(trap + std::string("; echo; while :; do sleep 0.01; done")),
                 .files = {{shared.write_end, 1}},
                 .patience = 0.3});
    shared.wait_for_byte();
  }
  EXPECT_EQ(shared.rest(), "asked\n");
}

}  // namespace
}  // namespace wellspring::test
