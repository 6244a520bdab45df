// SPDX-License-Identifier: Apache-2.0
// From an answer of the voice program to a Speech. The other side may be broken: nothing it sends
// is believed before it was checked.
#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "avatar/speech/protocol.h"
#include "avatar/speech/speech.h"

namespace wellspring::avatar {

// The silence of p, t and k belongs to them.

// eSpeak NG's voiceless stops begin with their burst; the closure before it, when the lips of a p
// are shut and nothing is heard, counts as the end of the sound before. Moves their begin to where
// the silence begins, and that of a stop after a pause by usual_closure into the pause. To be
// called before words are given their times.
void include_closures(Speech& speech);

inline constexpr double usual_closure = 0.04;  // seconds; where it cannot be heard

// Null with one sentence in `error` when the answer is an error or makes no sense.
std::shared_ptr<const Speech> read_speech_answer(const SpeechRequest& request,
                                                 std::string_view json_text,
                                                 std::vector<int16_t> pcm, std::string& error);

}  // namespace wellspring::avatar
