// SPDX-License-Identifier: Apache-2.0
// What a picture may show, by bounds alone.
#pragma once
#include "show/state/show.h"

namespace wellspring {

// Whether a sphere touches the cone around the view's pyramid; says yes rather too often than too
// seldom.
bool in_view(const View& view, vec3 centre, float radius);

// Where the visitor looks now.
View view_of(const Show& show, const Visitor& visitor);

// The storyteller's head, or any of it, may be in that picture. False while it is hidden.
bool sees_head(const Show& show, const View& view);
bool sees_figure(const Show& show, const View& view);

// Who moves the storyteller's lips besides its own voice: of the visitors on a tour that is told
// aloud now and who may see its face, the nearest; null: nobody.
const Visitor* heard_on_tour(const Show& show);

// Metres from the storyteller's head to the nearest visitor who may see it; far where nobody may.
float viewer_distance(const Show& show);

}  // namespace wellspring
