// SPDX-License-Identifier: Apache-2.0
#include "show/answer/cameras.h"

#include <algorithm>

#include "base/log.h"
#include "show/wall/wall.h"
#include "wire/json.h"

namespace wellspring::show {

namespace {

// `own`: of the only kiosk that a token is for; empty: of any.
std::optional<WireError> check_name(const std::string& own, std::string& kiosk) {
  if (own.empty() || kiosk == own) return {};
  if (!kiosk.empty())
    return WireError{"not_trusted", "this token is for another kiosk than the one that is named"};
  kiosk = own;
  return {};
}

}  // namespace

std::optional<WireError> check_page(const std::vector<Token>& kiosk_tokens, const Link& link,
                                    const Hello& hello, std::string& kiosk) {
  kiosk = hello.kiosk;
  const bool is_kiosk = hello.role == "kiosk";
  if (!is_kiosk && !hello.wall) return {};
  if (hello.wall)
    if (const char* wrong = check_part(*hello.wall)) return WireError{"bad_field", wrong};
  const Token* token = find_token(kiosk_tokens, hello.token);
  if (token) return is_kiosk ? check_name(token->name, kiosk) : std::nullopt;
  if (link.local) return {};
  if (!is_kiosk)
    return WireError{
        "not_trusted",
        "a wall's screen on another machine needs a kiosk token: open /wall?...#token=..."};
  return WireError{
      "not_trusted",
      "a kiosk's screen on another machine needs a kiosk token: open /kiosk#token=..."};
}

std::optional<WireError> check_camera(const Link& link, Observation& seen) {
  return check_name(link.kiosk, seen.kiosk);
}

bool is_lost(const Eye& eye) { return eye.gone >= 0; }
bool is_silent(const Eye& eye, double now) { return now - eye.received > observation_lifetime; }

namespace {

// The lost or silent camera of the same name makes way for the one that has come back.
void come_back(ShowKiosks& kiosks, double time, Eye& eye) {
  auto same = std::ranges::find_if(kiosks.eyes, [&](const Eye& other) {
    return &other != &eye && other.seen.name == eye.seen.name &&
           (is_lost(other) || is_silent(other, time));
  });
  if (same == kiosks.eyes.end()) return;
  log::info("kiosk camera {} is back", eye.seen.name);
  same->link->close("the same camera has connected again");
  eye.number = same->number;
  same->number = 0;  // to be erased
}

// As many cameras of its kiosk as there may be are at work.
bool is_kiosk_full(const ShowKiosks& kiosks, double time, const Eye& eye,
                   const std::string& kiosk) {
  return size_t(std::ranges::count_if(kiosks.eyes, [&](const Eye& other) {
           return &other != &eye && other.observations > 0 && other.seen.kiosk == kiosk &&
                  !is_lost(other) && !is_silent(other, time);
         })) >= most_kiosk_cameras;
}

// Takes in what a camera said; returns the error that it is told.
std::optional<WireError> take_in(ShowKiosks& kiosks, ShowTotals& totals, double time, Eye& eye,
                                 Heard& heard) {
  if (const WireError* bad = std::get_if<WireError>(&heard.said)) return *bad;
  Observation& seen = std::get<Observation>(heard.said);
  if (auto wrong = check_camera(*eye.link, seen)) return wrong;
  const bool moves = eye.observations == 0 || seen.kiosk != eye.seen.kiosk;
  if (moves && is_kiosk_full(kiosks, time, eye, seen.kiosk)) {
    eye.link->close("too many cameras");
    return WireError{"too_many_cameras", "this kiosk has as many cameras as it may have"};
  }
  if (is_silent(eye, time) || seen.camera != eye.seen.camera) eye.camera_since = time;
  const bool named = !seen.name.empty() && seen.name != eye.seen.name;
  eye.seen = std::move(seen);
  eye.received = time;
  eye.observations++;
  totals.observations++;
  if (named) come_back(kiosks, time, eye);
  return {};
}

void read_texts(ShowKiosks& kiosks, ShowTotals& totals, double time, Eye& eye) {
  for (Heard& heard : eye.link->take_heard()) {
    const auto wrong = take_in(kiosks, totals, time, eye, heard);
    if (!wrong) continue;
    eye.refused++;
    totals.refused_messages++;
    eye.link->send_text(write_error(*wrong));
  }
}

}  // namespace

void welcome_camera(ShowKiosks& kiosks, double time, std::shared_ptr<Link> link) {
  if (connected_cameras(kiosks) >= most_cameras) {
    link->send_text(
        write_error({"too_many_cameras", "this exhibit has as many cameras as it may have"}));
    link->close("too many cameras");
    return;
  }
  log::info("kiosk camera {} connected from {}", link->id, link->peer);
  Eye eye{std::move(link), {}, -1e9, time};
  auto is_taken = [&](const Eye& other) { return other.number == eye.number; };
  while (std::ranges::any_of(kiosks.eyes, is_taken)) eye.number++;
  kiosks.eyes.push_back(std::move(eye));
}

void read_cameras(ShowKiosks& kiosks, ShowTotals& totals, double time) {
  for (Eye& eye : kiosks.eyes) {
    read_texts(kiosks, totals, time, eye);
    if (is_lost(eye) || !eye.link->closed()) continue;
    log::info("kiosk camera {} disconnected", eye.link->id);
    eye.gone = time;
  }
  std::erase_if(kiosks.eyes, [&](const Eye& eye) {
    return eye.number == 0 ||
           (is_lost(eye) && (eye.seen.name.empty() || time - eye.gone > lost_camera_listed));
  });
  while (kiosks.eyes.size() - connected_cameras(kiosks) > most_lost_cameras)
    kiosks.eyes.erase(std::ranges::min_element(
        kiosks.eyes, {}, [&](const Eye& eye) { return is_lost(eye) ? eye.gone : time + 1; }));
}

size_t connected_cameras(const ShowKiosks& kiosks) {
  return size_t(std::ranges::count_if(kiosks.eyes, [](const Eye& eye) { return !is_lost(eye); }));
}

}  // namespace wellspring::show
