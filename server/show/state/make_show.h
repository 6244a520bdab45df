// SPDX-License-Identifier: Apache-2.0
// The beginning of a show, and of a storyteller.
#pragma once
#include <memory>

#include "show/state/show.h"

namespace wellspring::show {

// Takes the exhibit over. Throws std::invalid_argument for an unknown technique, ExhibitError for a
// tour that cannot be walked. Seconds; may be cancelled (base/worker.h).
std::unique_ptr<Show> make_show(Exhibit exhibit, const ShowSettings& settings);

// Another storyteller comes in place of the one that is there, who falls silent; knows nobody yet
// and greets anew. Nothing happens when it is there already. It is seen from the next picture on.
void change_storyteller(const Show& show, Teller& teller, size_t storyteller_index);

}  // namespace wellspring::show
