// SPDX-License-Identifier: Apache-2.0
// Formats that state no orientation, and orientation in words: SLC, raw samples, patient_frame.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "unit/volume/format/volume_files.h"
#include "volume/format/patient_frame.h"
#include "volume/format/raw_json.h"

namespace wellspring::test {
namespace {

TEST(RawVolume, IsDescribedByTheJsonBesideIt) {
  const Folder folder;
  const nlohmann::json described = {
      {"file", "a.raw"},     {"size", {2, 1, 1}}, {"kind", "i16"},    {"spacing_mm", {2, 3, 5}},
      {"byte_order", "big"}, {"slope", 2},        {"intercept", -10}, {"origin", {100, 200, 300}},
      {"axes", "RAS"},       {"skip_bytes", 1}};
  folder.write("a.json", described.dump());
  folder.write("a.raw", "." + samples_of<int16_t>({-300, 5}, true));
  for (const char* name : {"a.json", "a.raw"}) {
    const Volume volume = open_volume(folder.file(name));
    EXPECT_EQ(values_of(volume), (std::vector<double>{-610, 0})) << name;
    const glm::dvec3 place = place_of(volume, {1, 1, 1});
    EXPECT_NEAR(place.x, -102, 1e-9);
    EXPECT_NEAR(place.y, 305, 1e-9);
    EXPECT_NEAR(place.z, 203, 1e-9);
  }
  folder.write("a.raw", pack("." + samples_of<int16_t>({-300, 5}, true)));
  EXPECT_EQ(values_of(open_volume(folder.file("a.json"))), (std::vector<double>{-610, 0}));
}

TEST(RawVolume, NamesTheFieldThatIsWrong) {
  const Folder folder;
  folder.write("a.raw", "ab");
  const nlohmann::json good = {
      {"file", "a.raw"}, {"size", {2, 1, 1}}, {"kind", "u8"}, {"spacing_mm", {1, 1, 1}}};
  EXPECT_EQ(refusal(folder.write("a.json", good.dump())), "");
  const auto expect = [&](const char* wanted, const char* field, const nlohmann::json& value) {
    nlohmann::json bad = good;
    bad[field] = value;
    const std::string message = refusal(folder.write("a.json", bad.dump()));
    EXPECT_NE(message.find(wanted), std::string::npos) << wanted << ": " << message;
  };
  expect("/size", "size", {2, 1});
  expect("/size", "size", {2, 0, 1});
  expect("/size", "size", {2, 1.5, 1});
  expect("/kind", "kind", "u9");
  expect("/spacing_mm: has the spacing 0 along axis x", "spacing_mm", {0, 1, 1});
  expect("/byte_order", "byte_order", "middle");
  expect("/axes", "axes", "LRS");
  expect("/slope", "slope", 0);
  expect("/colors", "colors", 3);
  expect("does not lie beside", "file", "../a.raw");
  expect("/sice", "sice", {1, 1, 1});
  expect("holds 2 bytes of samples, the header says 200", "size", {2, 10, 10});
  nlohmann::json missing = good;
  missing.erase("kind");
  EXPECT_NE(refusal(folder.write("a.json", missing.dump())).find("kind"), std::string::npos);
}

TEST(RawVolume, TheSchemaHasEveryField) {
  const auto schema = raw_json_schema();
  for (const char* field : {"file", "size", "kind", "spacing_mm", "byte_order", "slope",
                            "intercept", "origin", "axes", "colors", "skip_bytes"})
    EXPECT_TRUE(schema["properties"].contains(field)) << field;
}

std::string slc(const std::string& slices, int compression = 1) {
  return "11111\n2 2 2 8\n1.5 2 3\n1 7 0 " + std::to_string(compression) + "\n1 1 X" + "rgb" +
         slices;
}

TEST(Slc, RunsAndSingleSamplesAreUnpacked) {
  const Folder folder;
  // Two samples as they are and a run of two; then a slice whose last sample is left out.
  const std::string slices =
      "6 X\x82"
      "ab\x02z" +
      std::string(1, '\0') + "2X\x03q";
  const Volume volume = open_volume(folder.write("a.slc", slc(slices)));
  EXPECT_EQ(values_of(volume), (std::vector<double>{'a', 'b', 'z', 'z', 'q', 'q', 'q', 0}));
  const glm::dvec3 place = place_of(volume, {1, 1, 1});
  EXPECT_NEAR(place.x, 1.5, 1e-9);
  EXPECT_NEAR(place.y, 3, 1e-9);
  EXPECT_NEAR(place.z, -2, 1e-9);
  EXPECT_EQ(values_of(open_volume(folder.write("b.slc", slc("abcdefgh", 0)))),
            (std::vector<double>{'a', 'b', 'c', 'd', 'e', 'f', 'g', 'h'}));
}

TEST(Slc, NamesTheSliceThatIsWrong) {
  const Folder folder;
  const auto refuse = [&](const std::string& slices) {
    return refusal(folder.write("a.slc", slc(slices)));
  };
  EXPECT_NE(refuse("2X\x04q2X\x02q").find("slice 1: has 2 of 4 samples"), std::string::npos);
  EXPECT_NE(refuse("2X\x05q2X\x02q").find("slice 0: has more than 4 samples"), std::string::npos);
  EXPECT_NE(refuse("2X\x04q").find("slice 1: is not there"), std::string::npos);
  EXPECT_NE(refuse("2X\x04q9X\x02q").find("slice 1: is cut off: 2 of its 9"), std::string::npos);
  EXPECT_NE(refuse("99999999X").find("slice 0: does not begin with its length"), std::string::npos);
  std::string large = slc("2X\x04q2X\x02q");
  large.replace(large.find("2 2 2"), 5, "4096 4096 4096");
  EXPECT_NE(refusal(folder.write("b.slc", large)).find("MiB of memory"), std::string::npos);
  large.replace(large.find("4096 4096 4096"), 14, "1024 1024 1024");
  EXPECT_NE(refusal(folder.write("b.slc", large)).find("cannot hold 1024 slices"),
            std::string::npos);
}

TEST(PatientFrame, TellsTheOrientationInWords) {
  EXPECT_EQ(describe_axes(to_patient_frame("RAS")),
            "x runs to the patient's right, y to the front, z up (RAS)");
  EXPECT_EQ(describe_axes(to_patient_frame("LAS")),
            "x runs to the patient's left, y to the front, z up (LAS), a left-handed grid");
  const glm::dmat4 turned(0.8, 0.6, 0, 0, -0.6, 0.8, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1);
  EXPECT_EQ(describe_axes(turned),
            "x runs to the patient's left, y up, z to the front (LSA), oblique by up to 36.9 "
            "degrees");
  for (const char* axes : {"RAS", "LPS", "PIR", "SAL", "IRP", "ASL"})
    EXPECT_EQ(axes_of(to_patient_frame(axes)), axes);
  for (const char* wrong : {"", "RA", "RAL", "RRS", "ras", "RASA", "XYZ"})
    EXPECT_FALSE(are_axes(wrong)) << wrong;
}

TEST(PatientFrame, AChoiceOverrulesTheFile) {
  const Folder folder;
  NiftiFile nifti;
  nifti.dim = {3, 3, 1, 1}, nifti.sform_code = 1;
  nifti.rows = {2, 0, 0, 7, 0, 3, 0, 7, 0, 0, 5, 7};
  const std::string file = folder.write("a.nii", nifti.header() + "abc");
  const Volume volume = open_volume(file, {.axes = "IPL"});
  EXPECT_EQ(axes_of(volume.to_metres), "IPL");
  EXPECT_NEAR(place_of(volume, {1, 0, 0}).y, 0, 1e-9);
  EXPECT_NEAR(place_of(volume, {0, 0, 0}).y, 2, 1e-9);
  EXPECT_NE(refusal(file, {.axes = "IPP"}).find("cannot have the axes 'IPP'"), std::string::npos);
}

}  // namespace
}  // namespace wellspring::test
