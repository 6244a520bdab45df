// SPDX-License-Identifier: Apache-2.0
#include "kiosk/network/weights.h"

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/load_error.h"

namespace wellspring::kiosk {

namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr uintmax_t most_bytes = 64 << 20;  // of one file
constexpr size_t most_dimensions = 4;

std::string read_file(const fs::path& path) {
  std::error_code error;
  const uintmax_t size = fs::file_size(path, error);
  if (error) throw LoadError(path.string(), "", "cannot be read");
  if (size > most_bytes) throw LoadError(path.string(), "", "larger than 64 MiB");
  std::string text(size, '\0');
  std::ifstream in(path, std::ios::binary);
  if (!in.read(text.data(), std::streamsize(size)))
    throw LoadError(path.string(), "", "cannot be read");
  return text;
}

// The text of an array's element in messages: its index and its name if it has one.
std::string place(size_t index, const json& entry) {
  std::string where = "/0/weights/" + std::to_string(index);
  if (entry.is_object() && entry.contains("name") && entry["name"].is_string())
    where += " (" + entry["name"].get<std::string>().substr(0, 80) + ")";
  return where;
}

struct Reader {
  std::string manifest, bytes_file, bytes;
  size_t at = 0;

  [[noreturn]] void refuse(const std::string& where, const std::string& what) const {
    throw LoadError(manifest, where, what);
  }

  // Whether the entry's dtype is this one; it may be missing or no text.
  static bool has_type(const json& entry, const char* type) {
    return entry.contains("dtype") && entry["dtype"] == type;
  }

  float number(const json& entry, const char* key, const std::string& where) const {
    if (!entry.contains(key) || !entry[key].is_number())
      refuse(where, std::string("quantization has no number '") + key + "'");
    const float value = entry[key].get<float>();
    if (!std::isfinite(value)) refuse(where, std::string("'") + key + "' is not finite");
    return value;
  }

  WeightTensor tensor(const json& entry, const std::string& where) {
    WeightTensor out;
    if (!entry.contains("shape") || !entry["shape"].is_array() || entry["shape"].empty() ||
        entry["shape"].size() > most_dimensions)
      refuse(where, "shape is no array of one to four sizes");
    size_t count = 1;
    for (const json& size : entry["shape"]) {
      if (!size.is_number_unsigned() || size.get<uint64_t>() == 0 ||
          size.get<uint64_t>() > most_bytes / count)
        refuse(where, "a size is no whole number above 0 that the file could hold");
      out.shape.push_back(size.get<int>());
      count *= size.get<size_t>();
    }
    if (!has_type(entry, "float32")) refuse(where, "dtype is not float32");
    const bool quantised = entry.contains("quantization");
    const size_t needed = quantised ? count : 4 * count;
    if (bytes.size() - at < needed)
      throw LoadError(bytes_file, "byte " + std::to_string(at),
                      "ends within the tensor of " + manifest + where);
    out.values.resize(count);
    if (quantised) {
      const json& rule = entry["quantization"];
      if (!rule.is_object() || !has_type(rule, "uint8"))
        refuse(where, "quantization's dtype is not uint8");
      const float scale = number(rule, "scale", where), min = number(rule, "min", where);
      for (size_t i = 0; i < count; i++)
        out.values[i] = float(uint8_t(bytes[at + i])) * scale + min;
    } else {
      std::memcpy(out.values.data(), bytes.data() + at, needed);
    }
    for (size_t i = 0; i < count; i++)
      if (!std::isfinite(out.values[i]))
        throw LoadError(bytes_file, "byte " + std::to_string(at + i * needed / count),
                        "a weight is not finite");
    at += needed;
    return out;
  }
};

std::string shape_text(const std::vector<int>& shape) {
  std::string text;
  for (int size : shape) text += (text.empty() ? "" : "x") + std::to_string(size);
  return text;
}

}  // namespace

WeightSet load_weight_set(const std::string& folder, const std::string& name) {
  Reader reader;
  reader.manifest = (fs::path(folder) / (name + "-weights_manifest.json")).string();
  const json root = json::parse(read_file(reader.manifest), nullptr, false);
  if (root.is_discarded()) reader.refuse("", "is no JSON");
  if (!root.is_array() || root.size() != 1 || !root[0].is_object())
    reader.refuse("", "is no array of one group of weights");
  const json& group = root[0];
  if (!group.contains("paths") || !group["paths"].is_array() || group["paths"].size() != 1 ||
      !group["paths"][0].is_string())
    reader.refuse("/0/paths", "does not name one file");
  const std::string path = group["paths"][0].get<std::string>();
  if (path.empty() || path.find_first_of("/\\") != std::string::npos)
    reader.refuse("/0/paths/0", "is no name of a file in the same folder");
  if (!group.contains("weights") || !group["weights"].is_array())
    reader.refuse("/0/weights", "is no array");
  reader.bytes_file = (fs::path(folder) / path).string();
  reader.bytes = read_file(reader.bytes_file);

  WeightSet set{reader.manifest, {}};
  size_t index = 0;
  for (const json& entry : group["weights"]) {
    const std::string where = place(index++, entry);
    if (!entry.is_object() || !entry.contains("name") || !entry["name"].is_string())
      reader.refuse(where, "a tensor has no name");
    const std::string tensor = entry["name"].get<std::string>();
    if (!set.tensors.emplace(tensor, reader.tensor(entry, where)).second)
      reader.refuse(where, "a second tensor of this name");
  }
  if (reader.at != reader.bytes.size())
    throw LoadError(reader.bytes_file, "byte " + std::to_string(reader.at),
                    "goes on after the last tensor");
  return set;
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

}  // namespace wellspring::kiosk
