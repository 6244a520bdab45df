// SPDX-License-Identifier: Apache-2.0
// Reads and writes pictures on disk. .png .jpg are tone-mapped 8-bit, .pfm .exr linear radiance
// (32-bit float).
#pragma once
#include <string>

#include "frame/frame.h"
#include "frame/tonemap.h"

namespace wellspring::frame {

// Returns whether the ending of a file name is one that we can write.
bool is_picture_name(const std::string& path);
bool is_linear_picture_name(const std::string& path);  // radiance: .pfm .exr
// Writes to a temporary name and renames, so a reader never sees half a file. Throws LoadError.
// `comment`: kept in the file (PNG text "Comment", OpenEXR "comments", JPEG comment; PFM has none).
void save_picture(const std::string& path, const Frame& frame, const Tonemap& settings,
                  const std::string& comment = {});
// Writes .png or .jpg.
void save_image8(const std::string& path, const Image8& image, const std::string& comment = {});
// Reads a linear picture back (.pfm .exr): colour only. Throws LoadError.
Frame load_linear_picture(const std::string& path);

}  // namespace wellspring::frame
