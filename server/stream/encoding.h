// SPDX-License-Identifier: Apache-2.0
// Replies as gzip, for those who take them so: RFC 9110, sections 8.4 and 12.5.3.
#pragma once
#include "base/layers.h"
#include "wire/http.h"

namespace wellspring::stream {

// Shorter texts of the moment are sent as they are; kept ones (HttpReply::gzip) have no least size.
inline constexpr size_t least_packed_bytes = 1000;

// Whether Accept-Encoding allows gzip, and likes it no less than the text as it is. A part of the
// header that is no coding with a weight allows nothing.
bool wants_gzip(const std::string& accept_encoding);

// Makes the body of text gzip, with an ETag of its own, where the asker wants that and it is
// smaller. Vary says of both which header they were chosen by. Takes as long as zlib does, about
// 25 ms a MB: not for threads that others wait for.
void encode_reply(const HttpQuestion& question, HttpReply& reply);

}  // namespace wellspring::stream
