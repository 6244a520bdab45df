// SPDX-License-Identifier: Apache-2.0
// Makes a first exhibit of an IIIF manifest: its pictures hang in a plain room.
#pragma once
#include <string>

#include "show/proposal/new_exhibit.h"

namespace wellspring::show {

// Says whether a file is taken for a manifest, by its name.
bool is_manifest(const std::string& file);

// Makes `content`/`id` with a room, exhibit.json, and the pictures that are files below the
// manifest's folder; those of image services stay there, and `told` names the hosts that will be
// asked. Pictures whose size nobody tells are at most 1.2 m high and 1.8 m wide. Throws LoadError
// as make_new_exhibit() does, and for what is wrong with the manifest.
NewExhibit make_new_gallery(const std::string& content, const std::string& id,
                            const std::string& manifest);

}  // namespace wellspring::show
