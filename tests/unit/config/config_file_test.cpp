// SPDX-License-Identifier: Apache-2.0
#include "config/config_file.h"

#include <CLI/CLI.hpp>
#include <gtest/gtest.h>

#include "base/layers.h"
#include "unit/folder.h"

namespace wellspring::test {
namespace {

using wellspring::test::Folder;

// A program with an option of every kind.
struct Program {
  CLI::App app{"for tests"};
  std::string host = "127.0.0.1";
  int port = 8080;
  double rate = 2.5;
  bool draws = true, watches = false;
  std::vector<std::string> names;
  Folder folder;

  Program() {
    app.option_defaults()->always_capture_default();
    app.add_option("--host", host, "address to listen on");
    app.add_option("-p,--port", port, "0: any free one")->check(CLI::Range(0, 65535));
    app.add_option("--frame-rate", rate, "a second")->envname("WELLSPRING_TEST_RATE");
    app.add_option("--name", names, "a name; once for each")->allow_extra_args(false);
    add_switch(app, "--draw,!--no-draw", draws, "draws");
    add_switch(app, "--watch", watches, "watches");
    add_config(app, "");
  }
  void run(const std::string& text, std::vector<std::string> words = {}) {
    words.insert(words.begin(), {"program", "--config", folder.write("a.conf", text)});
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    parse_with_config(app, int(argv.size()), argv.data());
  }
  // Returns the problems of a file, without its folder.
  std::vector<std::string> problems(const std::string& text, std::vector<std::string> words = {}) {
    try {
      run(text, std::move(words));
    } catch (const ConfigError& error) {
      std::vector<std::string> found = error.problems;
      for (std::string& one : found) one.erase(0, folder.path.string().size() + 1);
      return found;
    }
    return {};
  }
};

using Lines = std::vector<std::string>;

TEST(ConfigFile, SetsOptionsOfEveryKind) {
  Program p;
  p.run(
      "\xef\xbb\xbf# a comment\n\n host =  ::1 \r\nport=81\nframe-rate = 0.5\ndraw = false\n"
      "watch = true\nname = a = b # c\nname = [x]\nname =\n");
  EXPECT_EQ(p.host, "::1");
  EXPECT_EQ(p.port, 81);
  EXPECT_EQ(p.rate, 0.5);
  EXPECT_FALSE(p.draws);
  EXPECT_TRUE(p.watches);
  EXPECT_EQ(p.names, (Lines{"a = b # c", "[x]"}));
}

TEST(ConfigFile, AnEmptyTextIsAValue) {
  Program p;
  p.run("host =");
  EXPECT_EQ(p.host, "");
}

TEST(ConfigFile, TheCommandLineWinsAndTheFileIsCheckedAllTheSame) {
  Program p;
  p.run("port = 81\ndraw = true\nname = a\nname = b\n",
        {"--port", "82", "--no-draw", "--name", "c"});
  EXPECT_EQ(p.port, 82);
  EXPECT_FALSE(p.draws);
  EXPECT_EQ(p.names, Lines{"c"});
  EXPECT_EQ(Program().problems("port = 70000", {"--port", "82"}).size(), 1u);
}

TEST(ConfigFile, TheEnvironmentWinsOverTheFile) {
  setenv("WELLSPRING_TEST_RATE", "7", 1);
  Program p;
  p.run("frame-rate = 3\n");
  unsetenv("WELLSPRING_TEST_RATE");
  EXPECT_EQ(p.rate, 7);
}

TEST(ConfigFile, NamesEverythingThatIsWrongWithItsLine) {
  const Lines found = Program().problems(
      "port = 70000\nhots = ::1\n\nport\nframe-rate = fast\ndraw = maybe\nno-draw = true\n"
      "host = a\nhost = b\nconfig = b\nhelp = true\n= 3\n[section]\n");
  ASSERT_EQ(found.size(), 11u);
  // The rest are the words of CLI11, which differ from one of its versions to the next.
  EXPECT_EQ(found[0].find("a.conf: line 1: port: Value 70000 not in range"), 0u) << found[0];
  EXPECT_EQ(found[1], "a.conf: line 2: there is no key 'hots'; did you mean 'host'?");
  EXPECT_EQ(found[2], "a.conf: line 4: is not of the form key = value");
  EXPECT_EQ(found[3], "a.conf: line 5: frame-rate: 'fast' is no value for it");
  EXPECT_EQ(found[4], "a.conf: line 6: draw: 'maybe' is not true or false");
  EXPECT_EQ(found[5], "a.conf: line 7: there is no key 'no-draw'");
  EXPECT_EQ(found[6], "a.conf: line 9: host stands here again; line 8 has it");
  EXPECT_EQ(found[7], "a.conf: line 10: there is no key 'config'");
  EXPECT_EQ(found[8], "a.conf: line 11: there is no key 'help'");
  EXPECT_EQ(found[10], "a.conf: line 13: is not of the form key = value");
}

TEST(ConfigFile, AFileThatIsNoneIsRefused) {
  Program p;
  EXPECT_EQ(p.problems(std::string("host = a\0b\n", 11)), Lines{"a.conf: line 1: is no text"});
  EXPECT_EQ(Program().problems(std::string(2 << 20, 'x')), Lines{"a.conf: is larger than 1 MiB"});
}

TEST(ConfigFile, WhatIsWrittenIsReadAsItWas) {
  Program p;
  p.run("port = 81\nname = a\nname = b\nwatch = true\n", {"--no-draw"});
  const std::string text = write_config(p.app);
  EXPECT_EQ(text,
            "# address to listen on\n#host = 127.0.0.1\n\n# 0: any free one\nport = 81\n\n"
            "# a second\n#frame-rate = 2.5\n\n# a name; once for each\nname = a\nname = b\n\n"
            "# draws\ndraw = false\n\n# watches\nwatch = true\n");
  Program again;
  again.run(text);
  EXPECT_EQ(write_config(again.app), text);
}

}  // namespace
}  // namespace wellspring::test
