// SPDX-License-Identifier: Apache-2.0
#include "kiosk/network/weights.h"

#include <cmath>
#include <cstring>
#include <filesystem>
#include <opencv2/core.hpp>
#include <utility>

#include "base/load_error.h"
#include "base/read_file.h"

namespace wellspring::kiosk {

namespace {

namespace fs = std::filesystem;

constexpr size_t most_bytes = 64 << 20;  // size of all files of bytes
constexpr size_t most_dimensions = 4, most_name = 512, most_tensors = 10000;

enum class Stored : uint8_t { float32, int32, float16, uint16, uint8 };
constexpr size_t stored_size[] = {4, 4, 2, 2, 1};  // bytes, by Stored

// Holds the bytes of one manifest's files, one after the other.
struct StoredBytes {
  std::string bytes;
  std::vector<std::pair<std::string, size_t>> files;  // path, and where its bytes begin
  size_t at = 0;

  [[noreturn]] void refuse(size_t byte, const std::string& what) const {
    size_t file = files.size() - 1;
    while (file > 0 && files[file].second > byte) file--;
    throw LoadError(files[file].first, "byte " + std::to_string(byte - files[file].second), what);
  }
};

// Returns the entry with its name in its place, for messages.
JsonValue named(const JsonValue& entry, Faults& faults, std::string& name) {
  FieldReader(entry).text("name", name, "", Need::required, most_name);
  return {entry.value(), faults, entry.where() + " (" + name.substr(0, 80) + ")"};
}

WeightTensor read_tensor(FieldReader& fields, StoredBytes& from) {
  WeightTensor out;
  size_t count = 1;
  for (const JsonValue& size : fields.list("shape", 0, most_dimensions, "sizes", Need::required)) {
    double whole = 0;
    size.whole(1, double(most_bytes / count), whole);
    out.shape.push_back(int(whole));
    count *= size_t(whole);
  }
  Stored stored = Stored::float32;
  fields.choice("dtype", {"float32", "int32"}, stored, "", Need::required);
  float scale = 1, min = 0;
  if (fields.has("quantization")) {
    if (stored != Stored::float32) fields.fail("quantization", "belongs to floats only");
    fields.part("quantization", "", [&](FieldReader& rule) {
      int kind = 0;
      rule.choice("dtype", {"float16", "uint16", "uint8"}, kind, "", Need::required);
      stored = Stored(int(Stored::float16) + kind);
      if (stored == Stored::float16) return;
      rule.number("scale", -1e30, 1e30, scale, "", Need::required);
      rule.number("min", -1e30, 1e30, min, "", Need::required);
    });
  }
  const size_t each = stored_size[size_t(stored)];
  if (count > (from.bytes.size() - from.at) / each)
    from.refuse(from.at, "ends within the tensor of " + fields.where());
  out.values.resize(count);
  char* bytes = from.bytes.data() + from.at;
  if (stored == Stored::float32) {
    std::memcpy(out.values.data(), bytes, count * each);
  } else {
    constexpr int types[] = {CV_32F, CV_32S, CV_16F, CV_16U, CV_8U};
    std::vector<char> aligned(bytes, bytes + count * each);
    const cv::Mat source(1, int(count), types[size_t(stored)], aligned.data());
    cv::Mat values(1, int(count), CV_32F, out.values.data());
    source.convertTo(values, CV_32F);
    if (stored > Stored::float16)
      for (float& value : out.values) value = value * scale + min;
  }
  for (size_t i = 0; i < count; i++)
    if (!std::isfinite(out.values[i])) from.refuse(from.at + i * each, "a weight is not finite");
  from.at += count * each;
  return out;
}

StoredBytes load_bytes(FieldReader& fields, const std::string& folder, size_t most) {
  StoredBytes out;
  for (const JsonValue& one : fields.list("paths", 1, 1000, "names of files", Need::required)) {
    std::string path;
    one.text(path, max_text_bytes, Need::required);
    if (path.find_first_of("/\\") != std::string::npos)
      one.fail("is no name of a file in the same folder");
    out.files.emplace_back((fs::path(folder) / path).string(), out.bytes.size());
    out.bytes += read_file(out.files.back().first, most - out.bytes.size());
  }
  return out;
}

}  // namespace

std::string shape_text(const std::vector<int>& shape) {
  if (shape.empty()) return "one number";
  std::string text = std::to_string(shape[0]);
  for (size_t k = 1; k < shape.size(); k++) text.append("x").append(std::to_string(shape[k]));
  return text;
}

Tensors load_tensors(const JsonValue& manifests, Faults& faults, const std::string& folder) {
  Tensors tensors;
  size_t left = most_bytes;
  for (const JsonValue& manifest : manifests.list(1, 100, "groups of weights")) {
    FieldReader group(manifest);
    StoredBytes from = load_bytes(group, folder, left);
    left -= from.bytes.size();
    for (const JsonValue& one : group.list("weights", 0, most_tensors, "tensors", Need::required)) {
      std::string name;
      FieldReader fields(named(one, faults, name));
      if (!tensors.emplace(name, read_tensor(fields, from)).second)
        fields.JsonValue::fail("is a second tensor of this name");
    }
    if (from.at != from.bytes.size()) from.refuse(from.at, "goes on after the last tensor");
  }
  return tensors;
}

WeightSet load_weight_set(const std::string& folder, const std::string& name) {
  const std::string file = (fs::path(folder) / (name + "-weights_manifest.json")).string();
  const nlohmann::json root = parse_json_file(file, read_json_text(file));
  Faults faults(file);
  return {file, load_tensors(JsonValue(root, faults), faults, folder)};
}

WeightTensor take_tensor(WeightSet& set, const std::string& name, const std::vector<int>& shape) {
  auto found = set.tensors.find(name);
  if (found == set.tensors.end()) throw LoadError(set.file, name, "no such tensor");
  if (found->second.shape != shape)
    throw LoadError(
        set.file, name,
        "has the shape " + shape_text(found->second.shape) + " instead of " + shape_text(shape));
  WeightTensor out = std::move(found->second);
  set.tensors.erase(found);
  return out;
}

cv::Mat blob(const WeightTensor& tensor) {
  cv::Mat out(tensor.shape, CV_32F);
  std::copy(tensor.values.begin(), tensor.values.end(), out.ptr<float>());
  return out;
}

WeightTensor filters(const WeightTensor& t) {
  const int rows = t.shape[0], columns = t.shape[1], in = t.shape[2], out = t.shape[3];
  WeightTensor turned{{out, in, rows, columns}, std::vector<float>(t.values.size())};
  for (int o = 0; o < out; o++)
    for (int i = 0; i < in; i++)
      for (int r = 0; r < rows; r++)
        for (int c = 0; c < columns; c++)
          turned.values[size_t(((o * in + i) * rows + r) * columns + c)] =
              t.values[size_t(((r * columns + c) * in + i) * out + o)];
  return turned;
}

}  // namespace wellspring::kiosk
