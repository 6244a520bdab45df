// SPDX-License-Identifier: Apache-2.0
// URIs of a glTF file (glTF 2.0 section 2.8) are data themselves (RFC 2397), or they name files,
// whose paths are resolved as RFC 3986 section 5.2 says and then judged: "../textures/a.png" is
// right where it stays inside the package.
#pragma once
#include "gltf/file.h"

namespace wellspring::gltf {

bool is_data_uri(const std::string& uri);
// The file that a URI means, canonical; nothing if the package has none. Names are compared by
// Unicode (gltf/find_file.h). Throws LoadError for URIs that mean no file of the package.
std::optional<std::filesystem::path> find_uri(const File& file, const std::string& where,
                                              const std::string& uri);
// Bytes of a data URI or of that file. Throws LoadError for all that is wrong but a missing file.
std::optional<Bytes> read_uri(const File& file, const std::string& where, const std::string& uri);
// Says that there is no such file, what was tried, and which was perhaps meant.
std::string no_such_file(const File& file, const std::string& where, const std::string& uri);

}  // namespace wellspring::gltf
