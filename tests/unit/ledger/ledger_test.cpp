// SPDX-License-Identifier: Apache-2.0
// Sums on disk: over restarts, beside other servers, and where the file is damaged, locked or may
// not be written.
#include "ledger/ledger.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sqlite3.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <thread>

#include "base/layers.h"
#include "ledger/sums.h"
#include "unit/folder.h"

namespace wellspring::test {
namespace {

struct LedgerTest : testing::Test {
  test::Folder folder;
  std::string file = folder.file("kept/sums.sqlite");
  // Nothing is written by itself.
  LedgerSettings settings() const { return {file, 1e6, 50}; }
  static Sums visits(double count, int64_t day = 20000) {
    return {{{day, "visits", "castle"}, count}};
  }
  Sums kept() const { return read_from_file(file, 0, 100000, 50); }
  std::vector<std::string> damaged() const {
    std::vector<std::string> names;
    for (const auto& one : std::filesystem::directory_iterator(folder.path / "kept"))
      if (one.path().extension().string().starts_with(".damaged-") &&
          !one.path().string().ends_with("-wal") && !one.path().string().ends_with("-shm"))
        names.push_back(one.path().string());
    return names;
  }
};

TEST_F(LedgerTest, WhatIsAddedIsWrittenAndStaysOverRestarts) {
  {
    Ledger ledger(settings());
    ledger.add(visits(2));
    EXPECT_EQ(kept(), Sums{}) << "nothing yet: it is written now and then";
    EXPECT_EQ(ledger.read(0, 100000), visits(2)) << "but told";
    EXPECT_TRUE(ledger.write());
    EXPECT_EQ(kept(), visits(2));
    EXPECT_TRUE(ledger.write());
    EXPECT_EQ(kept(), visits(2)) << "once";
    ledger.add(visits(1));
  }
  EXPECT_EQ(kept(), visits(3)) << "the rest at its end";
  Ledger ledger(settings());
  ledger.add(visits(4));
  EXPECT_EQ(ledger.read(20000, 20000), visits(7));
  EXPECT_EQ(ledger.read(20001, 30000), Sums{});
  EXPECT_EQ(ledger.read(0, 19999), Sums{});
}

TEST_F(LedgerTest, WritesByItself) {
  LedgerSettings soon = settings();
  soon.seconds = 0.05;
  Ledger ledger(soon);
  ledger.add(visits(1));
  for (int i = 0; i < 400 && kept().empty(); i++)
    std::this_thread::sleep_for(std::chrono::milliseconds(25));
  EXPECT_EQ(kept(), visits(1));
}

TEST_F(LedgerTest, MidnightIsWrittenAtOnceAndPartsDays) {
  Ledger ledger(settings());
  ledger.add(visits(2, 20000));
  ledger.add(visits(3, 20001));
  for (int i = 0; i < 400 && kept().empty(); i++)
    std::this_thread::sleep_for(std::chrono::milliseconds(25));
  EXPECT_EQ(kept(), (Sums{{{20000, "visits", "castle"}, 2}, {{20001, "visits", "castle"}, 3}}));
}

TEST_F(LedgerTest, SumsOfAClockThatWasNeverSetAreOfTheFirstDayThatIs) {
  Ledger ledger(settings());
  ledger.add(visits(2, 0));
  EXPECT_EQ(ledger.read(0, 100000), Sums{});
  ledger.add(visits(3, 20000));
  EXPECT_EQ(ledger.read(0, 100000), visits(5, 20000));
  EXPECT_TRUE(ledger.write());
  EXPECT_EQ(kept(), visits(5, 20000));
}

TEST_F(LedgerTest, AKilledProgramLosesOnlyWhatWasNotWritten) {
  const pid_t child = fork();
  if (child == 0) {
    Ledger* ledger = new Ledger(settings());
    ledger->add(visits(5));
    ledger->write();
    ledger->add(visits(7));
    kill(getpid(), SIGKILL);
  }
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(kept(), visits(5));
  Ledger(settings()).add(visits(1));
  EXPECT_EQ(kept(), visits(6));
}

TEST_F(LedgerTest, SeveralServersAddToOneFile) {
  constexpr int servers = 4, rounds = 10;
  std::vector<pid_t> children;
  for (int i = 0; i < servers; i++) {
    const pid_t child = fork();
    if (child == 0) {
      bool good = true;
      {
        LedgerSettings patient = settings();
        patient.patience = 60000;
        Ledger ledger(patient);
        for (int k = 0; k < rounds; k++) ledger.add(visits(1)), good &= ledger.write();
      }
      _exit(good ? 0 : 1);
    }
    children.push_back(child);
  }
  for (pid_t child : children) {
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  }
  EXPECT_EQ(kept(), visits(servers * rounds));
}

TEST_F(LedgerTest, ADamagedFileIsPutAsideAndBegunAnew) {
  std::filesystem::create_directories(folder.path / "kept");
  const std::string rubbish(5000, 'x');
  folder.write("kept/sums.sqlite", rubbish);
  Ledger ledger(settings());
  ledger.add(visits(2));
  EXPECT_THROW(ledger.read(0, 100000), std::runtime_error);
  EXPECT_TRUE(ledger.write());
  EXPECT_EQ(kept(), visits(2));
  ASSERT_EQ(damaged().size(), 1u);
  std::ifstream in(damaged()[0], std::ios::binary);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(in), {}), rubbish);
}

