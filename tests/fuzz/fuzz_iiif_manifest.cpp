// SPDX-License-Identifier: Apache-2.0
// Manifests of which exhibits are made.
#include "fuzz/fuzz.h"
#include "show/proposal/iiif_manifest.h"

namespace wellspring::fuzz {

void fuzz_iiif_manifest(Bytes bytes) {
  load([&] {
    const IiifManifest manifest = load_manifest(write_file("manifest.json", bytes));
    require(!manifest.pictures.empty(), "a manifest shows a picture");
    for (const ManifestPicture& one : manifest.pictures)
      require(one.width > 0 && one.height > 0 && !one.source.empty(), "a picture has a size");
  });
}

}  // namespace wellspring::fuzz
