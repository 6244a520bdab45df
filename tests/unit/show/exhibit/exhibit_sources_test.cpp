// SPDX-License-Identifier: Apache-2.0
#include "show/exhibit/pieces/exhibit_sources.h"

#include <gtest/gtest.h>

#include "show/exhibit/pieces/exhibit_pieces.h"
#include "unit/show/exhibit/room_package.h"

namespace wellspring::test {
namespace {

// Returns the problems of an exhibit with these hosts and a piece of this source.
std::string problems_of(const std::string& hosts, const std::string& source) {
  const Folder folder;
  Exhibit exhibit;
  exhibit.folder = folder.path;
  std::vector<Problem> problems;
  const std::string pieces = R"([{"id": "a", "kind": "picture", "source": ")" + source +
                             R"(", "place": {"position": [0, 0, 0]}}])";
  read_fields(json::parse(R"({"allowed_hosts": )" + hosts + R"(, "pieces": )" + pieces + "}"),
              "exhibit.json", problems,
              [&](FieldReader& root) { read_pieces(exhibit, root, problems); });
  std::string all;
  for (const Problem& problem : problems) all += to_string(problem) + "\n";
  return all;
}

TEST(ExhibitSources, HostsThatAreNotAllowedAreToldWithWhatToAdd) {
  const std::string place = "exhibit.json: /pieces/0/source: ";
  const auto refusal = [&](const std::string& host) {
    return place + "host '" + host + "' is not allowed: add \"" + host +
           "\" to \"allowed_hosts\" of this file\n";
  };
  EXPECT_EQ(problems_of("[]", "https://iiif.example.org/a"), refusal("iiif.example.org"));
  EXPECT_EQ(problems_of(R"(["127.0.0.1"])", "http://127.0.0.1:9/a/info.json"),
            refusal("127.0.0.1:9"));
  EXPECT_EQ(problems_of("[]", "http:///a"), place + "'http:///a' is no http or https address\n");
  // Port 1 of this machine has no server.
  EXPECT_NE(problems_of(R"(["127.0.0.1:1"])", "http://127.0.0.1:1/a").find("cannot be reached"),
            std::string::npos);
}

TEST(ExhibitSources, WhatIsNoHostIsAProblem) {
  for (const char* host : {"", "*", "*.example.org", "https://a", "a/b", "a:b", "u@a"})
    EXPECT_NE(problems_of(std::string("[\"") + host + "\"]", "a.png")
                  .find("exhibit.json: /allowed_hosts/0: '"),
              std::string::npos)
        << host;
}

}  // namespace
}  // namespace wellspring::test
