// SPDX-License-Identifier: Apache-2.0
// Trained weights as TensorFlow.js stores them: a manifest in JSON, which lists tensors in order,
// and a file of their bytes, one tensor after the other. A tensor is 32-bit floats (little-endian),
// or quantised: bytes b that stand for b * scale + min.
#pragma once
#include <map>
#include <string>
#include <vector>

namespace wellspring::kiosk {

struct WeightTensor {
  std::vector<int> shape;     // slowest first, as TensorFlow orders filters: rows, columns, in, out
  std::vector<float> values;  // as many as the product of the shape
};

struct WeightSet {
  std::string file;  // the manifest's path, for messages
  std::map<std::string, WeightTensor> tensors;
};

// Reads FOLDER/NAME-weights_manifest.json and the file of bytes that it names in the same folder.
// Every number of both is foreign: throws LoadError naming file and tensor where one is missing,
// cut off, too long, not finite or of another kind. Memory is bounded by the files' sizes.
WeightSet load_weight_set(const std::string& folder, const std::string& name);

// The tensor of that name, moved out of `set`. Throws LoadError unless it has that shape.
WeightTensor take_tensor(WeightSet& set, const std::string& name, const std::vector<int>& shape);

}  // namespace wellspring::kiosk
