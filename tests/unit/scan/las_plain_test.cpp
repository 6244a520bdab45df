// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <gtest/gtest.h>
#include <limits>

#include "../folder.h"
#include "base/load_error.h"
#include "las_made.h"
#include "scan/las/las_source.h"

namespace wellspring::test {
namespace {

MadeLas three_points(int minor, int format) {
  MadeLas made;
  made.minor = minor, made.format = format;
  made.places = {{1, 2, 3}, {-100, 200, -300}, {INT32_MAX, INT32_MIN, 0}};
  return made;
}

// Returns the place and the reason of the refusal; empty: it was read.
std::string refusal_of(const Folder& folder, const std::string& bytes) {
  const std::string file = folder.write("some.las", bytes);
  try {
    const auto source = open_las(file);
    read_all_points(*source);
  } catch (const LoadError& error) {
    EXPECT_EQ(error.file, file);
    return error.where + ": " + error.what_;
  }
  return "";
}

ScanInfo info_of(const Folder& folder, const std::string& bytes) {
  return open_las(folder.write("some.las", bytes))->info();
}

}  // namespace

TEST(LasPlain, reads_all_versions_and_formats) {
  const Folder folder;
  for (int minor = 0; minor <= 5; minor++)
    for (int format = 0; format <= 10; format++) {
      SCOPED_TRACE(testing::Message() << "1." << minor << " format " << format);
      MadeLas made = three_points(minor, format);
      made.extra_bytes = size_t(format);
      const auto source = open_las(folder.write("some.las", made.bytes()));
      EXPECT_EQ(source->info().points, 3u);
      EXPECT_TRUE(source->info().is_counted);
      EXPECT_TRUE(source->info().notices.empty());
      const PointBlock points = read_all_points(*source, 2);
      ASSERT_EQ(points.size(), 3u);
      EXPECT_EQ(points.place[1], dvec3(-100 * 0.01, 200 * 0.01, -300 * 0.01));
      EXPECT_EQ(points.place[2].x, INT32_MAX * 0.01);
      EXPECT_EQ(points.intensity, (std::vector<uint16_t>{1000, 1001, 1002}));
      EXPECT_EQ(points.classification, (std::vector<uint8_t>{0, 1, 2}));
      const bool has_time = format == 1 || format >= 3;
      EXPECT_EQ(source->info().fields.time, has_time);
      EXPECT_EQ(points.time,
                has_time ? (std::vector<double>{0.5, 1.5, 2.5}) : std::vector<double>());
      const bool has_color =
          format == 2 || format == 3 || format == 5 || format == 7 || format == 8 || format == 10;
      EXPECT_EQ(source->info().fields.color, has_color);
      ASSERT_EQ(points.color.size(), has_color ? 3u : 0u);
      if (has_color) {
        EXPECT_EQ(points.color[2], (std::array<uint16_t, 3>{2, 4, 6}));
      }
      EXPECT_EQ(source->info().color_max, 0);
    }
}

TEST(LasPlain, old_formats_hold_a_class_in_five_bits) {
  const Folder folder;
  for (const int format : {3, 6}) {
    const MadeLas made = three_points(4, format);
    std::string bytes = made.bytes();
    bytes[made.points_begin() + (format == 6 ? 16 : 15)] = char(0xe6);
    const auto source = open_las(folder.write("some.las", bytes));
    EXPECT_EQ(read_all_points(*source).classification[0], format == 6 ? 0xe6 : 6);
  }
}

TEST(LasPlain, large_coordinates_keep_their_digits) {
  const Folder folder;
  MadeLas made = three_points(2, 0);
  made.scale = dvec3(0.001), made.offset = {4e6, 12345678.5, -1e7};
  const auto source = open_las(folder.write("some.las", made.bytes()));
  const PointBlock points = read_all_points(*source);
  EXPECT_NEAR(points.place[1].x, 4e6 - 0.1, 1e-8);
  EXPECT_NEAR(points.place[1].y, 12345678.7, 1e-8);
  EXPECT_NEAR(points.place[1].z, -10000000.3, 1e-8);
  made.scale = dvec3(1), made.offset = dvec3(0);
  const auto whole = open_las(folder.write("whole.las", made.bytes()));
  EXPECT_EQ(read_all_points(*whole).place[2], dvec3(2147483647, -2147483648.0, 0));
}

TEST(LasPlain, reads_what_is_there_of_lying_counts) {
  const Folder folder;
  const MadeLas made = three_points(2, 0);
  std::string bytes = made.bytes();
  put_at(bytes, 107, uint32_t(4));
  put_at(bytes, 100, uint32_t(1069128089));
  const auto source = open_las(folder.write("some.las", bytes + "half a point"));
  EXPECT_EQ(read_all_points(*source).size(), 3u);
  ASSERT_EQ(source->info().notices.size(), 2u);
  EXPECT_NE(source->info().notices[0].find("1069128089 records"), std::string::npos);
  EXPECT_NE(source->info().notices[1].find("4 points, of which 3"), std::string::npos);
  put_at(bytes, 107, uint32_t(0xffffffff));
  EXPECT_EQ(read_all_points(*open_las(folder.write("more.las", bytes))).size(), 3u);
}

TEST(LasPlain, reads_what_is_there_of_lying_late_records) {
  const Folder folder;
  std::string bytes = three_points(4, 6).bytes();
  put_at(bytes, 235, uint64_t(INT64_MAX));
  put_at(bytes, 243, uint32_t(3));
  EXPECT_EQ(info_of(folder, bytes).notices.size(), 1u);
  put_at(bytes, 235, uint64_t(bytes.size()));
  bytes += std::string(60, '\0');
  put_at(bytes, bytes.size() - 40, UINT64_MAX);
  EXPECT_EQ(info_of(folder, bytes).notices.size(), 1u);
}

TEST(LasPlain, may_have_no_points) {
  const Folder folder;
  MadeLas made;
  const auto source = open_las(folder.write("some.las", made.bytes()));
  EXPECT_EQ(source->info().points, 0u);
  PointBlock block;
  EXPECT_FALSE(source->read(block, 10));
  std::string bytes = made.bytes();
  put_at(bytes, 107, uint32_t(1065));
  const auto liar = open_las(folder.write("liar.las", bytes));
  EXPECT_FALSE(liar->read(block, 10));
  EXPECT_EQ(liar->info().notices.size(), 1u);
}

TEST(LasPlain, a_time_that_is_no_number_becomes_zero) {
  const Folder folder;
  const MadeLas made = three_points(2, 1);
  std::string bytes = made.bytes();
  for (size_t i : {0, 2})
    put_at(bytes, made.points_begin() + i * made.record_bytes() + 20,
           std::numeric_limits<double>::quiet_NaN());
  const auto source = open_las(folder.write("some.las", bytes));
  EXPECT_EQ(read_all_points(*source).time, (std::vector<double>{0, 1.5, 0}));
  EXPECT_EQ(source->info().notices.size(), 1u);
}

TEST(LasPlain, points_that_overflow_are_left_out) {
  const Folder folder;
  MadeLas made = three_points(2, 0);
  made.scale = {1e305, 1, 1};
  const auto source = open_las(folder.write("some.las", made.bytes()));
  EXPECT_EQ(read_all_points(*source, 1).size(), 2u);
  EXPECT_EQ(source->dropped(), 1u);
}

TEST(LasPlain, bounds_that_make_no_sense_are_none) {
  const Folder folder;
  std::string bytes = three_points(2, 0).bytes();
  for (size_t i = 0; i < 3; i++) {
    put_at(bytes, 179 + 16 * i, 2.0 + double(i));
    put_at(bytes, 187 + 16 * i, -1.0);
  }
  EXPECT_TRUE(info_of(folder, bytes).is_bounded);
  EXPECT_EQ(info_of(folder, bytes).high, dvec3(2, 3, 4));
  EXPECT_EQ(info_of(folder, bytes).low, dvec3(-1));
  put_at(bytes, 195, std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(info_of(folder, bytes).is_bounded);
}

TEST(LasPlain, wrong_headers_are_refused_by_place) {
  const Folder folder;
  const std::string good = three_points(2, 3).bytes();
  const auto refusal = [&](size_t at, auto value) {
    std::string bytes = good;
    put_at(bytes, at, value);
    return refusal_of(folder, bytes);
  };
  EXPECT_EQ(refusal_of(folder, good), "");
  EXPECT_EQ(refusal_of(folder, "LAS"), "byte 0: is no LAS file: it does not begin with LASF");
  EXPECT_EQ(refusal_of(folder, good.substr(0, 200)),
            "byte 200: ends within the header, which has 227 bytes");
  EXPECT_EQ(refusal(25, uint8_t(6)), "byte 24: is LAS 1.6, which is not known");
  EXPECT_EQ(refusal(94, uint16_t(20)), "byte 94: says that the header has 20 bytes");
  EXPECT_EQ(refusal(96, uint32_t(1000000)), "byte 96: says that points begin at byte 1000000");
  EXPECT_EQ(refusal(104, uint8_t(11)), "byte 104: has points of format 11");
  EXPECT_EQ(refusal(105, uint16_t(33)), "byte 105: gives points of format 3 33 bytes");
  EXPECT_EQ(refusal(131, 0.0), "byte 131: has the scale 0 along x");
  EXPECT_EQ(refusal(139, std::nan("")), "byte 131: has the scale nan along y");
  EXPECT_EQ(refusal(171, double(INFINITY)), "byte 155: has the offset inf along z");
  EXPECT_EQ(refusal(104, uint8_t(131)), ": is packed, but has no record of LASzip");
  EXPECT_THROW(open_las(folder.file("absent.las")), LoadError);
  EXPECT_THROW(open_las(folder.path.string()), LoadError);
}

TEST(LasPlain, knows_metres_and_two_feet) {
  const Folder folder;
  const auto unit_of_record = [&](int id, const std::string& content, size_t notices) {
    MadeLas made = three_points(2, 0);
    made.records = {{id, content}};
    const ScanInfo info = info_of(folder, made.bytes());
    EXPECT_EQ(info.notices.size(), notices) << content;
    return info.unit;
  };
  const auto wkt = [](const std::string& unit) {
    return "PROJCS[\"a\",GEOGCS[\"b\",UNIT[\"degree\",0.0174532925199433]],PROJECTION[\"c\"]," +
           unit + "]";
  };
  EXPECT_EQ(unit_of_record(2112, wkt("UNIT[\"metre\",1]"), 0), 1);
  EXPECT_EQ(unit_of_record(2112, wkt("UNIT[\"foot\",0.3048]"), 0), 0.3048);
  EXPECT_EQ(unit_of_record(2112, wkt("UNIT[\"US survey foot\", 0.3048006096012192]"), 0),
            1200.0 / 3937);
  EXPECT_EQ(unit_of_record(2112, wkt("UNIT[\"chain\",20.1168]"), 1), 1);
  EXPECT_EQ(unit_of_record(2112, "GEOGCS[\"b\",UNIT[\"degree\",0.0174532925199433]]", 1), 1);
  EXPECT_EQ(unit_of_record(2112, wkt("UNIT[\"never ends"), 0), 1);
  const auto keys = [](std::vector<uint16_t> numbers) {
    return std::string(reinterpret_cast<const char*>(numbers.data()), 2 * numbers.size());
  };
  EXPECT_EQ(unit_of_record(34735, keys({1, 1, 0, 1, 3076, 0, 1, 9002}), 0), 0.3048);
  EXPECT_EQ(unit_of_record(34735, keys({1, 1, 0, 1, 3076, 0, 1, 9003}), 0), 1200.0 / 3937);
  EXPECT_EQ(unit_of_record(34735, keys({1, 1, 0, 1, 3076, 0, 1, 9001}), 0), 1);
  EXPECT_EQ(unit_of_record(34735, keys({1, 1, 0, 1, 1024, 0, 1, 2}), 1), 1);
  EXPECT_EQ(unit_of_record(34735, keys({1, 1, 0, 9999, 3076, 0, 1, 9002}), 0), 0.3048);
  EXPECT_EQ(unit_of_record(34735, "", 0), 1);
}

}  // namespace wellspring::test
