// SPDX-License-Identifier: Apache-2.0
// Takes a glTF 2.0 file apart: its JSON, checked, and its bytes, bounded. Everything after
// load_gltf() may rely on types, required properties, index ranges and layouts (schema.cpp,
// data.cpp).
//
// Refused (LoadError) are faults that change the meaning of geometry or material: wrong types,
// missing properties, indices out of range, bytes beyond a buffer, nodes with two parents or
// cycles, formats an attribute cannot have, missing buffers, files outside the package, broken
// pictures, required extensions this program does not know.
//
// Warned of (File::warnings) are odd things that still have one meaning: unknown properties, empty
// lists, misaligned or oddly strided but readable data, wrong min and max, vectors that are not
// unit length, weights that do not add to one, values that are not finite (the triangle is
// dropped), a picture that is not there (the material's factors stand alone).
//
// One parser reads the JSON that the checks saw, so the two cannot disagree about it.
#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace wellspring::gltf {

// This table says what one glTF file may cost; docs/operation.md tells users of it. Everything is
// bounded by bytes or by totals, never by how a file divides its data: many accessors over the same
// bytes, or over none, cannot make a small file take unbounded memory or time.

constexpr int64_t file_bytes_limit = int64_t(2) << 30;  // bytes of one file
constexpr int64_t all_bytes_limit = int64_t(4) << 30;   // bytes of all buffers that one file names
// Bytes unpacked from compressed data, in all.
constexpr int64_t unpacked_bytes_limit = int64_t(4) << 30;
constexpr int64_t json_bytes_limit = int64_t(256) << 20;
constexpr int64_t numbers_limit = 800'000'000;  // numbers decoded in all
// Numbers of one accessor without bytes of its own.
constexpr int64_t empty_numbers_limit = 12'000'000;
constexpr int64_t vertices_limit = 48'000'000;           // kept, in all
constexpr int64_t triangles_limit = 32'000'000;          // kept, in all
constexpr int64_t instances_limit = 1'000'000;           // by EXT_mesh_gpu_instancing, in all
constexpr int64_t key_numbers_limit = int64_t(1) << 26;  // numbers of animations, in all

// Messages of refusal end with these remedies.
constexpr const char* fewer_triangles =
    "simplify it (Blender: Decimate; gltfpack -si 0.5), or cut it into several files, which an "
    "exhibit's \"scenes\" put together";
constexpr const char* fewer_vertices =
    "weld vertices (Blender: Merge by Distance; gltfpack), simplify it, or cut it into several "
    "files, which an exhibit's \"scenes\" put together";

// Finds files by the names that other files give them.

// Finds the file or folder that a relative path means below a folder: by the names as they are,
// else by names that are the same for Unicode (base/unicode.h). Returns nothing if there is no such
// file or folder. Does not judge "..": callers resolve it first.
std::optional<std::filesystem::path> find_file(const std::filesystem::path& folder,
                                               const std::filesystem::path& relative);

// Lists regular files below a folder, by their paths from there, in alphabetical order; at most the
// first `most` that are met.
std::vector<std::string> list_files(const std::filesystem::path& folder, size_t most = 2000);

// Returns whether a canonical path is the canonical folder or lies below it.
bool lies_in(const std::filesystem::path& path, const std::filesystem::path& folder);

using json = nlohmann::json;
using Bytes = std::vector<uint8_t>;

struct File {
  std::string path;               // as the caller gave it, for messages
  std::filesystem::path folder;   // folder to which URIs are relative
  std::filesystem::path package;  // canonical; files read must lie inside
  json root;
  Bytes binary;  // the GLB's binary chunk
  bool has_binary = false;
  std::vector<Bytes> buffers;  // filled on first use
  std::vector<char> buffer_ready;
  // Keeps accessors decoded lately, as primitives of one mesh often share them. They are dropped
  // when they grow large.
  std::map<size_t, std::shared_ptr<const std::vector<float>>> decoded;
  int64_t decoded_numbers = 0;  // numbers held in `decoded`
  // Scratch of primitive.cpp; all entries are `unseen` between primitives.
  std::vector<uint32_t> renamed;
  // The rest counts what the file has cost so far (gltf/file.h bounds it).
  int64_t numbers_read = 0, vertices_made = 0, triangles_made = 0, keys_made = 0;
  int64_t bytes_read = 0;  // bytes of buffers
  int64_t unpacked_bytes = 0, instances_made = 0;
  std::map<size_t, Bytes> unpacked;  // buffer views that were compressed, once they are used
  bool pictures_may_fail = false;    // a picture that cannot be decoded is warned of, not refused
  std::vector<std::string> warnings;
  std::set<std::string> said;
};

// Reads, splits and checks a file. `further` names extensions that the caller understands besides
// those of materials, lights and quantisation. Throws LoadError.
File load_gltf(const std::string& path, const std::string& package,
               const std::set<std::string>& further = {});

[[noreturn]] void refuse(const File& file, const std::string& where, const std::string& what);
// Refuses a file that exceeds a limit of gltf/file.h, and says what can be done.
[[noreturn]] void refuse_beyond(const File& file, const std::string& where, int64_t limit,
                                const std::string& of_what, const std::string& remedy);
// Adds a warning; the same `what` is said once, with its first place.
void warn(File& file, const std::string& where, const std::string& what);

// These are the steps of load_gltf.
void check_schema(File& file);  // types, required properties, ranges, references
void check_layout(File& file);  // buffer views within buffers, accessors within buffer views
// Checks that all required extensions are known.
void check_extensions(File& file, const std::set<std::string>& further);

// These are helpers over checked JSON.
const json& items(const json& object, const char* key);  // an empty array if there is none
const json* find(const json& object, const char* key);   // null if there is none
const json* extension(const json& object, const char* name);
int64_t integer(const json& object, const char* key, int64_t otherwise);
double number(const json& object, const char* key, double otherwise);
bool boolean(const json& object, const char* key, bool otherwise);
std::string text(const json& object, const char* key, const std::string& otherwise = "");
std::string at(const std::string& where, size_t index);  // returns where + "/index"
// Escapes the key as RFC 6901 says.
std::string at(const std::string& where, const std::string& key);
// Returns a number as a finite float: too large values become +-1e30.
float to_float(double value);

// Reads URIs of a glTF file (glTF 2.0 section 2.8), which hold data (RFC 2397) or name files; the
// files' paths are resolved as RFC 3986 section 5.2 says and then judged: "../textures/a.png" is
// right if it stays inside the package.

bool is_data_uri(const std::string& uri);
// Returns the canonical path of the file that a URI means; nothing if the package has none. Names
// are compared by Unicode (gltf/file.h). Throws LoadError for URIs that mean no file of the
// package.
std::optional<std::filesystem::path> find_uri(const File& file, const std::string& where,
                                              const std::string& uri);
// Returns the bytes of a data URI or of that file; nothing if the file is missing. Throws LoadError
// for all other faults.
std::optional<Bytes> read_uri(const File& file, const std::string& where, const std::string& uri);
// Returns a message that there is no such file, with the path that was tried, and a similar name if
// there is one.
std::string no_such_file(const File& file, const std::string& where, const std::string& uri);

}  // namespace wellspring::gltf
