// SPDX-License-Identifier: Apache-2.0
// The glTF files of a package and its environment become the exhibit's scene, with the credits that
// the files give.
#pragma once
#include "show/exhibit/json_fields.h"

namespace wellspring::show {

// Pictures, films and sounds of a package that browsers will be given: whether they can show them,
// by the bytes, not by the name.

enum class Medium { image, video, sound, station };

inline constexpr uint64_t most_image_bytes = 8 << 20, most_video_bytes = 60 << 20,
                          most_sound_bytes = 8 << 20, most_station_bytes = 32 << 20;
inline constexpr int longest_image_side =
    4096;  // pixels; screens show no more, and memory is finite

// The media type of a file by its first bytes: JPEG and PNG; WebM and MP4; Ogg, MP3, WAV, FLAC;
// JSON. Empty: none that all browsers, or kiosks, understand.
std::string media_type(Medium medium, std::string_view first_bytes);

// Adds the file `name` of the package to exhibit.files. False with a problem noted at `field` when
// it cannot be served, or without one when `name` is empty. Reads all of it: images are decoded.
bool add_served_file(Exhibit& exhibit, FieldReader& fields, const char* field,
                     const std::string& name, Medium medium);

// Files of an exhibit package, named in its JSON.

// The path of a file inside the package's folder that is there, or of a folder if these are asked
// for. Empty when not, with the problem noted at `field`; also for an empty name.
enum class PackagePart : uint8_t { file, file_or_folder };
std::string package_file(FieldReader& fields, const char* field, const std::string& folder,
                         const std::string& name, PackagePart part = PackagePart::file);

// Reads "scene" or "scenes", "scale", "light_scale" and "environment". If a file cannot be read
// exhibit.scene.objects is empty.
void read_scene(Exhibit& exhibit, FieldReader& root, std::vector<Problem>& problems);

}  // namespace wellspring::show
