// SPDX-License-Identifier: Apache-2.0
// Damaged manifests and weights are refused, with the file and the tensor that is wrong.
#include "kiosk/network/weights.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include "base/load_error.h"
#include "kiosk/network/network.h"

namespace wellspring::test {
namespace {

namespace fs = std::filesystem;

class Weights : public testing::Test {
 protected:
  void SetUp() override {
    folder =
        fs::temp_directory_path() / (std::string("wellspring_weights_") +
                                     testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(folder);
  }
  void TearDown() override { fs::remove_all(folder); }

  void write(const std::string& manifest, const std::string& bytes) {
    std::ofstream(folder / "net-weights_manifest.json") << manifest;
    std::ofstream(folder / "net.bin", std::ios::binary) << bytes;
  }
  // A manifest of these tensors.
  static std::string manifest(const std::string& tensors, const std::string& path = "net.bin") {
    return R"([{"weights":[)" + tensors + R"(],"paths":[")" + path + R"("]}])";
  }
  void expect_refused(const std::string& file, const std::string& where, const std::string& what) {
    try {
      load_weight_set(folder.string(), "net");
      ADD_FAILURE() << "no error: " << what;
    } catch (const LoadError& error) {
      EXPECT_EQ(fs::path(error.file).filename(), file) << error.what();
      EXPECT_NE(error.where.find(where), std::string::npos) << error.what();
      EXPECT_NE(error.what_.find(what), std::string::npos) << error.what();
    }
  }
  fs::path folder;
};

const std::string manifest_name = "net-weights_manifest.json";
const std::string quantised =
    R"({"name":"a","shape":[2],"dtype":"float32","quantization":{"dtype":"uint8","scale":0.5,"min":-1}})";
const std::string plain = R"({"name":"b","shape":[1],"dtype":"float32"})";

std::string bytes_of(float value) { return {reinterpret_cast<const char*>(&value), sizeof value}; }

TEST_F(Weights, bytes_and_floats_are_read_in_order) {
  write(manifest(quantised + "," + plain), std::string("\x02\xff", 2) + bytes_of(2.5f));
  WeightSet set = load_weight_set(folder.string(), "net");
  EXPECT_EQ(take_tensor(set, "a", {2}).values, (std::vector<float>{0, 126.5f}));
  EXPECT_EQ(take_tensor(set, "b", {1}).values, std::vector<float>{2.5f});
  EXPECT_TRUE(set.tensors.empty());
}

TEST_F(Weights, a_manifest_that_is_none_is_refused) {
  expect_refused(manifest_name, "", "cannot be read");
  write("[{", "");
  expect_refused(manifest_name, "", "line 1");
  write("{}", "");
  expect_refused(manifest_name, "", "groups of weights");
  write(manifest(plain, "../net.bin"), bytes_of(1));
  expect_refused(manifest_name, "/0/paths/0", "same folder");
  write(manifest(plain, "other.bin"), bytes_of(1));
  expect_refused("other.bin", "", "cannot be read");
}

TEST_F(Weights, a_wrong_tensor_is_named) {
  for (auto [tensor, what] :
       {std::pair<const char*, const char*>{R"({"name":"b","shape":[0],"dtype":"float32"})",
                                            "whole number from 1"},
        {R"({"name":"b","shape":[-1],"dtype":"float32"})", "whole number from 1"},
        {R"({"name":"b","shape":[1073741824,1073741824],"dtype":"float32"})", "whole number"},
        {R"({"name":"b","shape":5,"dtype":"float32"})", "list of sizes"},
        {R"({"name":"b","shape":[1],"dtype":"bool"})", "float32, int32"},
        {R"({"name":"b","shape":[1],"dtype":4})", "text"},
        {R"({"name":"b","shape":[1],"dtype":"int32","quantization":{"dtype":"uint8"}})", "floats"},
        {R"({"name":"b","shape":[1],"dtype":"float32","quantization":{"dtype":null}})", "text"},
        {R"({"name":"b","shape":[1],"dtype":"float32","quantization":{"dtype":"int4"}})", "uint8"},
        {R"({"name":"b","shape":[1],"dtype":"float32","quantization":{"dtype":"uint8","scale":1}})",
         "missing"}}) {
    write(manifest(quantised + "," + tensor), std::string("\x02\xff", 2) + bytes_of(1));
    expect_refused(manifest_name, "/0/weights/1 (b)", what);
  }
  write(manifest(quantised + "," + quantised), "1234");
  expect_refused(manifest_name, "/0/weights/1 (a)", "second");
  write(manifest(R"({"shape":[1]})"), "1");
  expect_refused(manifest_name, "/0/weights/0/name", "missing");
}

TEST_F(Weights, bytes_too_few_too_many_or_not_finite_are_refused) {
  write(manifest(quantised + "," + plain), "12345");
  expect_refused("net.bin", "byte 2", "ends within");
  write(manifest(quantised), "123");
  expect_refused("net.bin", "byte 2", "goes on");
  write(manifest(plain), bytes_of(std::numeric_limits<float>::quiet_NaN()));
  expect_refused("net.bin", "byte 0", "not finite");
}

TEST_F(Weights, a_network_names_the_tensor_that_does_not_fit) {
  const fs::path good = fs::path(WELLSPRING_WEIGHTS_FOLDER) / "face";
  if (!fs::exists(good)) GTEST_SKIP() << good << " is not here; ./wellspring installs it";
  const char* name = "tiny_face_detector_model-weights_manifest.json";
  fs::copy(good / "tiny_face_detector_model.bin", folder / "tiny_face_detector_model.bin");
  std::ifstream in(good / name);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  auto refused = [&](const std::string& from, const std::string& to, const std::string& where) {
    std::string changed = text;
    const size_t at = changed.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    changed.replace(at, from.size(), to);
    std::ofstream(folder / name) << changed;
    try {
      load_face_detector(folder.string());
      ADD_FAILURE() << "no error for " << to;
    } catch (const LoadError& error) {
      EXPECT_EQ(error.where, where) << error.what();
    }
  };
  refused("\"conv3/bias\"", "\"conv3/other\"", "conv3/bias");
  refused("[1,1,32,64]", "[1,1,64,32]", "conv2/pointwise_filter");
}

}  // namespace
}  // namespace wellspring::test
