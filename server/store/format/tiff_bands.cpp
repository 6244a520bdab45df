// SPDX-License-Identifier: Apache-2.0
#include <tiffio.h>

#include "base/load_error.h"
#include "store/format/tiff_file.h"
#include "store/format/tiff_handle.h"

namespace wellspring::store {

std::string TiffFile::description() const {
  const char* text = nullptr;
  const std::unique_ptr<TiffHandle> handle = open_handle();
  return TIFFGetField(handle->tiff, TIFFTAG_IMAGEDESCRIPTION, &text) && text ? text : "";
}

void TiffFile::find_band_weights() {
  bands_ = find_bands(file_, description());
  if (bands_) weights_ = weigh_bands(file_, *bands_, view_);
  else if (view_ != BandView{})
    throw LoadError(file_, "",
                    "has no bands: neither its ImageDescription nor a file NAME.bands.json beside "
                    "it tells wavelengths");
}

std::vector<TiffFile::BandPage> TiffFile::read_band_pages() {
  std::unique_ptr<TiffHandle> handle = open_handle();
  std::vector<BandPage> pages;
  do {
    const std::string name = "page " + std::to_string(pages.size() + 1);
    if (pages.size() == most_bands) throw LoadError(file_, name, "is one page too many");
    const char* text = nullptr;
    if (!TIFFGetField(handle->tiff, TIFFTAG_PAGENAME, &text)) text = nullptr;
    pages.push_back({describe(*handle, name, true), text ? text : ""});
  } while (TIFFReadDirectory(handle->tiff));
  return pages;
}

}  // namespace wellspring::store
