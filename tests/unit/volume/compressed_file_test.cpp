// SPDX-License-Identifier: Apache-2.0
#include "volume/compressed/compressed_file.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "base/load_error.h"
#include "base/read_file.h"
#include "base/write_file.h"
#include "compressed_made.h"
#include "unit/folder.h"
#include "volume/compressed/compressed_volume.h"

namespace wellspring::test {
namespace {

Volume grey_of_ct() {
  Volume volume = made_volume<int16_t>(
      {21, 18, 35}, 1, [](int x, int y, int z, int) { return 30 * x - 45 * y + x * z; });
  volume.slope = 0.5, volume.intercept = -1024;
  volume.to_metres = glm::dmat4(0.001, 0, 0, 0, 0, 0, 0.002, 0, 0, -0.001, 0, 0, 1, 2, 3, 1);
  return volume;
}

// A file's bytes, some of which are changed before it is opened.
struct Bytes {
  std::string bytes;
  explicit Bytes(const CompressedVolume& volume)
      : bytes(reinterpret_cast<const char*>(volume.file.get()), size_t(volume.file_bytes)) {}
  template <class T>
  Bytes& set(size_t at, T value) {
    std::memcpy(&bytes[at], &value, sizeof value);
    return *this;
  }
  CompressedVolume open() const {
    const std::shared_ptr<std::byte[]> copy(new std::byte[bytes.size() + 1]);
    std::memcpy(copy.get(), bytes.data(), bytes.size());
    return open_compressed(std::shared_ptr<const std::byte>(copy, copy.get()), bytes.size(), "f");
  }
  std::string problem() const {
    try {
      open();
    } catch (const LoadError& error) {
      return error.what();
    }
    return "";
  }
};

TEST(CompressedFile, WhatWasWrittenIsRead) {
  const Folder folder;
  const std::string path = (folder.path / "volume.rvq").string();
  const CompressedVolume written = compress_volume(grey_of_ct(), few_codevectors(32));
  write_compressed(path, written);
  EXPECT_EQ(std::filesystem::file_size(path), written.file_bytes);
  const CompressedVolume read = read_compressed(path);
  EXPECT_EQ(read.size, written.size);
  EXPECT_EQ(read.kind, SampleKind::i16);
  EXPECT_EQ(read.slope, 0.5);
  EXPECT_EQ(read.intercept, -1024);
  EXPECT_EQ(read.to_metres, grey_of_ct().to_metres);
  EXPECT_EQ(decode_all<int16_t>(read), decode_all<int16_t>(written));
  EXPECT_EQ(decode_all<float>(read, 2), decode_all<float>(written, 2));
  for (const int z : {0, 1})
    EXPECT_EQ(brick_range(read, {0, 0, z}).greatest, brick_range(written, {0, 0, z}).greatest);
}

TEST(CompressedFile, CodesTakeExactlyTheirFormula) {
  const CompressedVolume volume = compress_volume(colored_ball({30, 26, 22}), few_codevectors(32));
  const CompressedLayout layout = layout_of(volume);
  EXPECT_EQ(layout.codes, compressed_header_bytes);
  EXPECT_EQ(layout.codebooks - layout.codes, (8u * 7 * 6 * 4 * 5 + 7) / 8);
  EXPECT_EQ(layout.ranges - layout.codebooks, 4u * 32 * 256);
  EXPECT_EQ(layout.end - layout.ranges, 6u);
  EXPECT_EQ(volume.file_bytes, layout.end);
}

TEST(CompressedFile, NeighbouringCodesDoNotMixForAnyNumberOfBits) {
  // Blocks of a few kinds, so that decoding is exact if, and only if, each code is.
  for (const int codevectors : {2, 3, 9, 100}) {
    const Volume volume = made_volume<uint8_t>({60, 28, 24}, 1, [&](int x, int y, int z, int) {
      return (x / 4 + 15 * (y / 4) + 105 * (z / 4)) * 37 % codevectors * 2 + 1;
    });
    const CompressedVolume compressed = compress_volume(volume, few_codevectors(codevectors, 3));
    EXPECT_EQ(compressed.codevectors, codevectors);
    EXPECT_EQ(decode_all<uint8_t>(compressed), samples_of<uint8_t>(volume));
  }
}

TEST(CompressedFile, CutFilesAreRefused) {
  const Folder folder;
  const std::string path = (folder.path / "volume.rvq").string();
  const Bytes whole(compress_volume(grey_of_ct(), few_codevectors(8)));
  for (const size_t length : {size_t(0), size_t(7), size_t(100), size_t(247), size_t(248),
                              size_t(600), whole.bytes.size() - 1}) {
    write_file(path, std::span(whole.bytes.data(), length));
    EXPECT_THROW(read_compressed(path), LoadError) << length;
  }
  write_file(path, std::span<const char>(whole.bytes + "x"));
  EXPECT_THROW(read_compressed(path), LoadError);
  EXPECT_THROW(read_compressed((folder.path / "none").string()), LoadError);
  EXPECT_THROW(read_compressed(folder.path.string()), LoadError);
  EXPECT_THROW(read_compressed("/dev/zero"), LoadError);
}

TEST(CompressedFile, LyingHeadersAreRefusedByName) {
  const Bytes good(compress_volume(grey_of_ct(), few_codevectors(8)));
  EXPECT_EQ(good.problem(), "");
  const auto with = [&](size_t at, auto value) { return Bytes(good).set(at, value).problem(); };
  EXPECT_NE(with(0, 'X').find("no compressed volume"), std::string::npos);
  EXPECT_NE(with(8, 2u).find("version 2"), std::string::npos);
  EXPECT_NE(with(12, 2u).find("2 channels"), std::string::npos);
  EXPECT_NE(with(12, 3u).find("kind 2"), std::string::npos);
  EXPECT_NE(with(16, 3u).find("kind 3"), std::string::npos);
  for (const size_t axis : {20, 24, 28})
    for (const int side : {0, -5, 1 << 21, 2147483647, 500})
      EXPECT_NE(with(axis, side), "") << axis << " " << side;
  EXPECT_NE(Bytes(good).set(20, 1 << 20).set(24, 1 << 20).set(28, 1 << 20).problem().find("many"),
            std::string::npos);
  for (const uint32_t levels : {0u, 3u, 9u, 0xffffffffu}) EXPECT_NE(with(32, levels), "");
  for (const uint32_t vectors : {0u, 7u, 9u, 65536u, 0xffffffffu}) EXPECT_NE(with(36, vectors), "");
  EXPECT_NE(with(40, std::nan("")).find("not finite"), std::string::npos);
  EXPECT_NE(with(56, 0.0).find("singular"), std::string::npos);
  EXPECT_NE(with(184, 99).find("fraction"), std::string::npos);
  EXPECT_NE(with(188, 1 << 30).find("offset"), std::string::npos);
}

TEST(CompressedFile, CodesOfADamagedFileLeadNowhereElse) {
  Bytes file(compress_volume(colored_ball({20, 20, 20}), few_codevectors(5)));
  for (size_t i = 0; i < 125 * 4 * 3 / 8; i++) file.bytes[248 + i] = char(0xff);
  const CompressedVolume volume = file.open();
  EXPECT_EQ(volume.codevectors, 5);
  EXPECT_EQ(volume.code(3), 0xfffu);
  const std::vector<float> samples = decode_all<float>(volume);  // codevector 7 of 5 is zero
  EXPECT_EQ(samples[0], 0);
}

}  // namespace
}  // namespace wellspring::test
