// SPDX-License-Identifier: Apache-2.0
// What a picture may show, by bounds alone.
#pragma once
#include "show/state/show.h"

namespace wellspring::show {

// Whether a sphere touches the cone around the view's pyramid; says yes rather too often than too
// seldom.
bool in_view(const View& view, vec3 centre, float radius);

// Where the visitor looks from the place where it stands; a kiosk's page from its viewpoint.
View rest_view(const Show& show, const Visitor& visitor);
// Where the visitor looks now: through a kiosk's screen from where its guest's head is.
View view_of(const Show& show, const Visitor& visitor);

// The teller's head, or any of it, may be in that picture. False while it is hidden.
bool sees_head(const Show& show, const Teller& teller, const View& view);
bool sees_figure(const Show& show, const Teller& teller, const View& view);

// Who moves the teller's lips besides its own voice: of its visitors on a tour that is told aloud
// now and who may see its face, the nearest; null: nobody.
const Visitor* heard_on_tour(const Show& show, const Teller& teller);
// What one of the teller's visitors went to look at closer who has it in view; null: nothing.
const PointOfInterest* looked_at_beside_her(const Show& show, const Teller& teller);

// Metres from the teller's head to the nearest of its visitors who may see it; far where nobody
// may.
float viewer_distance(const Show& show, const Teller& teller);

}  // namespace wellspring::show
