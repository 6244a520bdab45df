// SPDX-License-Identifier: Apache-2.0
// What every reply carries besides what the show said, and small replies of our own.
#pragma once
#include <span>
#include <string>
#include <utility>

#include "base/layers.h"
#include "wire/http.h"

namespace wellspring::stream {

// Headers of every reply, WebSocket handshakes included: what the page may load (all from here),
// that types are not guessed, that no page of others frames ours, shares its window
// or embeds what is here, that no page gets the camera or microphone; over TLS, that it stays at
// that.
std::span<const std::pair<const char*, const char*>> security_headers(bool secure);

// {"error": {"status":.., "message":..}}
HttpReply make_refusal(int status, const std::string& message);

// Makes a good reply whose ETag the asker already has a 304 without body, narrows one of a file to
// the range asked for (206, or 416), sets Cache-Control: no-cache where nothing is said, and drops
// headers that no header line can hold.
void finish_reply(const HttpQuestion& question, HttpReply& reply);

// If-None-Match as RFC 9110 section 13.1.2: "*", or a list with an equal tag (weak comparison).
bool etag_matches(const std::string& if_none_match, const std::string& etag);

}  // namespace wellspring::stream
