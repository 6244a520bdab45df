// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <map>

#include "../folder.h"
#include "base/load_error.h"
#include "base/rng.h"
#include "las_made.h"
#include "scan/las/las_source.h"

namespace wellspring::test {

class LasPacked : public testing::Test {
 protected:
  void SetUp() override {
    if (scans_folder().empty()) GTEST_SKIP() << "WELLSPRING_DATA has no 10_exhibits/scans";
  }
  static std::string data(const std::string& name) { return (scans_folder() / name).string(); }
  static std::string bytes_of(const std::string& name) {
    std::ifstream in(data(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  // Returns what the refusal of the bytes says; empty: they were read.
  std::string refusal_of(const std::string& bytes) {
    const std::string file = folder_.write("some.laz", bytes);
    try {
      read_all_points(*open_las(file));
    } catch (const LoadError& error) {
      return error.where + ": " + error.what_;
    }
    return "";
  }
  Folder folder_;
};

namespace {

struct Sums {
  uint64_t points = 0;
  std::array<int64_t, 3> places{};
};

Sums sums_of(const std::string& file) {
  LasFile las(file);
  const size_t stride = las.header().record_bytes;
  Sums sums;
  for (auto records = las.records().read(50001); !records.empty();
       records = las.records().read(50001))
    for (size_t at = 0; at < records.size(); at += stride, sums.points++)
      for (size_t i = 0; i < 3; i++) {
        int32_t number;
        std::memcpy(&number, records.data() + at + 4 * i, 4);
        sums.places[i] += number;
      }
  return sums;
}

}  // namespace

TEST_F(LasPacked, gives_the_records_of_the_plain_file) {
  std::map<std::string, std::string> pairs;  // packed to plain
  for (const auto& entry : std::filesystem::recursive_directory_iterator(scans_folder())) {
    std::filesystem::path plain = entry.path();
    plain.replace_extension(".las");
    if (entry.path().extension() == ".laz" && std::filesystem::exists(plain))
      pairs[entry.path().string()] = plain.string();
  }
  for (const char* name :
       {"apps/simple-laszip-compressor-version-1.2r0.laz", "laszip/laszip-generated.laz",
        "laszip/laszip-generated_with2bytespadding.laz", "laszip/liblas-generated.laz"})
    pairs[data("pdal/") + name] = data("pdal/laszip/basefile.las");
  pairs[data("las_laz/extrabytes.laz")] = data("pdal/las/extrabytes.las");
  EXPECT_GE(pairs.size(), 16u);
  for (const auto& [packed, plain] : pairs) {
    const std::vector<uint8_t> wanted = read_all_records(plain, SIZE_MAX);
    EXPECT_GT(wanted.size(), 0u);
    EXPECT_TRUE(read_all_records(packed, 100) == wanted) << packed;
    EXPECT_TRUE(read_all_records(packed, SIZE_MAX) == wanted) << packed;
  }
}

TEST_F(LasPacked, counts_and_sums_are_exact) {
  const auto expect = [](const std::string& name, uint64_t points, int64_t x, int64_t y,
                         int64_t z) {
    const Sums sums = sums_of(data(name));
    EXPECT_EQ(sums.points, points) << name;
    EXPECT_EQ(sums.places, (std::array<int64_t, 3>{x, y, z})) << name;
  };
  expect("lion/lion_takanawa.copc.laz", 341989, -89085042, 136744632, -51691733);
  expect("las_laz/indoor.laz", 808042, -578122750, 237906997, 310258171);
  expect("pdal/laz/autzen_trim.laz", 110000, 7002010454461, 9340603643128, 4733712773);
  expect("ellipsoid/ellipsoid.laz", 100000, -82425960000200, 49666060000000, 0);
  expect("las_laz/ellipsoid-1.4.laz", 100000, -82425960000200, 49666060000000, 0);
  EXPECT_EQ(sums_of(data("ellipsoid/ellipsoid.copc.laz")).points, 100000u);
  EXPECT_EQ(sums_of(data("pdal/copc/1.2-with-color.copc.laz")).points, 1065u);
}

TEST_F(LasPacked, all_points_lie_on_the_ellipsoid) {
  for (const char* name :
       {"ellipsoid/ellipsoid.laz", "ellipsoid/ellipsoid.copc.laz", "las_laz/ellipsoid-1.4.laz"}) {
    const auto source = open_las(data(name));
    const dvec3 centre = (source->info().low + source->info().high) / 2.0;
    const PointBlock points = read_all_points(*source, 33333);
    EXPECT_EQ(points.size(), 100000u);
    EXPECT_EQ(points.color.size(), 100000u);
    double worst = 0;
    for (const dvec3& place : points.place) {
      const dvec3 d = (place - centre) / dvec3(150, 100, 50);
      worst = std::max(worst, std::abs(dot(d, d) - 1));
    }
    EXPECT_LT(worst, 0.001) << name;
  }
}

TEST_F(LasPacked, every_file_has_as_many_points_as_it_promises) {
  for (const char* top : {"lion", "las_laz", "pdal/las", "pdal/laszip", "pdal/apps"})
    for (const auto& entry : std::filesystem::recursive_directory_iterator(scans_folder() / top)) {
      const std::string kind = entry.path().extension();
      if ((kind != ".las" && kind != ".laz") || entry.path().stem() == "1.2-no-points") continue;
      const auto source = open_las(entry.path());
      EXPECT_EQ(read_all_points(*source, 10000).size(), source->info().points) << entry.path();
    }
}

TEST_F(LasPacked, bad_files_are_read_with_a_word_or_refused) {
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(scans_folder() / "pdal/bad")) {
    if (entry.path().extension() != ".las") continue;
    files++;
    const auto source = open_las(entry.path());
    read_all_points(*source);
    EXPECT_FALSE(source->info().notices.empty()) << entry.path();
  }
  EXPECT_EQ(files, 5);
  const auto short_one = open_las(data("pdal/bad/garbage_nVariableLength.las"));
  EXPECT_EQ(read_all_points(*short_one).size(), 718u);
}

TEST_F(LasPacked, says_what_it_is) {
  const ScanInfo lion = open_las(data("lion/lion_takanawa.copc.laz"))->info();
  EXPECT_EQ(lion.format, "COPC 1.4, point format 7");
  EXPECT_NEAR(lion.low.x, -4.99, 0.01);
  EXPECT_NEAR(lion.high.y, 6.72, 0.01);
  EXPECT_EQ(open_las(data("las_laz/indoor.laz"))->info().format, "LAZ 1.2, point format 3");
  EXPECT_EQ(open_las(data("pdal/laz/autzen_trim.laz"))->info().unit, 0.3048);
  EXPECT_EQ(open_las(data("pdal/las/epsg_4326.las"))->info().notices.size(), 1u);
}

TEST_F(LasPacked, colour_of_8_bits_stays_as_it_is) {
  const auto source = open_las(data("pdal/laszip/laszip-generated.laz"));
  const PointBlock points = read_all_points(*source);
  uint16_t largest = 0;
  for (const auto& color : points.color)
    largest = std::max({largest, color[0], color[1], color[2]});
  EXPECT_GT(largest, 200);
  EXPECT_LT(largest, 256);
  EXPECT_EQ(source->info().color_max, 0);
}

TEST_F(LasPacked, a_chunk_that_is_cut_off_is_refused) {
  for (const char* name : {"lion/r.laz", "las_laz/pdrf7-v4-1.4.laz",
                           "pdal/apps/simple-laszip-compressor-version-1.2r0.laz"}) {
    const std::string bytes = bytes_of(name);
    for (const size_t size : {bytes.size() / 2, bytes.size() - 30, bytes.size() * 3 / 4})
      EXPECT_NE(refusal_of(bytes.substr(0, size)), "") << name << " " << size;
  }
}

TEST_F(LasPacked, a_damaged_table_of_chunks_is_refused) {
  std::string bytes = bytes_of("las_laz/pdrf6-1.4.laz");
  const size_t begin = 1297;
  uint64_t table;
  std::memcpy(&table, bytes.data() + begin, 8);
  const auto refusal = [&](size_t at, auto value) {
    std::string changed = bytes;
    put_at(changed, at, value);
    return refusal_of(changed);
  };
  EXPECT_EQ(refusal_of(bytes), "");
  EXPECT_NE(refusal(begin, uint64_t(1) << 60).find("lies outside"), std::string::npos);
  EXPECT_NE(refusal(begin, uint64_t(begin)).find("never written"), std::string::npos);
  EXPECT_NE(refusal(table, uint32_t(7)).find("version 7"), std::string::npos);
  EXPECT_NE(refusal(table + 4, UINT32_MAX).find("promises 4294967295 chunks"), std::string::npos);
  EXPECT_NE(refusal(table + 8, uint32_t(0xf0f0f0f0)), "");
  // Its place may also stand at the end, as who writes to a pipe leaves it.
  std::string piped = bytes + std::string(8, '\0');
  put_at(piped, begin, UINT64_MAX);
  put_at(piped, piped.size() - 8, table);
  EXPECT_EQ(refusal_of(piped), "");
}

TEST_F(LasPacked, a_chunk_with_wrong_sizes_is_refused) {
  const std::string bytes = bytes_of("las_laz/pdrf6-1.4.laz");
  const size_t count = 1297 + 8 + 34;  // behind the first point of the first chunk
  const auto refusal = [&](size_t at, uint32_t value) {
    std::string changed = bytes;
    put_at(changed, at, value);
    return refusal_of(changed);
  };
  EXPECT_NE(refusal(count, 255).find("holds 255 points, and should hold 256"), std::string::npos);
  EXPECT_NE(refusal(count + 4, UINT32_MAX).find("a layer has 4294967295 bytes"), std::string::npos);
  EXPECT_NE(refusal(count + 4, 10), "");
}

TEST_F(LasPacked, promised_points_are_never_more_than_there_are) {
  std::string bytes = bytes_of("las_laz/pdrf6-1.4.laz");
  put_at(bytes, 247, uint64_t(1) << 62);
  const std::string file = folder_.write("many.laz", bytes);
  const auto source = open_las(file);
  EXPECT_EQ(read_all_points(*source).size(), 1024u);
  EXPECT_EQ(source->info().notices.size(), 1u);
  put_at(bytes, 247, uint64_t(300));
  EXPECT_EQ(read_all_points(*open_las(folder_.write("few.laz", bytes))).size(), 300u);
}

TEST_F(LasPacked, changed_bytes_give_points_or_a_refusal) {
  Rng random(7);
  int refused = 0, read = 0;
  for (const char* name :
       {"las_laz/pdrf10-1.5.laz", "las_laz/pdrf5-1.3.laz", "pdal/copc/1.2-with-color.copc.laz",
        "las_laz/pdrf8-1.4.laz", "pdal/apps/simple-laszip-compressor-version-1.2r0.laz",
        "pdal/apps/simple.laz", "pdal/las/interesting.las"}) {
    const std::string good = bytes_of(name);
    for (int i = 0; i < 40; i++) {
      std::string bytes = good;
      // Half of the changes hit the header and what follows it.
      const size_t range = i % 2 == 0 ? bytes.size() : std::min<size_t>(bytes.size(), 1600);
      for (int change = 0; change < 3; change++) bytes[random.next() % range] = char(random.next());
      try {
        const auto source = open_las(folder_.write("some.laz", bytes));
        PointBlock block;
        uint64_t points = 0;
        while (points < 20000 && source->read(block, 5000)) points += block.size();
        read++;
      } catch (const LoadError&) {
        refused++;
      }
    }
  }
  EXPECT_EQ(refused + read, 7 * 40);
  EXPECT_GT(refused, 30);
  EXPECT_GT(read, 30);
}

}  // namespace wellspring::test
