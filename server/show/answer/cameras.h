// SPDX-License-Identifier: Apache-2.0
// The kiosks' cameras, as they come, speak and go. A camera is known by the name that its kiosk
// gives it: one that comes back under its name is the one that went. Until then a lost one stays
// listed, so that a technician can read since when there has been no connection, and is forgotten
// after a week. One without a name cannot come back: it goes with its connection.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "show/state/show.h"
#include "wire/json.h"
#include "wire/link.h"
#include "wire/tokens.h"

namespace wellspring::show {

// Who is believed to be a kiosk of the house: whoever comes from the machine that serves, and
// whoever shows a kiosk's token. A token that is for one kiosk by name is good for no other.

// Checks a `hello` with the role kiosk, or with a part in a wall, for which any kiosk's token is
// good; others need no trust. `kiosk` becomes the name of the kiosk that it speaks for. Returns
// `not_trusted`, and what to do, otherwise; `bad_field` for a part that cannot be.
std::optional<WireError> check_page(const std::vector<Token>& kiosk_tokens, const Link& link,
                                    const Hello& hello, std::string& kiosk);
// Checks an observation of a camera that was let in. If its token names a kiosk, the observation
// need not.
std::optional<WireError> check_camera(const Link& link, Observation& seen);

inline constexpr double lost_camera_listed = 7 * 24 * 3600;  // seconds
inline constexpr size_t most_lost_cameras = 32;  // more: the one longest lost is forgotten
// More are told so and sent away: of an exhibit, and of one kiosk.
inline constexpr size_t most_cameras = 64, most_kiosk_cameras = 8;

void welcome_camera(ShowKiosks& kiosks, double time, std::shared_ptr<Link> link);
// Takes in what cameras have said since the last call.
void read_cameras(ShowKiosks& kiosks, ShowTotals& totals, double time);
size_t connected_cameras(const ShowKiosks& kiosks);
bool is_lost(const Eye& eye);
bool is_silent(const Eye& eye, double now);  // it says nothing, connected or not

}  // namespace wellspring::show