TEST_F(LedgerTest, APageDamagedInTheMiddleIsNoticed) {
  {
    Ledger ledger(settings());
    for (int i = 0; i < 2000; i++)
      ledger.add({{{20000, "dwell_seconds", "castle/" + std::to_string(i)}, 1}});
  }
  std::string bytes = folder.read("kept/sums.sqlite");
  ASSERT_GT(bytes.size(), 20000u);
  std::fill(bytes.begin() + 4096, bytes.end(), '\xff');
  folder.write("kept/sums.sqlite", bytes);
  Ledger ledger(settings());
  ledger.add({{{20000, "dwell_seconds", "castle/1000"}, 1}});
  EXPECT_TRUE(ledger.write());
  EXPECT_EQ(kept(), (Sums{{{20000, "dwell_seconds", "castle/1000"}, 1}}));
  EXPECT_EQ(damaged().size(), 1u);
}

TEST_F(LedgerTest, ALockedFileIsWrittenLater) {
  Ledger(settings()).add(visits(1));
  sqlite3* other = nullptr;
  ASSERT_EQ(sqlite3_open(file.c_str(), &other), SQLITE_OK);
  ASSERT_EQ(sqlite3_exec(other, "BEGIN IMMEDIATE", nullptr, nullptr, nullptr), SQLITE_OK);
  Ledger ledger(settings());
  ledger.add(visits(2));
  EXPECT_FALSE(ledger.write());
  EXPECT_NE(ledger.problem().find("locked"), std::string::npos) << ledger.problem();
  EXPECT_EQ(ledger.read(0, 100000), visits(3)) << "what is there, and what waits";
  sqlite3_exec(other, "ROLLBACK", nullptr, nullptr, nullptr);
  sqlite3_close(other);
  EXPECT_TRUE(ledger.write());
  EXPECT_EQ(ledger.problem(), "");
  EXPECT_EQ(kept(), visits(3));
  EXPECT_TRUE(damaged().empty()) << "a lock is no damage";
}

TEST_F(LedgerTest, WhereNobodyMayWriteSumsWait) {
  folder.write("kept", "a file where the folder should be");
  Ledger ledger(settings());
  ledger.add(visits(2));
  EXPECT_FALSE(ledger.write());
  EXPECT_NE(ledger.problem(), "");
  ledger.add(visits(1));
  std::filesystem::remove(folder.path / "kept");
  EXPECT_TRUE(ledger.write());
  EXPECT_EQ(kept(), visits(3));
}

TEST_F(LedgerTest, AFullDiskLosesNothing) {
  Ledger(settings()).add(visits(1));
  // A file that may not grow stands for a disk that is full.
  const pid_t child = fork();
  if (child == 0) {
    struct rlimit limit = {4096, 4096};
    signal(SIGXFSZ, SIG_IGN);
    setrlimit(RLIMIT_FSIZE, &limit);
    Ledger ledger(settings());
    for (int i = 0; i < 2000; i++)
      ledger.add({{{20000, "dwell_seconds", "castle/" + std::to_string(i)}, 1}});
    const bool failed = !ledger.write() && !ledger.problem().empty();
    _exit(failed ? 0 : 1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  EXPECT_EQ(kept(), visits(1)) << "all of a write or nothing";
  EXPECT_TRUE(damaged().empty());
}

}  // namespace
}  // namespace wellspring::test
