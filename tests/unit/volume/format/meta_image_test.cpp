// SPDX-License-Identifier: Apache-2.0
#include "volume/format/meta_image.h"

#include <gtest/gtest.h>

#include "unit/volume/format/volume_files.h"

namespace wellspring::test {
namespace {

const std::string small_meta =
    "ObjectType = Image\nNDims = 3\nDimSize = 2 1 1\nElementType = MET_USHORT\n"
    "BinaryDataByteOrderMSB = True\nElementSpacing = 2 3 5\n";

TEST(MetaImage, ReadsSamplesBehindTheHeaderAndBesideIt) {
  const Folder folder;
  const std::string samples = samples_of<uint16_t>({258, 3}, true);
  const std::vector<double> wanted{258, 3};
  EXPECT_EQ(values_of(open_volume(
                folder.write("a.mha", small_meta + "ElementDataFile = LOCAL\n" + samples))),
            wanted);
  folder.write("b.raw", samples);
  EXPECT_EQ(values_of(open_volume(folder.write("b.mhd", small_meta + "ElementDataFile = b.raw\n"))),
            wanted);
  folder.write("c.raw", "some header" + samples);
  EXPECT_EQ(values_of(open_volume(
                folder.write("c.mhd", small_meta + "HeaderSize = -1\nElementDataFile = c.raw\n"))),
            wanted);
  // Sizes of packed data are not believed.
  folder.write("d.zraw", pack(samples, false));
  EXPECT_EQ(values_of(open_volume(
                folder.write("d.mhd", small_meta + "CompressedData = True\nCompressedDataSize = 3\n"
                                                   "ElementDataFile = d.zraw\n"))),
            wanted);
  EXPECT_EQ(values_of(open_volume(folder.write(
                "e.mha", small_meta + "CompressedData = True\nElementDataFile = LOCAL\n" +
                             pack(samples, false)))),
            wanted);
}

TEST(MetaImage, FilesOfSlicesHaveNumbersOrAreListed) {
  const Folder folder;
  const std::string header = "NDims = 3\nDimSize = 1 1 3\nElementType = MET_UCHAR\n";
  for (int i = 1; i <= 3; i++)
    folder.write("s" + std::to_string(i) + ".raw", std::string(1, char(i)));
  const std::vector<double> wanted{1, 2, 3};
  EXPECT_EQ(
      values_of(open_volume(folder.write("a.mhd", header + "ElementDataFile = s%d.raw 1 3 1\n"))),
      wanted);
  EXPECT_EQ(values_of(open_volume(folder.write(
                "b.mhd", header + "ElementDataFile = LIST\ns1.raw\ns2.raw\ns3.raw\n"))),
            wanted);
}

TEST(MetaImage, ItsSpaceIsThatOfDicom) {
  const Folder folder;
  const auto read = [&](const std::string& fields) {
    return open_volume(
        folder.write("a.mha", small_meta + fields + "ElementDataFile = LOCAL\n1234"));
  };
  const auto expect = [](const Volume& volume, glm::dvec3 wanted) {
    const glm::dvec3 place = place_of(volume, {1, 1, 1});
    for (int i = 0; i < 3; i++) EXPECT_NEAR(place[i], wanted[i], 1e-9) << "axis " << i;
  };
  expect(read(""), {2, 5, -3});
  EXPECT_FALSE(describe_volume(folder.file("a.mha")).is_placed);
  expect(read("TransformMatrix = 1 0 0 0 1 0 0 0 1\nOffset = 10 20 30\n"), {12, 35, -23});
  // x runs to the back, y up, z to the left.
  expect(read("TransformMatrix = 0 1 0 0 0 1 1 0 0\n"), {5, 3, -2});
  EXPECT_TRUE(describe_volume(folder.file("a.mha")).is_placed);
  // Its letters say from where axes come: x from the left, y from the front, z from below.
  expect(read("AnatomicalOrientation = LAI\n"), {-2, 5, -3});
  expect(read("AnatomicalOrientation = ???\n"), {2, 5, -3});
  EXPECT_NE(refusal(folder.write("b.mha", small_meta + "TransformMatrix = 1 0 0 1 0 0 0 0 1\n"
                                                       "ElementDataFile = LOCAL\n1234"))
                .find("TransformMatrix: the affine is singular"),
            std::string::npos);
}

TEST(MetaImage, ReadsTimesColoursAndPictures) {
  const Folder folder;
  const std::string times = folder.write(
      "a.mha",
      "NDims = 4\nDimSize = 1 2 1 2\nElementType = MET_UCHAR\nElementSpacing = 1 1 1 3\n"
      "TransformMatrix = 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\nElementDataFile = LOCAL\nabcd");
  EXPECT_EQ(values_of(open_volume(times, {.time = 1})), (std::vector<double>{'c', 'd'}));
  const Volume picture = open_volume(folder.write(
      "b.mha",
      "NDims = 2\nDimSize = 2 1\nElementNumberOfChannels = 3\nElementType = MET_UCHAR\n"
      "ElementDataFile = LOCAL\nrgbRGB"));
  EXPECT_EQ(picture.channels, 3);
  EXPECT_EQ(values_of(picture, 1), (std::vector<double>{'g', 'G'}));
  const Volume scaled =
      open_volume(folder.write("c.mha",
                               "NDims = 2\nDimSize = 1 1\nElementToIntensityFunctionSlope = 2\n"
                               "ElementToIntensityFunctionOffset = -7\nElementType = MET_CHAR\n"
                               "ElementDataFile = LOCAL\n\xff"));
  EXPECT_EQ(scaled.at(0, 0, 0), -9);
}

TEST(MetaImage, NamesWhatIsWrongInAHeader) {
  const Folder folder;
  const auto expect = [&](const char* wanted, const char* from, const std::string& to) {
    std::string header = small_meta + "ElementDataFile = LOCAL\n";
    header.replace(header.find(from), std::string_view(from).size(), to);
    const std::string message = refusal(folder.write("a.mha", header + "abcd"));
    EXPECT_NE(message.find(wanted), std::string::npos) << wanted << ": " << message;
  };
  expect("ElementSpacing: has the spacing 0 along axis x", "= 2 3 5", "= 0 3 5");
  expect("ElementType: is 'MET_BLOCK'", "MET_USHORT", "MET_BLOCK");
  expect("DimSize: says 0 samples", "2 1 1", "2 0 1");
  expect("dimsize: has 2 numbers, 3 are wanted", "2 1 1", "2 1");
  expect("the header says 8000", "2 1 1", "2 2000 1");
  expect("NDims: is 9", "NDims = 3", "NDims = 9");
  expect("line 7: is no field", "ElementDataFile = LOCAL\n", "");
  expect("does not lie beside", "LOCAL", "/etc/hosts");
  expect("HeaderSize: is nan", "ElementDataFile", "HeaderSize = x\nElementDataFile");
}

}  // namespace
}  // namespace wellspring::test
