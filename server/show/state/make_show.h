// SPDX-License-Identifier: Apache-2.0
// Begins a show, and puts storytellers into it.
#pragma once
#include <memory>

#include "show/state/show.h"

namespace wellspring::show {

// Takes the exhibit over. Throws std::invalid_argument for an unknown technique, ExhibitError for a
// tour that cannot be walked. Takes seconds; may be cancelled (base/worker.h).
std::unique_ptr<Show> make_show(Exhibit exhibit, const ShowSettings& settings);

// Adds the visit of a link that has said nothing yet.
Visitor& begin_visit(Show& show, std::shared_ptr<Link> link);

// Puts another storyteller in place of the present one, which falls silent. The new one knows
// nobody yet and greets anew; it is seen from the next picture on. Does nothing if it is there
// already.
void change_storyteller(const ExhibitStage& stage, const ShowCast& cast, Teller& teller,
                        size_t storyteller_index);

}  // namespace wellspring::show
