// SPDX-License-Identifier: Apache-2.0
#include "kiosk/process/recording.h"

#include <gtest/gtest.h>

#include "base/load_error.h"
#include "unit/folder.h"
#include "wire/json.h"

namespace wellspring::test {
namespace {

std::string observed(double time) {
  Observation seen{.time = time, .state = Presence::person};
  Person person{.position = {0.1f, 0.2f, 1}};
  seen.people = {person};
  return write_observation(seen);
}

struct Recorded : testing::Test {
  test::Folder folder;
  std::string file = folder.file("seen.jsonl");
  void record(std::initializer_list<std::string> lines) {
    Recorder recorder(file);
    for (const std::string& line : lines) ASSERT_TRUE(recorder.write(line));
  }
  std::string problem() {
    Observation seen;
    std::string text;
    try {
      Replay replay(file);
      while (replay.next(seen, text)) {}
    } catch (const LoadError& error) {
      return error.what();
    }
    return "";
  }
};

TEST_F(Recorded, ComesBackAsItWas) {
  record({observed(1), "", observed(1.5), observed(1.5)});
  Replay replay(file);
  Observation seen;
  std::string text;
  for (double time : {1.0, 1.5, 1.5}) {
    ASSERT_TRUE(replay.next(seen, text));
    EXPECT_EQ(seen.time, time);
    EXPECT_EQ(text, observed(time));
  }
  EXPECT_FALSE(replay.next(seen, text));
}

TEST_F(Recorded, NamesTheLineThatIsNone) {
  record({observed(1), "nonsense"});
  EXPECT_NE(problem().find(file + ": line 2: "), std::string::npos) << problem();
  record({observed(2), "", observed(1)});
  EXPECT_EQ(problem(), file + ": line 3: time runs back");
  EXPECT_THROW(Replay(folder.file("none")), LoadError);
  EXPECT_THROW(Recorder(folder.file("no/where")), LoadError);
}

TEST_F(Recorded, AFullDiskIsTold) {
  Recorder full("/dev/full");
  EXPECT_FALSE(full.write(observed(1)));
}

}  // namespace
}  // namespace wellspring::test
