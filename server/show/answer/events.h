// SPDX-License-Identifier: Apache-2.0
// The server's words to a browser: JSON text of welcome, state, subtitle, agent and kiosk. Pure
// functions.
#pragma once
#include <string>

#include "show/exhibit/exhibit.h"
#include "show/state/show.h"
#include "show/state/visitor.h"

namespace wellspring {

std::string welcome_message(const Show& show, const Visitor& visitor);
std::string state_message(const Show& show, const Visitor& visitor);
// Empty text: the subtitle disappears.
std::string subtitle_message(const std::string& text, const std::string& lang,
                             const std::string& speaker, float seconds);
// An utterance that is heard: what, when each word of it comes (seconds from its first sample), and
// where.
std::string speech_message(uint32_t utterance, const Speech& speech, dvec3 mouth);
std::string speech_stop_message(uint32_t utterance);
std::string agent_message(const Show& show);
std::string kiosk_message(const Audience& audience, size_t cameras);

}  // namespace wellspring
