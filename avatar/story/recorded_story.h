// SPDX-License-Identifier: Apache-2.0
// Marks a story as a narrator has recorded it, in one sound: when each word of it comes, and the
// sound of every sentence.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "avatar/speech/process.h"
#include "avatar/speech/sound_file.h"
#include "avatar/story/story_script.h"

namespace wellspring::avatar {

// Returns the text such a recording says: a line for each sentence.
std::string text_of(const std::vector<StoryLine>& lines);

// Marks the recording: returns its words, phonemes and visemes, and its sound. `voice` gives
// language and voice of the template. Blocks for some seconds a minute of recording. Throws
// std::runtime_error with one sentence: a line that cannot be spoken, a sound without speech, or
// one that does not say this text.
Speech mark_recording(SpeechProcess& process, const std::vector<StoryLine>& lines,
                      const SpeechRequest& voice, const Sound& recording);

inline constexpr size_t most_marks_bytes = size_t(64) << 20;  // most bytes of such a file
// Puts marks from a file of speech_json, perhaps corrected by hand, together with the sound. Throws
// LoadError naming `file` if they belong to another text or to a sound of another length.
Speech apply_marks(std::string_view json, const std::string& file,
                   const std::vector<StoryLine>& lines, const Sound& recording);

// Returns places at which text and sound may not fit although most of the text does: sentences said
// in less than half or more than twice the time of the others by their letters, and words in the
// sound that the text does not have for more than 2 s.
std::vector<StoryNote> doubtful_places(const Speech& marked, const std::vector<StoryLine>& lines);

// Makes a speech for every line, out of the recording, cut in the middle of the silence between two
// sentences. `lead` seconds of that silence are left out at the beginning of each, as far as there
// is so much: a show is silent for so long before a sentence.
std::vector<std::shared_ptr<const Speech>> divide_recording(const Speech& marked,
                                                            const std::vector<StoryLine>& lines,
                                                            double lead);

}  // namespace wellspring::avatar
