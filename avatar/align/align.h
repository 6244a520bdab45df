// SPDX-License-Identifier: Apache-2.0
// Marks for a narrator's recording: when each word and phoneme of a text comes in it.
//
// The text as a synthesiser says it is the template. Both sounds become mel cepstra; dynamic time
// warping (Sakoe & Chiba 1978), coarse first and then within a band around the coarse way, finds
// which moment of the template each moment of the recording is. It may leave out pauses and sounds
// that are not in the text (a cough, an introduction) between words, silence within them, and go
// back: a word, or what was said of it, or the word before may be said again, as often as a speaker
// who stutters does. The last time counts. From that first way the
// narrator's own phonemes are learnt: Gaussians over the recording's frames, held to the
// template's frames where there are few (maximum a posteriori, Gauvain & Lee 1994), three states a
// phoneme; the recording is divided anew by them, a few times (Viterbi training).
#pragma once
#include <string>

#include "avatar/speech/sound_file.h"
#include "avatar/speech/speech.h"

namespace wellspring::avatar {

// Text, language, words and phonemes of `spoken`, sound and times of `recording`. Blocks for one to
// three seconds a minute of recording and takes some 25 MB a minute. Throws std::runtime_error with
// one sentence when there is no way: a recording without sound, or one far too short for the text.
Speech align_speech(const Speech& spoken, const Sound& recording);

// How much slower (> 1) the recording is than the template, pauses left out; 0.3 to 3. Templates at
// the narrator's own speed are met better.
double measure_pace(const Speech& spoken, const Sound& recording);

}  // namespace wellspring::avatar
