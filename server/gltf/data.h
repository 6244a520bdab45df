// SPDX-License-Identifier: Apache-2.0
// Reads numbers out of a glTF file's buffers: every accessor form of section 3.6.2 - interleaved,
// normalised, sparse, each component type, and without bytes (zeros). Layouts were checked when the
// file was loaded.
#pragma once
#include <span>

#include "gltf/file.h"

namespace wellspring::gltf {

// Unpacks a file's compressed data into the form that all other code reads: buffer views by
// EXT_meshopt_compression (KHR_meshopt_compression as far as it is the same), meshes by
// KHR_draco_mesh_compression. The decoders get only checked data, and no more than
// unpacked_bytes_limit comes out of a file.

// Returns a buffer view's extension; null: it is stored as it is.
const json* meshopt_of(const json& view);
// Checks the view's extension against its buffer and the rules of its mode and filter.
void check_meshopt(File& file, size_t view);
// Returns the view's bytes, decoded once.
const Bytes& unpack_meshopt(File& file, size_t view);

// Gives each compressed primitive a buffer of its own, to which its accessors then point. To be
// called when buffer views are checked and accessors are not.
void unpack_draco(File& file);

enum ComponentType {
  byte_component = 5120,
  unsigned_byte = 5121,
  short_component = 5122,
  unsigned_short = 5123,
  unsigned_int = 5125,
  float_component = 5126,
};

// Holds an accessor's own description.
struct Form {
  int64_t count = 0;
  int components = 0;      // 1..16; 0: the type is unknown to glTF 2.0
  int component_type = 0;  // 0: unknown
  bool normalized = false;
};
Form form_of(const File& file, size_t accessor);
std::string describe(const File& file, size_t accessor);  // "VEC3 of FLOAT", for messages

// Returns whether an accessor's bytes exist at all: glTF lets a buffer be declared without content.
bool has_data(const File& file, size_t accessor);

// Returns all elements as floats, `components` after one another. Matrices lose their column
// padding. Throws LoadError if the accessor's type is unknown or its bytes are missing.
std::shared_ptr<const std::vector<float>> read_floats(File& file, size_t accessor);
// Returns the elements of an unsigned integer accessor. Throws LoadError.
std::vector<uint32_t> read_integers(File& file, size_t accessor);
// Returns a buffer's bytes, at least as many as it says.
const Bytes& buffer_bytes(File& file, size_t buffer);
// Counts unpacked bytes towards the file's limit.
void charge_unpacked(File& file, const std::string& where, int64_t bytes);
// Returns the bytes of a buffer view, unpacked.
std::span<const uint8_t> view_bytes(File& file, size_t view);

}  // namespace wellspring::gltf
