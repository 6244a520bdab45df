// SPDX-License-Identifier: Apache-2.0
// What pictures cost is processor time: a machine that is busy with other programs takes longer for
// them, and does not find them dearer.
#include <gtest/gtest.h>

#include <csignal>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/clock.h"
#include "show/state/visitor_picture.h"
#include "unit/show/show_stage.h"

namespace wellspring::test {
namespace {

// Stops this process for 20 ms out of every 25, until it ends.
class BusyMachine {
 public:
  BusyMachine() {
    if (pipe(ends_) != 0) throw std::runtime_error("no pipe");
    const pid_t busy = getpid();
    child_ = fork();
    if (child_ != 0) return;
    close(ends_[1]);
    pollfd goes_on{ends_[0], POLLIN, 0};
    for (int i = 0; i < 2000 && poll(&goes_on, 1, 5) == 0; i++) {
      kill(busy, SIGSTOP);
      usleep(20000);
      kill(busy, SIGCONT);
    }
    _exit(0);
  }
  ~BusyMachine() {
    close(ends_[1]);
    waitpid(child_, nullptr, 0);
    close(ends_[0]);
  }

 private:
  int ends_[2] = {};
  pid_t child_ = 0;
};

TEST(BusyMachine, PicturesCostNoMoreThanTheProcessorTimeOfAll) {
  constexpr int width = 480, height = 270, pictures = 40, guessed = 30;
  ShowStage stage;
  stage.begin(make_tiny_exhibit(), settings_for("direct"));
  stage.join(width, height);
  stage.step();
  const auto known = stage.show->totals.drawn;
  const double before = stage.show->visits.capacity->standing().cost.drawn;
  const double began = process_seconds_now();
  double spent = 0;
  {
    const BusyMachine busy;
    for (auto drawn = known; drawn < known + pictures;) {
      stage.turn(0.05);
      stage.step();
      if (stage.show->totals.drawn == drawn) continue;  // samples had their turn
      drawn = stage.show->totals.drawn;
      spent += stage.visitor().picture->costs.core_seconds;
    }
  }
  const double had = process_seconds_now() - began;
  // Capacity's mean of so many pictures, back to their sum.
  const double pixels = weighed_pixels(width * height);
  const auto first = double(known + guessed);
  const double after = stage.show->visits.capacity->standing().cost.drawn;
  const double sum = pixels * (after * (first + pictures) - before * first);
  EXPECT_GE(sum, 0.9 * spent);  // small keyframes count as those of full size
  EXPECT_GT(spent, 0.05 * had);
  EXPECT_LE(spent, 1.001 * had);
}

}  // namespace
}  // namespace wellspring::test
