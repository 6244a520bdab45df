// SPDX-License-Identifier: Apache-2.0
// Samples that are many, few, strange, packed, cut off, or not those that a header promises.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <fstream>
#include <limits>

#include "unit/volume/format/volume_files.h"

namespace wellspring::test {
namespace {

TEST(VolumeSamples, OneSampleIsAVolume) {
  const Folder folder;
  NiftiFile nifti;
  nifti.dim = {3, 1, 1, 1}, nifti.pixdim = {1, 0, 0, 0};
  const Volume volume = open_volume(folder.write("a.nii", nifti.header() + "a"));
  EXPECT_EQ(volume.samples(), 1u);
  EXPECT_EQ(volume.at(0, 0, 0), 'a');
  EXPECT_NE(glm::determinant(volume.to_metres), 0);
}

TEST(VolumeSamples, AColumnOfSamplesIsAVolume) {
  const Folder folder;
  NiftiFile nifti;
  nifti.dim = {3, 1, 1, 4000}, nifti.type = 512;
  std::vector<uint16_t> samples(4000);
  for (size_t i = 0; i < samples.size(); i++) samples[i] = uint16_t(i * 13);
  const Volume volume =
      open_volume(folder.write("a.nii.gz", pack(nifti.header() + samples_of(samples))));
  EXPECT_EQ(volume.size, glm::ivec3(1, 1, 4000));
  EXPECT_EQ(values_of(volume), std::vector<double>(samples.begin(), samples.end()));
}

TEST(VolumeSamples, ValuesThatAreNotFiniteAreKeptAndGridsAreFinite) {
  const Folder folder;
  NiftiFile nifti;
  nifti.dim = {3, 4, 1, 1}, nifti.type = 16;
  const float infinite = std::numeric_limits<float>::infinity();
  const Volume volume = open_volume(folder.write(
      "a.nii", nifti.header() + samples_of<float>({std::nanf(""), -infinite, 1e30f, -1})));
  EXPECT_TRUE(std::isnan(volume.at(0, 0, 0)));
  EXPECT_EQ(volume.at(1, 0, 0), -infinite);
  EXPECT_EQ(to_grid(volume).values, (std::vector<float>{0, 0, 1e30f, -1}));
}

TEST(VolumeSamples, ManyAreMappedAndAreTheSame) {
  const Folder folder;
  NiftiFile nifti;
  nifti.dim = {4, 50, 40, 3, 2}, nifti.type = 4;
  std::vector<int16_t> samples(12000);
  for (size_t i = 0; i < samples.size(); i++) samples[i] = int16_t(i * 7 - 9000);
  const std::string file = folder.write("a.nii", nifti.header() + samples_of(samples));
  VolumeChoice mapped{.time = 1};
  mapped.limits.mapped_from = 1, mapped.limits.memory = 0;
  const Volume volume = open_volume(file, mapped);
  EXPECT_EQ(values_of(volume), values_of(open_volume(file, {.time = 1})));
  EXPECT_EQ(volume.at(0, 0, 0), samples[6000]);
  // It is the file itself: who writes there sees it.
  std::fstream(file, std::ios::binary | std::ios::in | std::ios::out)
      .seekp(352 + 2 * 6000)
      .write("\x05\x00", 2);
  EXPECT_EQ(volume.at(0, 0, 0), 5);
  // The other byte order needs memory, of which there is none.
  nifti.is_big = true;
  folder.write("b.nii", nifti.header() + samples_of(samples, true));
  EXPECT_NE(refusal(folder.file("b.nii"), mapped).find("of memory"), std::string::npos);
}

TEST(VolumeSamples, ALargeFileIsMappedWithoutBeingRead) {
  const Folder folder;
  NiftiFile nifti{.is_version_2 = true};
  nifti.dim = {3, 4096, 4096, 512}, nifti.type = 2;
  const std::string file = folder.write("a.nii", nifti.header());
  std::filesystem::resize_file(file, 544 + (uint64_t(8) << 30));  // a hole of 8 GiB
  const Volume volume = open_volume(file);
  EXPECT_EQ(volume.at(4095, 4095, 511), 0);
  EXPECT_EQ(volume.byte_count(), uint64_t(8) << 30);
  std::filesystem::resize_file(file, 544 + (uint64_t(8) << 30) - 1);
  EXPECT_NE(refusal(file).find("holds 8589934591 bytes of samples, the header says 8589934592"),
            std::string::npos);
}

TEST(VolumeSamples, AHeaderThatLiesCostsNoMemory) {
  const Folder folder;
  NiftiFile nifti{.is_version_2 = true};
  nifti.dim = {3, 1000, 1000, 3000};
  EXPECT_NE(refusal(folder.write("a.nii", nifti.header() + "ab")).find("is cut off: it holds 2"),
            std::string::npos);
  // Packed bytes cannot become so many.
  EXPECT_NE(refusal(folder.write("a.nii.gz", pack(nifti.header() + "ab"))).find("cannot become"),
            std::string::npos);
  // They could, but do not: memory is touched only as far as there are data.
  const std::string noise = [] {
    std::string bytes(3'500'000, '\0');
    uint32_t state = 1;
    for (char& byte : bytes) byte = char((state = state * 1664525 + 1013904223) >> 24);
    return bytes;
  }();
  rusage before{}, after{};
  getrusage(RUSAGE_SELF, &before);
  const std::string file = folder.write("b.nii.gz", pack(nifti.header() + noise));
  EXPECT_NE(refusal(file).find("is cut off: it holds 3500000 bytes of samples, the header says "
                               "3000000000"),
            std::string::npos)
      << refusal(file);
  getrusage(RUSAGE_SELF, &after);
  EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 300'000) << "KiB";
}

TEST(VolumeSamples, PackedDataThatAreCutOffSayHowMuchIsThere) {
  const Folder folder;
  NiftiFile nifti;
  nifti.dim = {3, 100, 100, 10};
  std::string samples(100000, '\0');
  for (size_t i = 0; i < samples.size(); i++) samples[i] = char(i * i >> 5);
  const std::string packed = pack(nifti.header() + samples);
  EXPECT_EQ(refusal(folder.write("a.nii.gz", packed)), "");
  for (const size_t size : {packed.size() / 2, packed.size() - 9}) {
    const std::string message = refusal(folder.write("a.nii.gz", packed.substr(0, size)));
    EXPECT_NE(message.find("is cut off"), std::string::npos) << message;
  }
  EXPECT_NE(refusal(folder.write("a.nii.gz", packed.substr(0, packed.size() / 2)))
                .find("bytes of samples, the header says 100000"),
            std::string::npos);
  EXPECT_NE(refusal(folder.write("a.nii.gz", packed.substr(0, packed.size() - 4))).find("no end"),
            std::string::npos);
  std::string damaged = packed;
  damaged[damaged.size() - 6] ^= 1;  // in the sum
  EXPECT_NE(refusal(folder.write("a.nii.gz", damaged)).find("packed data are damaged"),
            std::string::npos);
}

TEST(VolumeSamples, AGzipBombIsNotUnpacked) {
  const Folder folder;
  NiftiFile nifti;
  nifti.dim = {3, 64, 64, 64};
  const std::string bomb = pack(nifti.header() + std::string(100'000'000, '\0'), true, 9);
  ASSERT_LT(bomb.size(), 200'000u);
  EXPECT_NE(refusal(folder.write("a.nii.gz", bomb))
                .find("unpacks to more than the 262144 bytes that the header says"),
            std::string::npos);
  // A few bytes more are no matter.
  const std::string padded = pack(nifti.header() + std::string(262144 + 1000, '\0'));
  EXPECT_EQ(refusal(folder.write("b.nii.gz", padded)), "");
  // A volume that is what it says needs its memory.
  VolumeChoice choice;
  choice.limits.memory = 100'000;
  EXPECT_NE(refusal(folder.file("b.nii.gz"), choice).find("of memory"), std::string::npos);
}

TEST(VolumeSamples, MembersOfGzipThatFollowEachOtherAreOneStream) {
  const Folder folder;
  NiftiFile nifti;
  nifti.dim = {3, 4, 1, 1};
  const std::string file =
      folder.write("a.nii.gz", pack(nifti.header()) + pack("ab") + pack("cd") + "\0\0\0");
  EXPECT_EQ(values_of(open_volume(file)), (std::vector<double>{'a', 'b', 'c', 'd'}));
}

TEST(VolumeSamples, WhatIsNoVolumeIsNamed) {
  const Folder folder;
  EXPECT_NE(refusal(folder.file("none.nii")).find("is not there"), std::string::npos);
  EXPECT_NE(refusal(folder.path.string()).find("folders of DICOM"), std::string::npos);
  EXPECT_NE(refusal(folder.write("a.nii", "")).find("is empty"), std::string::npos);
  EXPECT_NE(refusal(folder.write("b.nii", "no volume")).find("no header of NIfTI"),
            std::string::npos);
  EXPECT_NE(refusal(folder.write("c.raw", "abc")).find("with a .json beside"), std::string::npos);
  EXPECT_NE(refusal(folder.write("d.h5", "\x89HDF\r\n")).find("is HDF5"), std::string::npos);
  EXPECT_NE(refusal(folder.write("e.dcm", std::string(128, '\0') + "DICM" + std::string(99, 'x')))
                .find("is DICOM"),
            std::string::npos);
}

}  // namespace
}  // namespace wellspring::test
