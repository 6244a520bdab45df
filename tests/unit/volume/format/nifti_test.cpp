// SPDX-License-Identifier: Apache-2.0
#include "volume/format/nifti.h"

#include <gtest/gtest.h>

#include <limits>

#include "unit/volume/format/volume_files.h"

namespace wellspring::test {
namespace {

void expect_millimetres(glm::dvec3 a, glm::dvec3 b, double tolerance = 1e-4) {
  for (int i = 0; i < 3; i++) EXPECT_NEAR(a[i], b[i], tolerance) << "axis " << i;
}

template <class Sample>
void expect_kind(int type, const std::vector<Sample>& samples) {
  const Folder folder;
  for (const bool is_big : {false, true})
    for (const bool is_version_2 : {false, true}) {
      NiftiFile nifti{.is_big = is_big, .is_version_2 = is_version_2};
      nifti.dim = {3, int64_t(samples.size()), 1, 1}, nifti.type = type;
      const std::string bytes = nifti.header() + samples_of(samples, is_big);
      const std::vector<double> wanted(samples.begin(), samples.end());
      EXPECT_EQ(values_of(open_volume(folder.write("a.nii", bytes))), wanted) << type << is_big;
      EXPECT_EQ(values_of(open_volume(folder.write("a.nii.gz", pack(bytes)))), wanted) << type;
    }
}

TEST(Nifti, ReadsEveryKindOfSampleInEitherByteOrder) {
  expect_kind<uint8_t>(2, {0, 200, 255});
  expect_kind<int16_t>(4, {-32768, 258, 32767});
  expect_kind<int32_t>(8, {-2147483647, 66051});
  expect_kind<float>(16, {-1.5f, 1e30f});
  expect_kind<double>(64, {-1.5, 1e300});
  expect_kind<int8_t>(256, {-128, 127});
  expect_kind<uint16_t>(512, {258, 65535});
  expect_kind<uint32_t>(768, {4294967295u, 66051});
  expect_kind<int64_t>(1024, {-5, int64_t(1) << 52});
  expect_kind<uint64_t>(1280, {5, uint64_t(1) << 63});
}

TEST(Nifti, KeepsColoursAndDropsTheirAlpha) {
  const Folder folder;
  NiftiFile nifti;
  nifti.type = 128;
  Volume volume =
      open_volume(folder.write("a.nii", nifti.header() + samples_of<uint8_t>({1, 2, 3, 4, 5, 6})));
  EXPECT_EQ(volume.channels, 3);
  EXPECT_EQ(values_of(volume, 1), (std::vector<double>{2, 5}));
  nifti.type = 2304;
  volume = open_volume(
      folder.write("b.nii", nifti.header() + samples_of<uint8_t>({1, 2, 3, 255, 4, 5, 6, 0})));
  EXPECT_EQ(volume.channels, 3);
  EXPECT_EQ(volume.byte_count(), 6u);
  EXPECT_EQ(values_of(volume, 2), (std::vector<double>{3, 6}));
}

TEST(Nifti, ScalesUnlessTheSlopeIsZero) {
  const Folder folder;
  NiftiFile nifti;
  nifti.slope = 2, nifti.intercept = -1024;
  const std::string samples = samples_of<uint8_t>({10, 20});
  EXPECT_EQ(values_of(open_volume(folder.write("a.nii", nifti.header() + samples))),
            (std::vector<double>{-1004, -984}));
  nifti.slope = 0;
  EXPECT_EQ(values_of(open_volume(folder.write("b.nii", nifti.header() + samples))),
            (std::vector<double>{10, 20}));
  nifti.slope = std::nan("");
  EXPECT_EQ(values_of(open_volume(folder.write("c.nii", nifti.header() + samples))),
            (std::vector<double>{10, 20}));
}

TEST(Nifti, PutsAScanUprightWithThePatientsLeftAtTheVisitorsRight) {
  const Folder folder;
  NiftiFile nifti;
  nifti.dim = {3, 2, 1, 1}, nifti.sform_code = 1;
  // Index x runs to superior, y to the right, z to anterior; RAS in millimetres.
  nifti.rows = {0, 3, 0, 10, 0, 0, 4, 20, 2, 0, 0, 30};
  const std::string file = folder.write("a.nii", nifti.header() + "ab");
  const Volume volume = open_volume(file);
  expect_millimetres(place_of(volume, {0, 0, 0}), {-10, 30, 20});
  expect_millimetres(place_of(volume, {1, 0, 0}), {-10, 32, 20});
  expect_millimetres(place_of(volume, {0, 1, 0}), {-13, 30, 20});
  expect_millimetres(place_of(volume, {0, 0, 1}), {-10, 30, 24});
  EXPECT_TRUE(describe_volume(file).is_placed);
}

TEST(Nifti, TakesSformBeforeQformAndQformBeforeSpacings) {
  const Folder folder;
  NiftiFile nifti;
  nifti.sform_code = 1, nifti.qform_code = 1;
  nifti.pixdim = {-1, 2, 3, 5};                        // the first mirrors z
  nifti.quaternion = {0, 0, std::sqrt(0.5), 7, 8, 9};  // a quarter turn about z
  nifti.rows = {1, 0, 0, 100, 0, 1, 0, 0, 0, 0, 1, 0};
  const auto read = [&] { return open_volume(folder.write("a.nii", nifti.header() + "ab")); };
  expect_millimetres(place_of(read(), {0, 0, 0}), {-100, 0, 0});
  nifti.sform_code = 0;
  // x runs to +y (anterior), y to -x (left), z to inferior.
  expect_millimetres(place_of(read(), {0, 0, 0}), {-7, 9, 8});
  expect_millimetres(place_of(read(), {1, 0, 0}), {-7, 9, 10});
  expect_millimetres(place_of(read(), {0, 1, 0}), {-4, 9, 8});
  expect_millimetres(place_of(read(), {0, 0, 1}), {-7, 4, 8});
  EXPECT_LT(glm::determinant(glm::dmat3(read().to_metres)), 0) << "mirrors stay mirrors";
  // A singular sform gives way to qform, and is an error alone.
  nifti.sform_code = 1, nifti.rows = {1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0};
  expect_millimetres(place_of(read(), {0, 0, 0}), {-7, 9, 8});
  nifti.qform_code = 0;
  EXPECT_THROW(read(), LoadError);
  // Neither: x to the visitor's right, y back, z up.
  nifti.sform_code = 0;
  expect_millimetres(place_of(read(), {1, 1, 1}), {2, 5, -3});
  EXPECT_FALSE(describe_volume(folder.file("a.nii")).is_placed);
}

TEST(Nifti, AnObliqueAffineIsKeptExactly) {
  const Folder folder;
  NiftiFile nifti{.is_version_2 = true};
  nifti.sform_code = 1;
  nifti.rows = {0.1, 0.2, 0.30000000000000004, 1, 0, 1. / 3, 0.7, 2, 0.9, 0.01, 1, 3};
  const Volume volume = open_volume(folder.write("a.nii", nifti.header() + "ab"));
  EXPECT_EQ(volume.to_metres[1][2], 1. / 3 * 1e-3);
  EXPECT_EQ(volume.to_metres[2][0], -0.30000000000000004 * 1e-3);
}

TEST(Nifti, KnowsMetresMillimetresAndMicrometres) {
  const Folder folder;
  NiftiFile nifti;
  nifti.sform_code = 1;
  const auto length = [&](int unit) {
    nifti.unit = unit;
    const Volume volume = open_volume(folder.write("a.nii", nifti.header() + "ab"));
    return glm::length(glm::dvec3(volume.to_metres[0]));
  };
  EXPECT_DOUBLE_EQ(length(1), 1);
  EXPECT_DOUBLE_EQ(length(2), 1e-3);
  EXPECT_DOUBLE_EQ(length(3), 1e-6);
  EXPECT_DOUBLE_EQ(length(0), 1e-3);
  EXPECT_DOUBLE_EQ(length(2 + 8), 1e-3) << "seconds are in the same number";
}

TEST(Nifti, PairsHaveTheirSamplesInAnotherFile) {
  const Folder folder;
  NiftiFile nifti;
  nifti.magic = "ni1", nifti.offset = 2;
  folder.write("a.hdr", nifti.header());
  EXPECT_NE(refusal(folder.file("a.hdr")).find("a.img is not there"), std::string::npos);
  folder.write("a.img", "..ab");
  for (const char* name : {"a.hdr", "a.img"})
    EXPECT_EQ(values_of(open_volume(folder.file(name))), (std::vector<double>{'a', 'b'})) << name;
  folder.write("b.hdr.gz", pack(nifti.header()));
  folder.write("b.img.gz", pack("..cd"));
  EXPECT_EQ(values_of(open_volume(folder.file("b.img.gz"))), (std::vector<double>{'c', 'd'}));
  EXPECT_EQ(files_of(describe_volume(folder.file("a.img"))),
            (std::vector{folder.file("a.hdr"), folder.file("a.img")}));
}

TEST(Nifti, AnalyzeRunsToThePatientsLeftAndHasNoScale) {
  const Folder folder;
  NiftiFile nifti;
  nifti.magic = "", nifti.offset = 0, nifti.slope = 1715, nifti.unit = 0;
  nifti.pixdim = {0, 2, 3, 5};
  folder.write("a.img", "ab");
  Volume volume = open_volume(folder.write("a.hdr", nifti.header()));
  EXPECT_EQ(values_of(volume), (std::vector<double>{'a', 'b'}));
  expect_millimetres(place_of(volume, {1, 1, 1}), {2, 5, 3});
  nifti.orient = 1;  // slices are coronal: y up, z to the front
  volume = open_volume(folder.write("a.hdr", nifti.header()));
  expect_millimetres(place_of(volume, {1, 1, 1}), {2, 3, 5});
  nifti.orient = 9;
  folder.write("a.hdr", nifti.header());
  EXPECT_NE(refusal(folder.file("a.hdr")).find("orient"), std::string::npos);
}

TEST(Nifti, OneOfSeveralTimesIsTaken) {
  const Folder folder;
  NiftiFile nifti;
  nifti.dim = {5, 2, 1, 1, 2, 2};
  const std::string bytes = nifti.header() + "abcdefgh";
  for (const std::string& file :
       {folder.write("a.nii", bytes), folder.write("a.nii.gz", pack(bytes))}) {
    EXPECT_EQ(describe_volume(file).times, 4);
    EXPECT_EQ(values_of(open_volume(file)), (std::vector<double>{'a', 'b'}));
    EXPECT_EQ(values_of(open_volume(file, {.time = 3})), (std::vector<double>{'g', 'h'}));
    EXPECT_NE(refusal(file, {.time = 4}).find("has 4 times, so there is no time 4"),
              std::string::npos);
  }
}

TEST(Nifti, NamesWhatIsWrongInAHeader) {
  const Folder folder;
  const auto refuse = [&](const auto& change) {
    NiftiFile nifti;
    change(nifti);
    return refusal(folder.write("a.nii", nifti.header() + "ab"));
  };
  EXPECT_EQ(refuse([](NiftiFile&) {}), "");
  const auto expect = [&](const char* wanted, const auto& change) {
    const std::string message = refuse(change);
    EXPECT_NE(message.find(wanted), std::string::npos) << wanted << ": " << message;
    EXPECT_NE(message.find("a.nii"), std::string::npos) << message;
  };
  expect("pixdim: has the spacing 0 along axis x", [](auto& n) { n.pixdim[1] = 0; });
  expect("pixdim: has the spacing nan", [](auto& n) { n.pixdim[1] = std::nan(""); });
  expect("dim: says 0 samples", [](auto& n) { n.dim[2] = 0; });
  expect("dim: says -3 samples", [](auto& n) { n.dim[1] = -3; });
  expect("wrong byte order", [](auto& n) { n.dim[0] = 0x300; });
  expect("datatype: is 32: complex", [](auto& n) { n.type = 32; });
  expect("datatype: is 77", [](auto& n) { n.type = 77; });
  expect("vox_offset", [](auto& n) { n.offset = 5; });
  expect("vox_offset", [](auto& n) { n.offset = std::nan(""); });
  expect("holds 2 bytes of samples, the header says 400", [](auto& n) { n.dim[1] = 400; });
  expect("at most 64 GiB", [](auto& n) {
    n.is_version_2 = true;
    n.dim = {3, 1 << 20, 1 << 20, 1 << 20};
  });
  expect("1 to 1048576 are read", [](auto& n) {
    n.is_version_2 = true;
    n.dim = {3, int64_t(1) << 60, 1, 1};
  });
  expect("sform", [](auto& n) { n.sform_code = 1, n.rows[0] = std::nan(""); });
  // An axis of one sample needs no spacing.
  EXPECT_EQ(refuse([](auto& n) { n.pixdim[3] = 0; }), "");
}

}  // namespace
}  // namespace wellspring::test
