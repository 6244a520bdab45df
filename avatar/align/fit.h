// SPDX-License-Identifier: Apache-2.0
// Whether a recording says a text at all.
#pragma once
#include "avatar/speech/sound_file.h"
#include "avatar/speech/speech.h"

namespace wellspring::avatar {

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
