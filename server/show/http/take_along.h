// SPDX-License-Identifier: Apache-2.0
// GET /api/v1/exhibits/ID/qr.svg: a code for a guest's phone, which opens the museum's public
// address there, with the story that the kiosk tells.
#pragma once
#include <string>

#include "show/exhibit/exhibit.h"
#include "wire/http.h"

namespace wellspring::show {

// The picture of a QR code (ISO/IEC 18004, error correction level M) as SVG: black on white, with
// the quiet zone of four modules. Throws std::length_error for more text than such a code holds.
std::string draw_qr_code(const std::string& text);

// 404 where the house has no public `address`, or there is no such story; else the code of
// ADDRESS/e/ID?story=STORY&lang=LANG, `story` and `lang` being optional.
HttpReply answer_qr(const Exhibit& exhibit, const std::string& address,
                    const HttpQuestion& question);

}  // namespace wellspring::show
