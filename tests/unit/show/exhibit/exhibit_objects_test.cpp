// SPDX-License-Identifier: Apache-2.0
#include "show/exhibit/exhibit_objects.h"

#include <gtest/gtest.h>

#include "unit/show/tiny_exhibit.h"

namespace wellspring::test {
namespace {

std::vector<Problem> read_objects(Exhibit& exhibit, const std::string& text) {
  std::vector<Problem> problems;
  read_fields(nlohmann::json::parse(text), "exhibit.json", problems,
              [&](FieldReader& root) { read_objects(exhibit, root); });
  return problems;
}

TEST(ExhibitObjects, AreReadWithTheirLabels) {
  Exhibit exhibit = make_tiny_exhibit(dvec3(100, 0, 0));
  const auto problems = read_objects(exhibit, R"({"objects": {
      "plain": {"node": "light"},
      "lamp": {"node": "light", "title": {"en": "Lamp"}, "text": {"en": "It shines."},
               "story": "tale", "at": [1, 2, 3], "manifest": "https://example.org/lamp.json",
               "provenance": {"creator": "A smith", "date": {"en": "today", "de": "heute"}}}}})");
  EXPECT_TRUE(problems.empty()) << to_string(problems.front());
  ASSERT_EQ(exhibit.points.size(), 2u);
  const PointOfInterest& lamp =
      exhibit.points[0].id == "lamp" ? exhibit.points[0] : exhibit.points[1];
  const PointOfInterest& plain = *find_point(exhibit, "plain");
  EXPECT_EQ(lamp.text.at("en"), "It shines.");
  EXPECT_EQ(lamp.story, "tale");
  EXPECT_EQ(lamp.manifest, "https://example.org/lamp.json");
  EXPECT_EQ(lamp.provenance.at("date").at("de"), "heute");
  EXPECT_EQ(lamp.provenance.at("creator").at("en"), "A smith");
  EXPECT_EQ(lamp.place, dvec3(1, 2, 3));
  EXPECT_TRUE(plain.provenance.empty() && plain.story.empty() && plain.manifest.empty());
  EXPECT_LT(glm::length(plain.place - dvec3(100, 3.9, 2)), 1e-5) << "its middle";
}

TEST(ExhibitObjects, WhatIsWrongIsNamed) {
  Exhibit exhibit = make_tiny_exhibit();
  const auto problems = read_objects(exhibit, R"({"objects": {
      "a": {"node": "moon"}, "b": {"node": "light", "story": "saga"},
      "c": {"node": "light", "manifest": "http://example.org/x"},
      "d": {"node": "light", "manifest": "https://example.org/a b"},
      "e": {"node": "light", "provenance": {"maker": "me", "date": 1340}},
      "f": {"node": "light", "price": 3}}})");
  std::string all;
  for (const Problem& problem : problems)
    all += (problem.fatal ? "error: " : "note: ") + to_string(problem) + "\n";
  for (const char* place :
       {"/objects/a/node", "/objects/b/story", "/objects/c/manifest", "/objects/d/manifest",
        "/objects/e/provenance/maker", "/objects/e/provenance/date", "/objects/f/price"})
    EXPECT_NE(all.find(place), std::string::npos) << place << " is not in\n" << all;
  EXPECT_EQ(problems.size(), 7u) << all;
  EXPECT_EQ(std::ranges::count_if(problems, &Problem::fatal), 5) << all;
}

}  // namespace
}  // namespace wellspring::test
