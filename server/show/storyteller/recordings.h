// SPDX-License-Identifier: Apache-2.0
// Recorded narration of an exhibit's texts: which words come when in it, so that lips, subtitles
// and marks go with the sound. Found by alignment, which takes seconds a minute of recording, and
// kept.
#pragma once
#include "avatar/speech/process.h"
#include "show/exhibit/exhibit.h"
#include "show/exhibit/json_fields.h"

namespace wellspring::show {

struct RecordingOptions {
  std::string
      cache;  // folder that keeps what has been found; made if missing; empty: nothing is kept
  VoiceProgram voice;
};

// Reads every recording that the exhibit names and gives its sentences their parts of it
// (StoryLine::recording). Marks come from the file NAME.marks.json beside the recording NAME.ext,
// which people may edit, else from the cache, else from an alignment. Problems are noted with their
// file: a recording that cannot be read, that does not say its text, or whose edited marks do not
// fit it are fatal; sentences that may not go together with it are not.
void read_recordings(Exhibit& exhibit, const RecordingOptions& options,
                     std::vector<Problem>& problems);

// Marks of one recording as the file beside it would hold them: for `speak --story --audio --json`.
std::string marks_file_of(const std::string& recording);

}  // namespace wellspring::show
