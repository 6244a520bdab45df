// SPDX-License-Identifier: Apache-2.0
// The server's words to a browser: JSON text of welcome, state, subtitle, agent, kiosk, house
// and announce. Pure functions.
#pragma once
#include <optional>
#include <string>

#include "show/exhibit/exhibit.h"
#include "show/state/show.h"
#include "show/state/visitor.h"

namespace wellspring::show {

// `resumed`: the visit goes on where it was.
std::string welcome_message(const Show& show, const Visitor& visitor, bool resumed = false);
std::string state_message(const Show& show, const Visitor& visitor);
// Tells a page that moves its own camera where the visitor is now.
std::string pose_message(const ExhibitStage& stage, const ShowVisits& visits,
                         const Visitor& visitor);
// Holds two places of a scan in the coordinates of its file (file_to_world()).
struct ScanPlaces {
  std::string piece;
  dvec3 from{0}, to{0};
};
std::string measured_message(uint32_t id, double metres, const std::optional<ScanPlaces>& places);
// The visitor is on its way to an eye's `place`, or has leapt there (0 seconds); to look closer at
// `object`, if that is not empty.
std::string went_message(uint32_t seq, const std::string& object, dvec3 place, double seconds);
// Empty text: the subtitle disappears.
std::string subtitle_message(const std::string& text, const std::string& lang,
                             const std::string& speaker, float seconds);
// An utterance that is heard: what, when each word of it comes (seconds from its first sample), and
// where.
std::string speech_message(uint32_t utterance, const Speech& speech, dvec3 mouth);
std::string speech_stop_message(uint32_t utterance);
std::string agent_message(const Show& show, const Teller& teller);
// Describes all kiosks together, for visitors, or one, for its page.
std::string kiosk_message(const ShowKiosks& kiosks);
std::string kiosk_message(const Show& show, const Kiosk& kiosk);
// To a page that nobody may be at: asked, with the seconds to answer within, here or paused.
std::string idle_message(const char* state, double seconds);
// To kiosks' pages. `reload`: the page shall begin anew.
std::string house_message(const Show& show, bool reload);
// To all pages. `seconds`: that are left of it.
std::string announce_message(const Announcement& announcement, double seconds);

// Says what the storyteller answers to a question, and why.
std::string reply_message(const ExhibitStage& stage, const Visitor& visitor,
                          const std::string& question, const FoundAnswer& found,
                          const LocalScript& said);

}  // namespace wellspring::show
