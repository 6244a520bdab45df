// SPDX-License-Identifier: Apache-2.0
// Data that a file has compressed, brought to the form that all else reads: buffer views by
// EXT_meshopt_compression (KHR_meshopt_compression as far as it is the same), meshes by
// KHR_draco_mesh_compression. The decoders are given only what was checked, and no more than
// unpacked_bytes_limit comes out of a file.
#pragma once
#include "gltf/file.h"

namespace wellspring::gltf {

// A buffer view's extension; null: it is stored as it is.
const json* meshopt_of(const json& view);
// Checks it against its buffer and the rules of its mode and filter.
void check_meshopt(File& file, size_t view);
// The view's bytes, decoded once.
const Bytes& unpack_meshopt(File& file, size_t view);

// Gives each primitive that is compressed a buffer of its own, to which its accessors then point.
// To be called when buffer views are checked and accessors are not.
void unpack_draco(File& file);

}  // namespace wellspring::gltf
