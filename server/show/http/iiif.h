// SPDX-License-Identifier: Apache-2.0
// Serves the very large pictures of exhibits to viewers of other museums: each by the IIIF Image
// API 3.0, level 2, an exhibit's all together as a manifest of the Presentation API 3.0.
#pragma once
#include <functional>
#include <string>

#include "show/exhibit/exhibit.h"
#include "wire/http.h"

namespace wellspring::show {

// Names an exhibit that is served; null: there is none.
struct IiifExhibit {
  const Exhibit* exhibit = nullptr;
  std::string address{};  // HouseSettings::address
};

struct IiifSources {
  std::function<IiifExhibit(const std::string& id)> find;
  bool changes = false;  // exhibits may: nothing of them is kept by browsers
};

// Answers what is asked for below /iiif/: EXHIBIT/manifest.json, EXHIBIT~PIECE/info.json, and
// EXHIBIT~PIECE/REGION/SIZE/ROTATION/QUALITY.FORMAT.
HttpReply answer_iiif(const IiifSources& sources, const HttpQuestion& question);

}  // namespace wellspring::show
