// SPDX-License-Identifier: Apache-2.0
// Reads trained weights as TensorFlow.js stores them: manifests in JSON list tensors in order, and
// files have their bytes, one tensor after the other (little-endian). A tensor is floats of 32 bits
// or whole numbers of 32 bits, or is quantised: floats of 16 bits, or numbers n of 8 or 16 bits
// that stand for n * scale + min. No number in them is trusted.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "json/fields.h"

namespace cv {
class Mat;
}

namespace wellspring::kiosk {

struct WeightTensor {
  std::vector<int> shape;     // slowest first, as TensorFlow orders filters: rows, columns, in, out
  std::vector<float> values;  // as many as the product of the shape; whole numbers, too
};

using Tensors = std::map<std::string, WeightTensor>;

// Reads the tensors of a list of manifests, whose files of bytes lie in `folder`. `faults` throws
// the first fault with its place; one in the bytes is thrown as a LoadError of their file: a tensor
// is cut off, too long, there twice, not finite or of another kind. Memory is bounded by the files'
// sizes, 64 MiB together.
Tensors load_tensors(const JsonValue& manifests, Faults& faults, const std::string& folder);

struct WeightSet {
  std::string file;  // the manifest's path, for messages
  Tensors tensors;
};

// Reads FOLDER/NAME-weights_manifest.json and the files of bytes that it names in the same folder.
// Throws LoadError.
WeightSet load_weight_set(const std::string& folder, const std::string& name);

// Returns the tensor of that name, moved out of `set`. Throws LoadError unless it has that shape.
WeightTensor take_tensor(WeightSet& set, const std::string& name, const std::vector<int>& shape);

// Puts filters of TensorFlow's order (rows, columns, in, out) into OpenCV's (out, in, rows,
// columns).
WeightTensor filters(const WeightTensor& tensor);
// Returns a copy for a layer of OpenCV's module dnn.
cv::Mat blob(const WeightTensor& tensor);

// Returns "3x3x16x32".
std::string shape_text(const std::vector<int>& shape);

}  // namespace wellspring::kiosk
