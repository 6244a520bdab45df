// SPDX-License-Identifier: Apache-2.0
// Tells a program's version and which libraries it is made of.
#pragma once
#include <initializer_list>
#include <string>
#include <vector>

namespace wellspring::about {

// A component is compiled into a program, or loaded with it.
struct Component {
  std::string name;     // "Embree"
  std::string file;     // "libembree3.so.3"; empty: compiled in
  std::string version;  // by its package, else by its file or header; may be empty
  std::string package;  // Debian's package; empty: it comes from none
  std::string licence;  // SPDX expression; empty: unknown here, /usr/share/doc/PACKAGE/copyright
  std::string purpose;  // empty: another library needs it
};

// Lists the components of this process: its shared libraries as the loader lists them, and
// `compiled_in`, libraries of headers alone. Asks dpkg-query if there is one.
std::vector<Component> list_components(std::initializer_list<const char*> compiled_in);

// These write "VERSION"; "NAME VERSION"; that with the components, one a line; or these as
// CycloneDX 1.5.
std::string version_number();
std::string describe_version(const std::string& program);
std::string describe_components(const std::string& program,
                                const std::vector<Component>& components);
std::string write_bill(const std::string& program, const std::vector<Component>& components);

// If an argument is --version, prints the version, with --verbose also the components, with --json
// these as CycloneDX; true: the program is to end.
bool answer_version(int argc, char** argv,
                    std::initializer_list<const char*> compiled_in = {"CLI11", "GLM",
                                                                      "nlohmann-json", "stb"});

// Lists the libraries that our programs use, by the beginning of their files' names: name, licence
// (SPDX) and purpose. A library that is linked and missing here fails
// tests/scripted/version.test.mjs.

struct KnownLibrary {
  const char *begins, *name, *licence, *purpose;
};

inline constexpr const char* gcc_runtime = "GPL-3.0-or-later WITH GCC-exception-3.1";

inline constexpr KnownLibrary known_libraries[] = {
    {"ld-linux", "GNU C Library", "LGPL-2.1-or-later", "loads programs"},
    {"libbrotli", "Brotli", "MIT", "fonts, for FreeType"},
    {"libbsd.", "libbsd", "BSD-3-Clause", "for libX11"},
    {"libc.", "GNU C Library", "LGPL-2.1-or-later", "C"},
    {"libcairo.", "Cairo", "LGPL-2.1-only OR MPL-1.1", "paintings described in words"},
    {"libcrypto.", "OpenSSL", "Apache-2.0", "TLS"},
    {"libdeflate.", "libdeflate", "MIT", "TIFF pictures"},
    {"libdnnl.", "oneDNN", "Apache-2.0", "the network that cleans pictures at rest"},
    {"libdraco.", "Draco", "Apache-2.0", "compressed meshes"},
    {"libembree", "Embree", "Apache-2.0", "ray tracing"},
    {"libespeak-ng.", "eSpeak NG", "GPL-3.0-or-later", "speech, in a program of its own"},
    {"libexpat.", "Expat", "MIT", "for Fontconfig"},
    {"libFLAC.", "FLAC", "BSD-3-Clause", "recordings, for libsndfile"},
    {"libfmt.", "{fmt}", "MIT", "texts"},
    {"libfontconfig.", "Fontconfig", "MIT", "letters of paintings"},
    {"libfreetype.", "FreeType", "FTL OR GPL-2.0-or-later", "letters of paintings"},
    {"libgcc_s.", "GCC", gcc_runtime, "run-time support of C++"},
    {"libgomp.", "GCC", gcc_runtime, "OpenMP, for oneDNN"},
    {"libIex", "OpenEXR", "BSD-3-Clause", "OpenEXR pictures"},
    {"libIlmThread", "OpenEXR", "BSD-3-Clause", "OpenEXR pictures"},
    {"libImath", "Imath", "BSD-3-Clause", "OpenEXR pictures"},
    {"libjbig.", "JBIG-KIT", "GPL-2.0-or-later", "for libtiff; not used"},
    {"libjpeg.", "libjpeg-turbo", "IJG AND BSD-3-Clause AND Zlib", "TIFF pictures"},
    {"liblcms2.", "Little CMS", "MIT", "colour profiles"},
    {"libLerc.", "LERC", "Apache-2.0", "TIFF pictures"},
    {"liblzma.", "XZ Utils", "LicenseRef-Public-Domain", "TIFF pictures"},
    {"libm.", "GNU C Library", "LGPL-2.1-or-later", "mathematics"},
    {"libmd.", "libmd", "BSD-3-Clause", "for libbsd"},
    {"libmeshoptimizer.", "meshoptimizer", "MIT", "compressed meshes"},
    {"libmp3lame.", "LAME", "LGPL-2.0-or-later", "recordings, for libsndfile"},
    {"libmpg123.", "mpg123", "LGPL-2.1-only", "recordings, for libsndfile"},
    {"libogg.", "Ogg", "BSD-3-Clause", "recordings, for libsndfile"},
    {"libOpenCL.", "OpenCL ICD loader", "BSD-2-Clause", "for oneDNN; not used"},
    {"libnats.", "NATS C client", "Apache-2.0", "workers elsewhere"},
    {"libopencv_", "OpenCV", "Apache-2.0", "cameras and faces, in the kiosk's program"},
    {"libOpenEXR", "OpenEXR", "BSD-3-Clause", "OpenEXR pictures"},
    {"libopus.", "Opus", "BSD-3-Clause", "recordings, for libsndfile"},
    {"libpixman-1.", "Pixman", "MIT", "for Cairo"},
    {"libpng16.", "libpng", "libpng-2.0", "PNG pictures"},
    {"libprotobuf-c.", "protobuf-c", "BSD-2-Clause", "for the NATS C client; not used"},
    {"libpugixml.", "pugixml", "MIT", "X3D figures"},
    {"libqrcodegen", "QR Code generator", "MIT", "codes for guests' phones"},
    {"libseccomp.", "libseccomp", "LGPL-2.1-only", "what a process gives up"},
    {"libsndfile.", "libsndfile", "LGPL-2.1-or-later", "recordings"},
    {"libsodium.", "libsodium", "ISC", "seals of visits, tokens"},
    {"libspdlog.", "spdlog", "MIT", "the log"},
    {"libsqlite3.", "SQLite", "blessing", "daily sums"},
    {"libssl.", "OpenSSL", "Apache-2.0", "TLS"},
    {"libstdc++.", "GCC", gcc_runtime, "the C++ library"},
    {"libSvtAv1Enc.", "SVT-AV1", "BSD-3-Clause-Clear", "video"},
    {"libsystemd.", "systemd", "LGPL-2.1-or-later", "what a service tells its manager"},
    {"libtbb.", "oneTBB", "Apache-2.0", "loops over cores"},
    {"libtbbmalloc.", "oneTBB", "Apache-2.0", "memory of oneTBB itself"},
    {"libtiff.", "libtiff", "libtiff", "TIFF pictures"},
    {"libturbojpeg.", "libjpeg-turbo", "IJG AND BSD-3-Clause AND Zlib", "JPEG pictures"},
    {"libutf8proc.", "utf8proc", "MIT AND Unicode-DFS-2016", "names compared by Unicode"},
    {"libvorbis", "Vorbis", "BSD-3-Clause", "recordings, for libsndfile"},
    {"libvpx.", "libvpx", "BSD-3-Clause", "video"},
    {"libwebp.", "WebP", "BSD-3-Clause", "WebP pictures"},
    {"libX", "X.Org libraries", "MIT", "for Cairo; not used"},
    {"libxcb", "XCB", "MIT", "for Cairo; not used"},
    {"libyaml-cpp.", "yaml-cpp", "MIT", "dispersion of glass and gems"},
    {"libz.", "zlib", "Zlib", "compression"},
    {"libzstd.", "Zstandard", "BSD-3-Clause", "light that packages carry"},
    {"libZXing.", "ZXing-C++", "Apache-2.0", "codes on what visitors hold, in the kiosk's program"},
    // The rest are headers that are compiled in.
    {"Boost", "Boost (Asio, Beast)", "BSL-1.0", "HTTP and WebSocket"},
    {"CLI11", "CLI11", "BSD-3-Clause", "options"},
    {"GLM", "GLM", "MIT", "vectors"},
    {"nlohmann-json", "JSON for Modern C++", "MIT", "JSON"},
    {"stb", "stb", "MIT OR Unlicense", "HDR pictures"},
};

}  // namespace wellspring::about
