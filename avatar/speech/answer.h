// SPDX-License-Identifier: Apache-2.0
// From an answer of the voice program to a Speech. The other side may be broken: nothing it sends
// is believed before it was checked.
#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "avatar/speech/request.h"
#include "avatar/speech/speech.h"

namespace wellspring::avatar {

// Null with one sentence in `error` when the answer is an error or makes no sense.
std::shared_ptr<const Speech> read_speech_answer(const SpeechRequest& request,
                                                 std::string_view json_text,
                                                 std::vector<int16_t> pcm, std::string& error);

}  // namespace wellspring::avatar
