// SPDX-License-Identifier: Apache-2.0
#include "volume/nrrd_write.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cstring>

#include "base/load_error.h"

namespace wellspring::test {
namespace {

Volume coloured_volume() {
  Volume volume;
  volume.size = {2, 3, 1}, volume.channels = 3, volume.kind = SampleKind::u8;
  const std::shared_ptr<std::byte[]> bytes(new std::byte[18]);
  for (int i = 0; i < 18; ++i) bytes[i] = std::byte(i * 10);
  volume.bytes = std::shared_ptr<const std::byte>(bytes, bytes.get());
  volume.to_metres = glm::dmat4(0.001, 0, 0, 0, 0, 0.002, 0, 0, 0, 0, -0.003, 0, 1, 2, 3, 1);
  return volume;
}

// Returns the header and the unpacked data.
std::pair<std::string, std::string> split_nrrd(const std::vector<char>& file) {
  const std::string text(file.begin(), file.end());
  const size_t end = text.find("\n\n") + 2;
  std::string data(1000, 0);
  z_stream stream{};
  inflateInit2(&stream, 15 + 16);
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data() + end));
  stream.avail_in = uInt(text.size() - end);
  stream.next_out = reinterpret_cast<Bytef*>(data.data());
  stream.avail_out = uInt(data.size());
  EXPECT_EQ(inflate(&stream, Z_FINISH), Z_STREAM_END);
  EXPECT_EQ(stream.avail_in, 0u);
  inflateEnd(&stream);
  return {text.substr(0, end), data.substr(0, stream.total_out)};
}

TEST(NrrdWrite, ColoursLieOnTheFirstAxisAndPlacesAreMillimetres) {
  const Volume volume = coloured_volume();
  const auto [header, data] = split_nrrd(encode_nrrd(volume));
  EXPECT_EQ(header,
            "NRRD0005\ntype: uint8\ndimension: 4\nspace: left-posterior-superior\nsizes: 3 2 3 1\n"
            "space directions: none (1,0,0) (0,0,2) (0,3,0)\nspace origin: (1000,-3000,2000)\n"
            "space units: \"mm\" \"mm\" \"mm\"\nkinds: RGB-color space space space\n"
            "endian: little\nencoding: gzip\n\n");
  ASSERT_EQ(data.size(), volume.byte_count());
  EXPECT_EQ(std::memcmp(data.data(), volume.bytes.get(), data.size()), 0);
}

TEST(NrrdWrite, WholeNumbersSayWhatTheyMeasure) {
  Volume volume = coloured_volume();
  volume.slope = 0.5, volume.intercept = -1;
  const auto [header, data] = split_nrrd(encode_nrrd(volume));
  EXPECT_NE(header.find("old min: -1\nold max: 126.5\n"), std::string::npos) << header;
}

TEST(NrrdWrite, FloatsAreWrittenAsWhatTheyMeasure) {
  Volume volume;
  volume.size = {2, 1, 1}, volume.kind = SampleKind::f32, volume.slope = 2, volume.intercept = 1;
  const float samples[2] = {3, -4};
  const std::shared_ptr<std::byte[]> bytes(new std::byte[8]);
  std::memcpy(bytes.get(), samples, 8);
  volume.bytes = std::shared_ptr<const std::byte>(bytes, bytes.get());
  const auto [header, data] = split_nrrd(encode_nrrd(volume));
  EXPECT_NE(header.find("type: float\ndimension: 3\n"), std::string::npos);
  float found[2];
  ASSERT_EQ(data.size(), sizeof found);
  std::memcpy(found, data.data(), sizeof found);
  EXPECT_EQ(found[0], 7);
  EXPECT_EQ(found[1], -7);
}

TEST(NrrdWrite, AFolderThatIsNotThereIsNamed) {
  EXPECT_THROW(save_nrrd("/nowhere/at/all.nrrd", coloured_volume()), LoadError);
}

}  // namespace
}  // namespace wellspring::test
