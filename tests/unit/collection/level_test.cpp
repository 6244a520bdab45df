// SPDX-License-Identifier: Apache-2.0
#include "collection/level.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "base/rng.h"
#include "collection/earth_mover.h"
#include "collection/read/read_records.h"
#include "unit/collection/mixture.h"

namespace wellspring::test {
namespace {

// Makes a collection of groups within groups: 6 schools, of which each has 6 workshops with
// subjects of their own.
Collection make_groups(int count) {
  Records records;
  for (int i = 0; i < 6 + 36 * 4; i++)
    records.terms.push_back({TermKind::subject, "t" + std::to_string(i)});
  Rng random(4);
  for (int i = 0; i < count; i++) {
    const uint32_t school = random.next() % 6, workshop = random.next() % 6;
    Record record;
    record.id = std::to_string(i);
    record.year = 1400 + 80 * double(school) + 10 * double(workshop) + 8 * double(random.uniform());
    record.terms.push_back(school);
    for (uint32_t k = 0; k < 4; k++)
      if (random.next() % 4) record.terms.push_back(6 + (school * 6 + workshop) * 4 + k);
    record.palette = {{dvec3(50, 10 * double(school), 40 * double(random.uniform())), 1}};
    records.all.push_back(record);
  }
  return make_collection(std::move(records));
}

// Returns the step of a circle that holds a third of the map around the item nearest its middle.
MapStep circle_around(const MapLevel& level, const dvec2& middle, double share) {
  size_t pivot = 0;
  auto far = [&](size_t i, const dvec2& from) {
    return glm::distance(level.layout.places[i], from);
  };
  for (size_t i = 0; i < level.shown.size(); i++)
    if (far(i, middle) < far(pivot, middle)) pivot = i;
  std::vector<double> radii;
  for (size_t i = 0; i < level.shown.size(); i++)
    radii.push_back(far(i, level.layout.places[pivot]));
  std::ranges::sort(radii);
  return {level.shown[pivot], radii[size_t(share * double(radii.size() - 1))], {}};
}

TEST(Level, ACircleGoesOnAmongAllObjects) {
  const Collection collection = make_groups(3000);
  const MapChoice choice{.most_shown = 300};
  const MapLevel first = make_first_level(collection, choice);
  EXPECT_EQ(first.region.size(), 3000u);
  EXPECT_EQ(first.shown.size(), 300u);
  EXPECT_TRUE(std::ranges::is_sorted(first.shown));
  const MapStep step = circle_around(first, first.layout.places[10], 0.1);
  const auto next = take_step(collection, first, step, choice);
  ASSERT_TRUE(next);
  EXPECT_GT(next->region.size(), 30u);  // more than the map had shown of it
  EXPECT_TRUE(std::ranges::binary_search(next->shown, step.pivot));
  // Exactly those within the ball.
  std::vector<int> truth;
  for (int i = 0; i < 3000; i++)
    if (earth_mover(collection.sets[step.pivot], collection.sets[i], collection.sets.dims()) <=
        next->ball)
      truth.push_back(i);
  EXPECT_EQ(next->region, truth);
  // The same steps lead to the same map, so back needs no memory.
  EXPECT_EQ(take_step(collection, first, step, choice)->layout.places, next->layout.places);
}

TEST(Level, ClustersAreFilters) {
  const Collection collection = make_groups(2000);
  const MapChoice choice{.most_shown = 300};
  const MapLevel first = make_first_level(collection, choice);
  ASSERT_GE(first.natures.size(), 3u);
  int count = 0;
  for (const ClusterNature& nature : first.natures) {
    EXPECT_FALSE(nature.terms.empty());
    EXPECT_LE(*nature.first, *nature.last);
    count += nature.count;
  }
  EXPECT_EQ(count, 300);
  const auto chosen = take_step(collection, first, {-1, 0, {1}}, choice);
  ASSERT_TRUE(chosen);
  EXPECT_LT(chosen->region.size(), 1500u);
  for (size_t i = 0; i < first.shown.size(); i++)
    EXPECT_EQ(std::ranges::binary_search(chosen->region, first.shown[i]),
              first.clusters.of[i] == 1);
  // A circle on that map holds none of another cluster.
  const auto within = take_step(collection, *chosen, circle_around(*chosen, dvec2(0), 0.9), choice);
  ASSERT_TRUE(within);
  EXPECT_TRUE(std::ranges::includes(chosen->region, within->region));
}

TEST(Level, StepsThatTheMapDoesNotHaveAreRefused) {
  const Collection collection = make_groups(500);
  const MapLevel level = make_first_level(collection, {.most_shown = 100});
  int hidden = 0;
  while (std::ranges::binary_search(level.shown, hidden)) hidden++;
  EXPECT_FALSE(take_step(collection, level, {hidden, 1, {}}));
  EXPECT_FALSE(take_step(collection, level, {level.shown[0], NAN, {}}));
  EXPECT_FALSE(take_step(collection, level, {-1, 0, {99}}));
  EXPECT_FALSE(take_step(collection, level, {-1, 0, {}}));
}

TEST(Level, HardCollectionsHaveMaps) {
  for (const int count : {1, 2, 5}) {
    const Collection few = make_groups(count);
    const MapLevel level = make_first_level(few);
    EXPECT_EQ(int(level.shown.size()), count);
    EXPECT_TRUE(take_step(few, level, {level.shown[0], 100, {}}));
  }
  Records records;
  records.terms.push_back({TermKind::subject, "same"});
  for (int i = 0; i < 200; i++) {
    Record record;
    record.id = std::to_string(i);
    if (i % 2) record.year = 1900;
    record.terms = {0};
    records.all.push_back(record);
  }
  const Collection equal = make_collection(std::move(records));
  const MapLevel level = make_first_level(equal);
  EXPECT_EQ(level.layout.stress, 0);
  EXPECT_EQ(level.natures.size(), 1u);
  EXPECT_EQ(take_step(equal, level, {0, 0, {}})->region.size(), 200u);

  Records bare;  // nothing is told of them
  for (int i = 0; i < 10; i++) bare.all.emplace_back();
  EXPECT_EQ(make_first_level(make_collection(std::move(bare))).shown.size(), 10u);
}

TEST(Level, AFewVeryOldObjectsDoNotPressTheOthersTogether) {
  auto spread = [](double oldest) {
    Records records;
    records.terms = {{TermKind::material, "wood"}, {TermKind::material, "stone"}};
    for (int i = 0; i < 200; i++) {
      Record& record = records.all.emplace_back();
      record.year = i < 2 ? oldest : 1500 + i;
      record.terms = {uint32_t(i % 2)};
    }
    const MapLevel level = make_first_level(make_collection(std::move(records)));
    double sum = 0, most = 0;
    for (const dvec2& place : level.layout.places) {
      sum += glm::length(place);
      most = std::max(most, glm::length(place));
    }
    return sum / double(level.shown.size()) / most;
  };
  EXPECT_NEAR(spread(-40'000), spread(-4'000'000), 1e-9);
  EXPECT_GT(spread(-40'000), 0.2);
}

TEST(Level, TrailsAreRead) {
  const auto trail = read_trail("12@0.35;c0,2;7@1e-3");
  ASSERT_TRUE(trail);
  ASSERT_EQ(trail->size(), 3u);
  EXPECT_EQ((*trail)[0].pivot, 12);
  EXPECT_EQ((*trail)[0].radius, 0.35);
  EXPECT_EQ((*trail)[1].clusters, (std::vector<int>{0, 2}));
  EXPECT_EQ((*trail)[2].radius, 0.001);
  EXPECT_TRUE(read_trail("")->empty());
  for (const char* text : {";", "12", "12@", "12@x", "c", "c1,", "12@1;", "-1@1", "1@-1", "1@nan",
                           "12@1 ", "99999999999@1", "c1c2"})
    EXPECT_FALSE(read_trail(text)) << text;
  std::string many = "1@1";
  for (size_t i = 0; i < most_steps; i++) many += ";1@1";
  EXPECT_FALSE(read_trail(many));
}

// Tate's records, which are read as they were published.
std::string tate_file() {
  const std::string file = WELLSPRING_DATA "/10_exhibits/collection/tate/artworks.jsonl";
  return std::filesystem::exists(file) ? file : "";
}

TEST(Level, TatesRecordsAreReadAsPublished) {
  if (tate_file().empty()) GTEST_SKIP() << "Tate's records are not here";
  const Records records = read_records(tate_file());
  EXPECT_EQ(records.all.size(), 2000u);
  int dated = 0, with_terms = 0;
  for (const Record& record : records.all)
    dated += record.year.has_value(), with_terms += !record.terms.empty();
  EXPECT_GE(dated, 1802);
  EXPECT_GE(with_terms, 1953);
  const Records published =
      read_records(std::filesystem::path(tate_file()).parent_path() / "as_published");
  EXPECT_EQ(published.all.size(), 40u);
  for (const Record& record : published.all) {
    const auto same = std::ranges::find(records.all, record.id, &Record::id);
    if (same == records.all.end()) continue;
    EXPECT_EQ(same->title, record.title);
    EXPECT_EQ(same->year, record.year);
    EXPECT_EQ(same->terms.size(), record.terms.size());
  }
}

// The paper's shape: 0.46, 0.34, 0.28.
TEST(Level, StressFallsFromMapToMapOfGroupsWithinGroups) {
  const Collection collection = make_mixture(6000);
  const MapChoice choice{.most_shown = 300};
  MapLevel level = make_first_level(collection, choice);
  double before = level.layout.stress;
  for (int depth = 0; depth < 2; depth++) {
    auto next = take_step(collection, level, circle_where_most_are(level, 0.25), choice);
    ASSERT_TRUE(next);
    EXPECT_LT(next->layout.stress, before - 0.05);
    before = next->layout.stress;
    level = std::move(*next);
  }
}

}  // namespace
}  // namespace wellspring::test
