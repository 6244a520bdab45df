// SPDX-License-Identifier: Apache-2.0
#include "kiosk/station/code.h"

#define ZX_USE_UTF8 1  // version 1.4 asks for it
#include <ZXing/ReadBarcode.h>
#include <algorithm>

namespace wellspring::kiosk {
namespace {

#if __has_include(<ZXing/ReaderOptions.h>)
using ReaderOptions = ZXing::ReaderOptions;
#else
using ReaderOptions = ZXing::DecodeHints;  // its name before version 2.2
#endif

}  // namespace

std::vector<std::string> read_codes(int width, int height, const uint8_t* gray) {
  constexpr uint8_t most = 4;
  ReaderOptions options;
  options.setFormats(ZXing::BarcodeFormat::QRCode);
  options.setMaxNumberOfSymbols(most);
  std::vector<std::string> texts;
  for (const auto& found :
       ZXing::ReadBarcodes(ZXing::ImageView(gray, width, height, ZXing::ImageFormat::Lum), options))
    if (found.isValid()) texts.push_back(found.text());
  return texts;
}

bool CodeSolver::sees(int node) {
  const std::string& own = tree_.data[size_t(node)].code;
  if (own.empty()) return false;
  if (number_ != sight_.number) {
    number_ = sight_.number;
    const GrayFrame& frame = *sight_.frame;
    texts_ = read_codes(frame.width, frame.height, frame.pixels.data());
  }
  return std::ranges::find(texts_, own) != texts_.end();
}

Answer CodeSolver::match(int, int child, ContextStore&) {
  return {sees(child) ? Verdict::sure : Verdict::no};
}

bool CodeSolver::verify(int node, ContextStore&) { return sees(node); }

}  // namespace wellspring::kiosk
