// SPDX-License-Identifier: Apache-2.0
// Finds when each word and phoneme of a text comes in a narrator's recording.
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

// Returns text, language, words and phonemes of `spoken` with sound and times of `recording`.
// Blocks for one to three seconds a minute of recording and takes some 25 MB a minute. Throws
// std::runtime_error with one sentence when there is no way: a recording without sound, or one far
// too short for the text.
Speech align_speech(const Speech& spoken, const Sound& recording);

// Returns how much slower (> 1) the recording is than the template, pauses left out; 0.3 to 3.
// Templates at the narrator's own speed are met better.
double measure_pace(const Speech& spoken, const Sound& recording);

// Judges whether a recording says a text at all.

// Returns how much better the text explains the recording than its own words in other orders do:
// the mean cost of their coarse alignments less the text's, in standard deviations of their costs.
// If the recording is of another text, the order of the words is worth next to nothing (Student's t
// with fit_orders - 1 degrees of freedom, times sqrt(1 + 1 / fit_orders), if all orders were alike;
// sentences have an order of long and short sounds in common, which makes it somewhat more). For
// the right text the answer grows with the number of words: 4 to 5 for 9 words, 10 and more for 19,
// 20 and more for 30. Texts with fewer than fit_words words are not judged: +inf. The same input
// gives the same answer.
double eval_fit(const Speech& spoken, const Sound& recording);

inline constexpr int fit_orders = 12, fit_words = 15;
// This is the quantile 0.9999 of t with 11 degrees of freedom, 5.45, times sqrt(13 / 12).
inline constexpr double least_fit = 5.7;

}  // namespace wellspring::avatar
