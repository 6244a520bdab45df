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

// Whether a recording says a text at all.

// How much better the text explains the recording than its own words in other orders do: their mean
// cost of a coarse alignment less the text's, in standard deviations of theirs. Of a recording of
// another text the order of the words is worth next to nothing (Student's t with fit_orders - 1
// degrees of freedom, times sqrt(1 + 1 / fit_orders), if all orders were alike; sentences have an
// order of long and short sounds in common, which makes it somewhat more). The more words, the more
// it is of the right text: 4 to 5 of 9 words, 10 and more of 19, 20 and more of 30. Texts with
// fewer than fit_words words are not judged: +inf. The same input gives the same answer.
double eval_fit(const Speech& spoken, const Sound& recording);

inline constexpr int fit_orders = 12, fit_words = 15;
// Quantile 0.9999 of t with 11 degrees of freedom, 5.45, times sqrt(13 / 12).
inline constexpr double least_fit = 5.7;

}  // namespace wellspring::avatar
