// SPDX-License-Identifier: Apache-2.0
// Where the screens of kiosks are in the exhibit.
#pragma once
#include <string>

#include "show/state/show.h"

namespace wellspring::show {

// Where a kiosk's screen is a window: its own viewpoint, that of its storyteller, or of whoever is
// there; the exhibit's start where there is nobody. Index into Exhibit::viewpoints.
int kiosk_viewpoint(const Show& show, const std::string& kiosk);
View kiosk_window(const Show& show, const std::string& kiosk);

// A step of a kiosk's page: while it stands at the kiosk's viewpoint, its picture is seen from
// where the head before the screen is (show/kiosk/screen_window.h), as far as no wall is in the
// way.
void look_through(const Show& show, Visitor& page, float dt);

}  // namespace wellspring::show
