// SPDX-License-Identifier: Apache-2.0
// Real files: scans that others test their readers with.
#include <gtest/gtest.h>

#include <filesystem>

#include "unit/volume/format/volume_files.h"
#include "volume/format/patient_frame.h"

namespace wellspring::test {
namespace {

namespace fs = std::filesystem;

struct VolumeCorpus : testing::Test {
  fs::path root = fs::path(WELLSPRING_DATA) / "10_exhibits" / "volumes";
  void SetUp() override {
    if (!fs::exists(root)) GTEST_SKIP() << "no corpus at " << root;
  }
  std::string at(const std::string& name) const { return (root / name).string(); }
};

// Sums samples as they are stored.
struct Sums {
  double sum = 0, least = 1e300, most = -1e300;
  explicit Sums(const Volume& volume) {
    for (int z = 0; z < volume.size.z; z++)
      for (int y = 0; y < volume.size.y; y++)
        for (int x = 0; x < volume.size.x; x++)
          for (int channel = 0; channel < volume.channels; channel++) {
            const double value = (volume.at(x, y, z, channel) - volume.intercept) / volume.slope;
            sum += value;
            least = std::min(least, value), most = std::max(most, value);
          }
  }
};

glm::dvec3 spacing_of(const Volume& volume) {
  glm::dvec3 spacing;
  for (int i = 0; i < 3; i++) spacing[i] = glm::length(glm::dvec3(volume.to_metres[i])) * 1000;
  return spacing;
}

void expect_near(glm::dvec3 a, glm::dvec3 b, double tolerance) {
  for (int i = 0; i < 3; i++) EXPECT_NEAR(a[i], b[i], tolerance) << "axis " << i;
}

TEST_F(VolumeCorpus, SlcFilesHaveTheirSums) {
  Volume volume = open_volume(at("vtk/sphere.slc"));
  EXPECT_EQ(volume.size, glm::ivec3(50));
  EXPECT_EQ(Sums(volume).sum, 6746931);
  volume = open_volume(at("vtk/neghip.slc"));
  EXPECT_EQ(volume.size, glm::ivec3(66));
  EXPECT_EQ(Sums(volume).sum, 4824177);
  // Each slice of this one lacks its last sample.
  volume = open_volume(at("vtk/embryo.slc"));
  EXPECT_EQ(volume.size, glm::ivec3(256));
  EXPECT_EQ(volume.at(255, 255, 17), 0);
  EXPECT_GT(Sums(volume).most, 100);
}

TEST_F(VolumeCorpus, AHeadIsReadFromNumberedSlices) {
  const Volume volume = open_volume(at("vtk/headsq/quarter.nhdr"));
  EXPECT_EQ(volume.size, glm::ivec3(64, 64, 93));
  const Sums sums(volume);
  EXPECT_NEAR(sums.sum / double(volume.samples()), 507.687, 5e-4);
  EXPECT_EQ(sums.least, 0);
  EXPECT_EQ(sums.most, 3926);
  expect_near(spacing_of(volume), {3.2, 3.2, 1.5}, 1e-9);
}

TEST_F(VolumeCorpus, PackedDataAreReadToTheirEndWhateverTheHeaderSays) {
  const Volume volume = open_volume(at("vtk/froggy/frogtissue.mhd"));
  EXPECT_EQ(volume.size, glm::ivec3(500, 470, 136));
  std::vector<bool> labels(256);
  for (size_t i = 0; i < volume.samples(); i++) labels[size_t(volume.bytes.get()[i])] = true;
  EXPECT_EQ(std::ranges::count(labels, true), 26);
  expect_near(spacing_of(volume), {1, 1, 1.5}, 1e-9);
  EXPECT_EQ(open_volume(at("vtk/HeadMRVolume.mhd")).size, glm::ivec3(48, 62, 42));
}

TEST_F(VolumeCorpus, AFirstAxisOfThreeIsColour) {
  const Volume volume = open_volume(at("vtk/beach.nrrd"));
  EXPECT_EQ(volume.size, glm::ivec3(100, 100, 1));
  EXPECT_EQ(volume.channels, 3);
}

TEST_F(VolumeCorpus, ScansHaveTheirMeansAndSpacings) {
  Volume volume = open_volume(at("nifti/Iguana.nii.gz"));
  EXPECT_EQ(volume.size, glm::ivec3(210, 256, 179));
  Sums sums(volume);
  EXPECT_NEAR(sums.sum / double(volume.samples()), 32.966, 5e-4);
  EXPECT_EQ(sums.most, 229);
  expect_near(spacing_of(volume), {0.1018, 0.1018, 0.1018}, 1e-6);
  volume = open_volume(at("nifti/CT_AVM.nii.gz"));
  EXPECT_EQ(volume.size, glm::ivec3(256, 242, 154));
  EXPECT_NEAR(volume.slope, 2.208627, 1e-6);
  EXPECT_NEAR(Sums(volume).sum / double(volume.samples()), 2.3436, 5e-5);
  expect_near(spacing_of(volume), {0.7199, 0.7209, 1}, 5e-5);
  volume = open_volume(at("nifti/ct_perfusion.nii.gz"));
  EXPECT_EQ(volume.size, glm::ivec3(256, 286, 15));
  EXPECT_EQ(volume.channels, 3);
  expect_near(spacing_of(volume), {0.78125, 0.78125, 10}, 1e-6);
  volume = open_volume(at("nrrd/FLAIR.nrrd"));
  EXPECT_EQ(volume.size, glm::ivec3(124, 160, 140));
  EXPECT_NEAR(Sums(volume).sum / double(volume.samples()), 41.486048, 5e-7);
  EXPECT_EQ(axes_of(volume.to_metres), "RAS");
}

TEST_F(VolumeCorpus, SixOrientationsAreOneHead) {
  const Volume first = open_volume(at("nifti/orientation/RAS.nii.gz"));
  for (const std::string axes : {"LPS", "PIR", "SAL", "IRP", "ASL"}) {
    SCOPED_TRACE(axes);
    const Volume other = open_volume(at("nifti/orientation/" + axes + ".nii.gz"));
    EXPECT_EQ(axes_of(other.to_metres), axes);
    ASSERT_EQ(other.samples(), first.samples());
    // Each sample of the first lies on a sample of the other.
    const glm::dmat4 across = glm::inverse(other.to_metres) * first.to_metres;
    size_t wrong = 0;
    double off = 0;
    for (int z = 0; z < first.size.z; z++)
      for (int y = 0; y < first.size.y; y++)
        for (int x = 0; x < first.size.x; x++) {
          const glm::dvec3 place(across * glm::dvec4(x, y, z, 1));
          const glm::ivec3 index(glm::round(place));
          off = std::max(off, glm::length(place - glm::dvec3(index)));
          const bool is_inside = glm::all(glm::greaterThanEqual(index, glm::ivec3(0))) &&
                                 glm::all(glm::lessThan(index, other.size));
          wrong += !is_inside || other.at(index.x, index.y, index.z) != first.at(x, y, z);
        }
    EXPECT_EQ(wrong, 0u);
    EXPECT_LT(off, 1e-4);
  }
}

TEST_F(VolumeCorpus, FilesOfNibabelAreReadOrNamed) {
  Volume volume = open_volume(at("nifti/nibabel/anatomical.nii"));
  EXPECT_EQ(volume.size, glm::ivec3(33, 41, 25));
  EXPECT_EQ(axes_of(volume.to_metres), "LAS");
  volume = open_volume(at("nifti/nibabel/functional.nii"), {.time = 19});
  EXPECT_EQ(volume.size, glm::ivec3(17, 21, 3));
  EXPECT_NEAR(volume.slope, 0.0754070, 5e-8);
  EXPECT_NEAR(volume.intercept, 3100.76, 5e-3);
  EXPECT_EQ(describe_volume(at("nifti/nibabel/functional.nii")).times, 20);
  volume = open_volume(at("nifti/nibabel/example_nifti2.nii.gz"));
  EXPECT_EQ(volume.size, glm::ivec3(32, 20, 12));
  EXPECT_NE(describe_axes(volume.to_metres).find("oblique"), std::string::npos);
  EXPECT_EQ(open_volume(at("nifti/nibabel/standard.nii.gz")).size, glm::ivec3(4, 5, 7));
  volume = open_volume(at("nifti/nibabel/reoriented_anat_moved.nii"));
  EXPECT_EQ(volume.kind, SampleKind::f32);
  EXPECT_LT(std::abs(Sums(volume).most), 1e6) << "floats of the other byte order";
  for (const char* header : {"nifti1", "nifti2", "analyze"}) {
    const std::string file = at("nifti/nibabel/" + std::string(header) + ".hdr");
    EXPECT_NE(refusal(file).find(std::string(header) + ".img is not there"), std::string::npos);
  }
  EXPECT_NE(refusal(at("dicom/pydicom/CT_small.dcm")).find("is DICOM"), std::string::npos);
}

}  // namespace
}  // namespace wellspring::test
