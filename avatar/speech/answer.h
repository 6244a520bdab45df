// SPDX-License-Identifier: Apache-2.0
// Turns an answer of the voice program into a Speech. The other side may be broken: all that it
// sends is checked.
#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "avatar/speech/protocol.h"
#include "avatar/speech/speech.h"

namespace wellspring::avatar {

// Gives p, t and k the silence that belongs to them.

// Moves the begin of eSpeak NG's voiceless stops, which is at their burst: the closure before it,
// when the lips of a p are shut and nothing is heard, counts as the end of the sound before. A stop
// then begins with the silence, a stop after a pause by usual_closure within the pause. To be
// called before words are given their times.
void include_closures(Speech& speech);

inline constexpr double usual_closure = 0.04;  // seconds, for closures that cannot be heard

// Returns null with one sentence in `error` when the answer is an error or makes no sense.
std::shared_ptr<const Speech> read_speech_answer(const SpeechRequest& request,
                                                 std::string_view json_text,
                                                 std::vector<int16_t> pcm, std::string& error);

}  // namespace wellspring::avatar
