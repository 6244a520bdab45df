// SPDX-License-Identifier: Apache-2.0
#include "avatar/speech/protocol.h"

#include <algorithm>

#include "avatar/speech/text.h"

namespace wellspring::avatar {
namespace {

namespace protocol = speech_protocol;

bool is_tag_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
         c == '_';
}

}  // namespace

std::string check_speech_request(const SpeechRequest& request) {
  if (request.text.size() > protocol::max_text_bytes)
    return "the text has " + std::to_string(request.text.size()) + " bytes; at most " +
           std::to_string(protocol::max_text_bytes) + " can be spoken at once";
  size_t broken = find_broken_utf8(request.text);
  if (broken != std::string::npos) return "the text is no UTF-8 at byte " + std::to_string(broken);
  if (request.text.find_first_not_of(" \t\r\n") == std::string::npos) return "the text is empty";
  if (request.lang.empty() || request.lang.size() > 40 ||
      !std::all_of(request.lang.begin(), request.lang.end(), is_tag_character))
    return "'" + request.lang.substr(0, 40) + "' is no language tag";
  if (request.words_per_minute < protocol::min_words_per_minute ||
      request.words_per_minute > protocol::max_words_per_minute)
    return "the speed is 80 to 450 words a minute";
  if (request.pitch < 0 || request.pitch > 100) return "the pitch is 0 to 100";
  if (request.variant.size() > 40 ||
      !std::all_of(request.variant.begin(), request.variant.end(), is_tag_character))
    return "'" + request.variant.substr(0, 40) + "' is no variant of a voice";
  return {};
}

}  // namespace wellspring::avatar
