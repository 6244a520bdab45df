// SPDX-License-Identifier: Apache-2.0
#include "volume/format/nrrd.h"

#include <gtest/gtest.h>

#include "unit/volume/format/volume_files.h"

namespace wellspring::test {
namespace {

const std::string small_nrrd =
    "NRRD0004\n# a comment\ntype: uchar\ndimension: 3\nsizes: 2 2 1\nencoding: raw\n"
    "sample:=for other programs\n";

void expect_place(const Volume& volume, glm::dvec3 index, glm::dvec3 wanted) {
  const glm::dvec3 place = place_of(volume, index);
  for (int i = 0; i < 3; i++) EXPECT_NEAR(place[i], wanted[i], 1e-9) << "axis " << i;
}

TEST(Nrrd, ReadsSamplesBehindTheHeaderAndBesideIt) {
  const Folder folder;
  const std::vector<double> wanted{'a', 'b', 'c', 'd'};
  EXPECT_EQ(values_of(open_volume(folder.write("a.nrrd", small_nrrd + "\nabcd"))), wanted);
  EXPECT_EQ(values_of(open_volume(folder.write("b.nrrd",
                                               [&] {
                                                 std::string windows;
                                                 for (const char letter : small_nrrd + "\n")
                                                   windows += letter == '\n'
                                                                  ? "\r\n"
                                                                  : std::string(1, letter);
                                                 return windows + "abcd";
                                               }()))),
            wanted);
  folder.write("c.raw", "abcd");
  EXPECT_EQ(values_of(open_volume(folder.write("c.nhdr", small_nrrd + "data file: c.raw\n"))),
            wanted);
  std::string packed = small_nrrd;
  packed.replace(packed.find("raw"), 3, "gzip");
  EXPECT_EQ(values_of(open_volume(folder.write("d.nrrd", packed + "\n" + pack("abcd")))), wanted);
  folder.write("e.raw.gz", pack("..abcd"));
  EXPECT_EQ(values_of(open_volume(
                folder.write("e.nhdr", packed + "data file: e.raw.gz\nbyte skip: 2\n\n"))),
            wanted);
}

TEST(Nrrd, SkipsLinesAndBytesAndCountsFromTheEnd) {
  const Folder folder;
  const std::vector<double> wanted{'a', 'b', 'c', 'd'};
  const auto read = [&](const std::string& bytes, const std::string& skips) {
    folder.write("a.raw", bytes);
    return values_of(
        open_volume(folder.write("a.nhdr", small_nrrd + "data file: a.raw\n" + skips)));
  };
  EXPECT_EQ(read("one\ntwo\n...abcd", "line skip: 2\nbyte skip: 3\n"), wanted);
  EXPECT_EQ(read("any header abcd", "byte skip: -1\n"), wanted);
  EXPECT_EQ(read("any header abcd..", "byteskip: -3\n"), wanted);
  folder.write("a.raw", "abc");
  EXPECT_NE(refusal(folder.file("a.nhdr")).find("is cut off: it has 3 bytes"), std::string::npos);
  EXPECT_NE(refusal(folder.write("b.nhdr", small_nrrd + "data file: a.raw\nline skip: 9\n"))
                .find("fewer lines"),
            std::string::npos);
}

TEST(Nrrd, FilesOfSlicesHaveNumbersOrAreListed) {
  const Folder folder;
  const std::string header =
      "NRRD0005\ntype: unsigned short\ndimension: 3\nsizes: 1 2 3\nencoding: raw\nendian: big\n";
  for (int i = 0; i < 3; i++)
    folder.write("s." + std::string(i < 1 ? "09" : "1" + std::to_string(i - 1)),
                 samples_of<uint16_t>({uint16_t(i * 256), uint16_t(i * 256 + 1)}, true));
  const std::vector<double> wanted{0, 1, 256, 257, 512, 513};
  EXPECT_EQ(values_of(open_volume(folder.write("a.nhdr", header + "data file: s.%02d 9 11 1\n"))),
            wanted);
  EXPECT_EQ(
      values_of(open_volume(folder.write("b.nhdr", header + "data file: s.%02d 11 9 -1 2\n"))),
      (std::vector<double>{512, 513, 256, 257, 0, 1}));
  const std::string listed = folder.write("c.nhdr", header + "data file: LIST\ns.09\ns.10\ns.11\n");
  EXPECT_EQ(values_of(open_volume(listed)), wanted);
  EXPECT_EQ(files_of(describe_volume(listed)).size(), 4u);
  const auto refuse = [&](const std::string& files) {
    return refusal(folder.write("d.nhdr", header + "data file: " + files + "\n"));
  };
  EXPECT_NE(refuse("s.%02d 9 12 1").find("gives no whole share"), std::string::npos);
  EXPECT_NE(refuse("s.%s 9 11 1").find("no name with one %d"), std::string::npos);
  EXPECT_NE(refuse("s.%d%n 9 11 1").find("no name with one %d"), std::string::npos);
  EXPECT_NE(refuse("s.%02d 9 1e12 1").find("files"), std::string::npos);
  EXPECT_NE(refuse("../s.09").find("does not lie beside the header"), std::string::npos);
  EXPECT_NE(refuse("/etc/passwd").find("does not lie beside the header"), std::string::npos);
  EXPECT_NE(refuse("s.%02d 12 14 1").find("s.12"), std::string::npos) << "the missing file";
}

TEST(Nrrd, EverySpaceLeadsToThePatientsFrame) {
  const Folder folder;
  const auto read = [&](const std::string& fields) {
    return open_volume(folder.write("a.nrrd", small_nrrd + fields + "\nabcd"));
  };
  const std::string turned =
      "space directions: (0,2,0) (3,0,0) (0,0,5)\nspace origin: (10,20,30)\n";
  for (const char* space : {"right-anterior-superior", "RAS", "right-anterior-superior-time"})
    expect_place(read("space: " + std::string(space) + "\n" + turned), {1, 0, 0}, {-10, 30, 22});
  for (const char* space : {"left-posterior-superior", "LPS"})
    expect_place(read("space: " + std::string(space) + "\n" + turned), {1, 0, 0}, {10, 30, -22});
  for (const char* space : {"left-anterior-superior", "LAS"})
    expect_place(read("space: " + std::string(space) + "\n" + turned), {1, 0, 0}, {10, 30, 22});
  expect_place(read("space: LPS\nspace units: \"m\" \"m\" \"m\"\n" + turned), {0, 0, 0},
               {10000, 30000, -20000});
  // Spacings alone: x to the visitor's right, y back, z up.
  expect_place(read("spacings: 2 3 nan\n"), {1, 1, 1}, {2, 3, -3});
  expect_place(read("space: 3D-left-handed\nspacings: 2 3 5\n"), {1, 1, 1}, {2, 5, 3});
  EXPECT_FALSE(describe_volume(folder.file("a.nrrd")).is_placed);
}

TEST(Nrrd, AFirstAxisIsColourOrAListAndALastOneIsTime) {
  const Folder folder;
  const auto write = [&](const std::string& fields, const std::string& samples) {
    return folder.write("a.nrrd",
                        "NRRD0004\nencoding: raw\nendian: little\n" + fields + "\n" + samples);
  };
  Volume volume = open_volume(write("type: uint8\ndimension: 3\nsizes: 3 2 1\n", "rgbRGB"));
  EXPECT_EQ(volume.channels, 3);
  EXPECT_EQ(volume.size, glm::ivec3(2, 1, 1));
  EXPECT_EQ(values_of(volume, 2), (std::vector<double>{'b', 'B'}));
  volume = open_volume(
      write("type: uint8\ndimension: 4\nsizes: 4 1 1 2\nkinds: RGBA-color domain domain domain\n",
            "rgbaRGBA"));
  EXPECT_EQ(volume.channels, 3);
  EXPECT_EQ(values_of(volume, 0), (std::vector<double>{'r', 'R'}));
  const std::string list = write(
      "type: short\ndimension: 4\nsizes: 2 2 1 1\nkinds: list domain domain domain\n"
      "space: LPS\nspace directions: none (1,0,0) (0,1,0) (0,0,1)\n",
      samples_of<int16_t>({1, 10, 2, 20}));
  EXPECT_EQ(values_of(open_volume(list)), (std::vector<double>{1, 2}));
  EXPECT_EQ(values_of(open_volume(list, {.time = 1})), (std::vector<double>{10, 20}));
  EXPECT_NE(refusal(list, {.time = 2}).find("has a list of 2"), std::string::npos);
  const std::string times =
      write("type: short\ndimension: 4\nsizes: 2 1 1 2\nkinds: domain domain domain list\n",
            samples_of<int16_t>({1, 2, 3, 4}));
  EXPECT_EQ(values_of(open_volume(times, {.time = 1})), (std::vector<double>{3, 4}));
  // A picture lies in space, too.
  volume =
      open_volume(write("type: uint8\ndimension: 2\nsizes: 2 1\nspace: RAS\n"
                        "space directions: (0,0,2) (0,2,0)\n",
                        "ab"));
  expect_place(volume, {1, 0, 0}, {0, 2, 0});
  EXPECT_NEAR(glm::length(glm::dvec3(volume.to_metres[2])), 2e-3, 1e-12);
}

TEST(Nrrd, NamesWhatIsWrongInAHeader) {
  const Folder folder;
  const auto expect = [&](const char* wanted, const char* from, const std::string& to) {
    std::string header = small_nrrd + "spacings: 1 1 1\n";
    header.replace(header.find(from), std::string_view(from).size(), to);
    const std::string message = refusal(folder.write("a.nrrd", header + "\nabcd"));
    EXPECT_NE(message.find(wanted), std::string::npos) << wanted << ": " << message;
    EXPECT_NE(message.find("a.nrrd"), std::string::npos) << message;
  };
  expect("spacings: has the spacing 0 along axis y", "1 1 1\n", "1 0 1\n");
  expect("spacings: has the spacing nan along axis x", "1 1 1\n", "nan 1 1\n");
  expect("type: is 'block'", "uchar", "block");
  expect("encoding: is 'hex'; raw and gzip", "raw", "hex");
  expect("endian: is neither", "uchar", "short");
  expect("sizes: has 3 numbers, the dimension is 4", "dimension: 3", "dimension: 4");
  expect("sizes: says -1 samples", "2 2 1", "2 2.5 1");
  expect("the header says 4000000", "2 2 1", "2 2000 1000");
  expect("line 3: is no field", "type: uchar", "type uchar");
  expect("space directions: the affine is singular", "spacings: 1 1 1",
         "space directions: (1,0,0) (2,0,0) (0,0,1)");
  expect("space directions: is '(1,0,0) x'", "spacings: 1 1 1", "space directions: (1,0,0) x");
}

}  // namespace
}  // namespace wellspring::test
