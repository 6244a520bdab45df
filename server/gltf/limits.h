// SPDX-License-Identifier: Apache-2.0
// This table says what one glTF file may cost; docs/operation.md tells users of it. Everything is
// bounded by bytes or by totals, never by how a file divides its data: many accessors over the same
// bytes, or over none, cannot make a small file take unbounded memory or time.
#pragma once
#include <cstdint>

namespace wellspring::gltf {

constexpr int64_t file_bytes_limit = int64_t(2) << 30;      // of one file
constexpr int64_t all_bytes_limit = int64_t(4) << 30;       // of all that one names, in all
constexpr int64_t unpacked_bytes_limit = int64_t(4) << 30;  // of what it has compressed, in all
constexpr int64_t json_bytes_limit = int64_t(256) << 20;
constexpr int64_t numbers_limit = 800'000'000;           // decoded in all
constexpr int64_t empty_numbers_limit = 12'000'000;      // of one accessor without bytes of its own
constexpr int64_t vertices_limit = 48'000'000;           // kept in all
constexpr int64_t triangles_limit = 32'000'000;          // kept in all
constexpr int64_t instances_limit = 1'000'000;           // of EXT_mesh_gpu_instancing, in all
constexpr int64_t key_numbers_limit = int64_t(1) << 26;  // of animations, in all

// Messages of refusal end with what can be done about it.
constexpr const char* fewer_triangles =
    "simplify it (Blender: Decimate; gltfpack -si 0.5), or cut it into several files, which an "
    "exhibit's \"scenes\" put together";
constexpr const char* fewer_vertices =
    "weld vertices (Blender: Merge by Distance; gltfpack), simplify it, or cut it into several "
    "files, which an exhibit's \"scenes\" put together";

}  // namespace wellspring::gltf
