// SPDX-License-Identifier: Apache-2.0
#include "volume/compressed/codebook.h"

#include <gtest/gtest.h>

#include <oneapi/tbb/global_control.h>

#include "base/rng.h"

namespace wellspring::test {
namespace {

std::vector<float> random_rows(int count, int dimensions, uint64_t seed, float scale = 100) {
  Rng random(seed);
  std::vector<float> rows(size_t(count) * size_t(dimensions));
  for (float& x : rows) x = scale * random.uniform();
  return rows;
}

double mean_error(const std::vector<float>& rows, int dimensions, std::vector<float> vectors) {
  const Codebook codebook = make_codebook(dimensions, std::move(vectors));
  const size_t width = size_t(dimensions);
  std::vector<int> nearest(rows.size() / width);
  find_nearest(nearest, codebook, rows.data());
  double sum = 0;
  for (size_t i = 0; i < nearest.size(); i++)
    sum += squared_distance(&rows[i * width], &codebook.vectors[size_t(nearest[i]) * width],
                            dimensions);
  return sum / double(nearest.size());
}

TEST(CompressedCodebook, TheNearestCodevectorIsFound) {
  constexpr int dimensions = 64;
  const std::vector<float> rows = random_rows(101, dimensions, 1);
  const Codebook codebook = make_codebook(dimensions, random_rows(37, dimensions, 2));
  std::vector<int> nearest(101);
  find_nearest(nearest, codebook, rows.data());
  for (size_t i = 0; i < nearest.size(); i++) {
    const float* row = &rows[i * dimensions];
    const double found =
        squared_distance(row, &codebook.vectors[size_t(nearest[i]) * dimensions], dimensions);
    for (size_t k = 0; k < 37; k++)
      EXPECT_LE(found,
                squared_distance(row, &codebook.vectors[k * dimensions], dimensions) * 1.00001);
  }
}

TEST(CompressedCodebook, ARowAmongVeryLargeNumbersFindsItself) {
  constexpr int dimensions = 64;
  std::vector<float> rows;
  for (int i = 0; i < 50; i++)  // neighbours differ by 1 in one of 64 numbers
    for (int d = 0; d < dimensions; d++) rows.push_back(float(65000 + (d == i ? 1 : 0)));
  std::vector<int> nearest(50);
  find_nearest(nearest, make_codebook(dimensions, rows), rows.data());
  for (int i = 0; i < 50; i++) EXPECT_EQ(nearest[size_t(i)], i);
}

TEST(CompressedCodebook, OfEquallyNearCodevectorsTheFirstIsTaken) {
  std::vector<float> vectors(40 * 64, 3);
  const std::vector<float> rows(64, 3);
  std::vector<int> nearest(1);
  find_nearest(nearest, make_codebook(64, vectors), rows.data());
  EXPECT_EQ(nearest[0], 0);
}

TEST(CompressedCodebook, TrainingLessensTheError) {
  const std::vector<float> rows = random_rows(2000, 64, 3);
  TrainingSettings settings;
  settings.codevectors = 50;
  settings.most_rounds = 0;
  const double seeds = mean_error(rows, 64, train_codebook(rows, 64, settings));
  settings.most_rounds = 8;
  const double trained = mean_error(rows, 64, train_codebook(rows, 64, settings));
  EXPECT_LT(trained, 0.75 * seeds);
}

TEST(CompressedCodebook, EveryClusterIsFoundThoughSeedsAreUneven) {
  // A thousand rows of slight noise and nine that lie apart: seeds at random miss most of these.
  std::vector<float> rows = random_rows(1000, 64, 4, 0.1f);
  for (int far = 1; far <= 9; far++)
    for (int d = 0; d < 64; d++) rows.push_back(d == far ? 1000.f : 0.f);
  TrainingSettings settings;
  settings.codevectors = 40;
  settings.most_rounds = 20;
  settings.least_gain = 0;
  EXPECT_LT(mean_error(rows, 64, train_codebook(rows, 64, settings)), 1000);
}

TEST(CompressedCodebook, TheFirstCodevectorIsKept) {
  TrainingSettings settings;
  settings.codevectors = 8;
  settings.first.assign(64, -77);
  const std::vector<float> vectors = train_codebook(random_rows(500, 64, 5), 64, settings);
  EXPECT_EQ(vectors.size(), 8u * 64);
  EXPECT_EQ(std::vector<float>(vectors.begin(), vectors.begin() + 64), settings.first);
}

TEST(CompressedCodebook, RowsThatAreFewerThanCodevectorsAreKeptOnce) {
  std::vector<float> rows = random_rows(5, 64, 6);
  rows.insert(rows.end(), rows.begin(), rows.end());
  const std::vector<float> vectors = train_codebook(rows, 64, {});
  EXPECT_EQ(vectors.size(), 5u * 64);
  EXPECT_EQ(mean_error(rows, 64, vectors), 0);
  EXPECT_EQ(train_codebook({}, 64, {}), std::vector<float>(64, 0));
}

TEST(CompressedCodebook, TrainingDependsOnTheSeedAloneNotOnThreads) {
  const std::vector<float> rows = random_rows(3000, 64, 7);
  TrainingSettings settings;
  settings.codevectors = 64;
  const std::vector<float> many = train_codebook(rows, 64, settings);
  {
    const oneapi::tbb::global_control one(oneapi::tbb::global_control::max_allowed_parallelism, 1);
    EXPECT_EQ(train_codebook(rows, 64, settings), many);
  }
  settings.seed = 2;
  EXPECT_NE(train_codebook(rows, 64, settings), many);
}

}  // namespace
}  // namespace wellspring::test
