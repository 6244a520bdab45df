// SPDX-License-Identifier: Apache-2.0
// A job's state is the same in whatever order, and however often, it hears what happened; its
// messages arrive whole or not at all; its words run nothing but what is allowed.
#include "workers/jobs/job.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "unit/folder.h"
#include "workers/jobs/job_message.h"
#include "workers/jobs/job_words.h"

namespace wellspring::test {
namespace {

const MessageKey none;

JobOrder make_job(uint32_t shards = 3) {
  return {"bake-hall-01", "0.1.0", "x86-64 avx2", 77, shards, {"bake", "hall", "--passes", "4"}};
}
JobEvent event(uint32_t shard, JobNews news, uint64_t place, uint64_t delivery, float share = 0) {
  return {"bake-hall-01", shard, news, place, delivery, share, "north", "", 0, {}};
}

TEST(JobState, IsAFunctionOfWhatWasTold) {
  // Shard 0 is killed at work, then done; 1 fails, is dead, and waits again; 2 is given back.
  const std::vector<JobEvent> all{
      event(0, JobNews::works, 1, 1, 0.4f),  event(0, JobNews::works, 1, 2, 0.1f),
      event(0, JobNews::done, 1, 2, 1),      event(1, JobNews::works, 2, 1),
      event(1, JobNews::failed, 2, 1),       event(1, JobNews::works, 4, 1),
      event(1, JobNews::dead, 4, 1),         event(1, JobNews::waits, 6, 0),
      event(2, JobNews::works, 3, 1, 0.75f), event(2, JobNews::waits, 5, 0),
  };
  JobState wanted(make_job());
  for (const JobEvent& one : all) wanted.take(one);
  EXPECT_EQ(wanted.shards[0].news, JobNews::done);
  EXPECT_EQ(wanted.shards[1].news, JobNews::waits);
  EXPECT_EQ(wanted.shards[1].place, 6u);
  EXPECT_EQ(wanted.shards[2].news, JobNews::waits);
  EXPECT_NEAR(wanted.share(), 1.0 / 3, 1e-6);
  std::vector<size_t> order(all.size());
  for (size_t i = 0; i < order.size(); i++) order[i] = i;
  for (int turn = 0; turn < 200; turn++) {
    std::next_permutation(order.begin(), order.end());
    std::rotate(order.begin(), order.begin() + turn % 7, order.end());
    JobState state(make_job());
    for (const size_t i : order) state.take(all[i]), state.take(all[order[0]]);
    for (size_t i = 0; i < 3; i++) {
      EXPECT_EQ(state.shards[i].news, wanted.shards[i].news);
      EXPECT_EQ(state.shards[i].place, wanted.shards[i].place);
      EXPECT_EQ(state.shards[i].delivery, wanted.shards[i].delivery);
    }
  }
}

TEST(JobState, WhatIsDoneStaysSo) {
  JobState state(make_job());
  state.take(event(1, JobNews::done, 2, 1, 1));
  state.take(event(1, JobNews::works, 9, 1, 0.5f));  // somebody who was thought dead, once more
  state.take(event(1, JobNews::dead, 9, 3));
  EXPECT_EQ(state.shards[1].news, JobNews::done);
  EXPECT_EQ(state.count(JobNews::done), 1u);
}

TEST(JobState, GoesOnByTheLastAttempt) {
  JobState state(make_job(1));
  state.take(event(0, JobNews::works, 1, 1, 0.9f));
  EXPECT_NEAR(state.share(), 0.9, 1e-6);
  state.take(event(0, JobNews::works, 1, 2, 0.1f));  // was handed out again
  EXPECT_NEAR(state.share(), 0.1, 1e-6);
  state.take(event(0, JobNews::works, 1, 1, 0.95f));  // came late
  EXPECT_NEAR(state.share(), 0.1, 1e-6);
  state.take(event(0, JobNews::refused, 1, 2));
  EXPECT_EQ(state.count(JobNews::refused), 1u);
  JobEvent other = event(0, JobNews::done, 5, 1);
  other.job = "another";
  state.take(other);
  state.take(event(7, JobNews::done, 5, 1));
  EXPECT_EQ(state.count(JobNews::done), 0u);
}

TEST(JobMessage, KeepsWhatIsWritten) {
  JobOrder order;
  ASSERT_TRUE(read_job(write_job(make_job(), none), none, order));
  EXPECT_EQ(order.words, make_job().words);
  EXPECT_EQ(order.inputs, 77u);
  EXPECT_EQ(order.shards, 3u);
  ShardTask task;
  ASSERT_TRUE(read_job(write_job(ShardTask{"a-1", 4095, 2}, none), none, task));
  EXPECT_EQ(task.job, "a-1");
  EXPECT_EQ(task.shard, 4095u);
  EXPECT_EQ(task.failures, 2u);
  JobEvent told = event(2, JobNews::done, 8, 3, 1), read;
  told.files = {{"3.bake", {1, 2, 3}, 4096}, {"0001.png", {}, 0}};
  told.reason = std::string(5000, 'x');  // is cut
  ASSERT_TRUE(read_job(write_job(told, none), none, read));
  EXPECT_EQ(read.files, told.files);
  EXPECT_EQ(read.place, 8u);
  EXPECT_EQ(read.reason.size(), most_reason_bytes);
}

TEST(JobMessage, RefusesWhatIsNone) {
  const MessageKey key = make_message_key("secret"), other = make_message_key("another");
  JobEvent told = event(0, JobNews::done, 1, 1, 1), event_read;
  told.files = {{"3.bake", {1, 2, 3}, 4096}};
  const std::string sealed = write_job(told, key), open = write_job(told, none);
  EXPECT_TRUE(read_job(sealed, key, event_read));
  EXPECT_FALSE(read_job(sealed, other, event_read));
  EXPECT_FALSE(read_job(sealed, none, event_read));
  EXPECT_FALSE(read_job(open, key, event_read));
  for (size_t size = 0; size < open.size(); size++)
    EXPECT_FALSE(read_job(std::string_view(open).substr(0, size), none, event_read));
  EXPECT_FALSE(read_job(open + "x", none, event_read));
  for (const char* name : {"../3.bake", "/etc/passwd", ".hidden", "", "a/b"}) {
    told.files[0].name = name;
    EXPECT_FALSE(read_job(write_job(told, none), none, event_read)) << name;
  }
  JobOrder order, bad = make_job();
  bad.shards = 0;
  EXPECT_FALSE(read_job(write_job(bad, none), none, order));
  bad = make_job(), bad.job = "a.b";  // would be two parts of a subject
  EXPECT_FALSE(read_job(write_job(bad, none), none, order));
  EXPECT_FALSE(read_job(write_job(ShardTask{"a", 0, 0}, none), none, order));
}

std::string refusal(const std::vector<std::string>& words, uint32_t shards = 1) {
  try {
    check_words(words, shards);
    return "";
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
}

TEST(JobWords, RunsNothingElse) {
  EXPECT_EQ(refusal({"bake", "content/hall", "--passes", "4"}, 8), "");
  EXPECT_EQ(refusal({"import", "picture", "a.png", "b c.tif", "--quality", "80"}, 2), "");
  EXPECT_EQ(refusal({"clip", "f.x3d", "s.story", "--close", "--size", "48x64"}), "");
  EXPECT_EQ(refusal({"lamps", "--picture", "p.tif", "--lamps", "A,589.0*2+589.6"}), "");
  EXPECT_EQ(refusal({"lamps", "--lamp-file", "a.csv", "b.csv", "--picture", "p.tif"}), "");
  for (const std::vector<std::string>& words :
       std::vector<std::vector<std::string>>{{},
                                             {"rm", "x"},
                                             {"bake", "--passes", "4"},
                                             {"bake", "hall", "--passes", "four"},
                                             {"bake", "hall", "--passes"},
                                             {"bake", "hall"},
                                             {"bake", "hall", "hall2", "--passes", "4"},
                                             {"bake", "/etc", "--passes", "4"},
                                             {"bake", "a/../../b", "--passes", "4"},
                                             {"bake", "hall", "--passes", "4", "--out", "x"},
                                             {"bake", "hall", "--passes", "4", "--merge", "x"},
                                             {"import", "volume", "x"},
                                             {"import", "picture", "@list"},
                                             {"clip", "f.x3d", "s.story", "--lang", "$(reboot)"},
                                             {"clip", "f.x3d", "s.story", "--lang", "-x"},
                                             {"clip", "f.x3d"}})
    EXPECT_NE(refusal(words), "") << testing::PrintToString(words);
  EXPECT_EQ(refusal({"import", "scan", "a.las"}), "");
  EXPECT_NE(refusal({"import", "scan", "a.las"}, 2), "");
}

TEST(JobWords, PathsStayBelowTheirFolder) {
  const Folder folder;
  const std::filesystem::path root = folder.path / "root";
  std::filesystem::create_directories(root / "in");
  std::ofstream(root / "in" / "a") << "a";
  std::ofstream(folder.path / "secret") << "s";
  std::filesystem::create_symlink("../secret", root / "out");
  EXPECT_TRUE(path_below(root, "in/a"));
  EXPECT_FALSE(path_below(root, "in/none"));
  EXPECT_FALSE(path_below(root, "../secret"));
  EXPECT_FALSE(path_below(root, "out"));
  EXPECT_FALSE(path_below(root / "in", "../in2"));
}

}  // namespace
}  // namespace wellspring::test
