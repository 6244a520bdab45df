// SPDX-License-Identifier: Apache-2.0
#include "workers/crew.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fmt/core.h>
#include <random>

#include "base/clock.h"
#include "base/log.h"

namespace wellspring::workers {
namespace {

// Seconds: from call to call; until who does not answer is gone.
constexpr double call_every = 1, gone_after = 3.5;
// Seconds for which an answer is worth having: of a walking visitor, of a picture at rest.
constexpr double worth_walking = 0.5, worth_resting = 2;
// Seconds of rest: of who refuses, who fetches maps meanwhile, who answers nonsense.
constexpr double refused_rest = 10, fetching_rest = 2, first_garbage_rest = 10,
                 most_garbage_rest = 600;            // seconds
constexpr uint64_t first_apart = uint64_t(1) << 63;  // numbers of visitors are smaller
constexpr int most_unanswered = 3;                   // orders
constexpr size_t most_inbox_bytes = 64 << 20, most_members = 1024, most_done = 1024,
                 most_asked = 256;

uint64_t random_number() {
  std::random_device random;
  return uint64_t(random()) << 32 | random();
}

bool is_passing(Refusal refusal) {
  return refusal == Refusal::light || refusal == Refusal::fetching;
}

bool are_same(const Sample& a, const Sample& b) {
  const auto same = [](const auto& x, const auto& y) { return std::memcmp(&x, &y, sizeof x) == 0; };
  return same(a.position, b.position) && same(a.normal, b.normal) && same(a.distance, b.distance) &&
         a.object == b.object && a.instance == b.instance && a.triangle == b.triangle &&
         same(a.barycentric, b.barycentric) && same(a.albedo, b.albedo) &&
         same(a.smooth, b.smooth) && same(a.rest, b.rest) && same(a.glow, b.glow) &&
         same(a.known, b.known) && same(a.raised, b.raised) && a.flags == b.flags;
}

}  // namespace

std::string orders_subject(std::string_view worker) {
  return fmt::format("wellspring.orders.{}", worker);
}

std::string answers_subject(uint64_t server) {
  return fmt::format("wellspring.answers.{:016x}", server);
}

Crew::Crew(CrewSettings settings, std::string exhibit, uint64_t scene, SampleBounds bounds)
    : settings_(std::move(settings)),
      exhibit_(std::move(exhibit)),
      scene_(scene),
      bounds_(std::move(bounds)),
      key_(make_message_key(settings_.secret)),
      server_(random_number()),
      answers_(answers_subject(server_)),
      shelf_(settings_.package, settings_.maps),
      channel_(settings_.channel,
               {{answers_, "", [this](auto message, auto reply_to) { hear(message, reply_to); }}}) {
}

void Crew::hear(std::string_view message, std::string_view reply_to) {
  std::lock_guard lock(mutex_);
  if (inbox_bytes_ + message.size() > most_inbox_bytes) return;  // nobody has asked for so much
  inbox_bytes_ += message.size();
  inbox_.push_back({seconds_now(), std::string(message), std::string(reply_to)});
}

bool Crew::is_asked(const Member& member, double now) const {
  return now - member.heard < gone_after && now >= member.rests_until &&
         member.unanswered < most_unanswered;
}

void Crew::rest(Member& member, const std::string& problem, double until) {
  if (member.problem != problem) log::warn("a worker is not asked for a while: {}", problem);
  member.problem = problem;
  member.rests_until = until;
}

void Crew::advance() {
  const double now = seconds_now();
  const bool connected = channel_.connected();
  std::unique_lock lock(mutex_);
  const std::deque<Heard> inbox = std::exchange(inbox_, {});
  inbox_bytes_ = 0;
  lock.unlock();
  for (const Heard& heard : inbox) {
    CallAnswer here;
    TraceAnswer answer;
    FileQuestion question;
    if (read_message(heard.message, key_, here)) take_call_answer(here, heard.came);
    else if (read_message(heard.message, key_, answer)) take_answer(std::move(answer), heard.came);
    else if (read_message(heard.message, key_, question)) {
      if (question.server == server_ && !heard.reply_to.empty() && asked_.size() < most_asked)
        asked_.push_back({question, heard.reply_to});
    } else {
      lock.lock();
      totals_.spoiled++;
      lock.unlock();
    }
  }
  answer_questions();
  lock.lock();
  give_up(now);
  std::erase_if(members_, [&](const auto& one) {
    return now - one.second.heard > 60 && now > one.second.rests_until;
  });
  if (!connected || now - called_ < call_every) return;
  called_ = now;
  const RollCall call{server_, ++calls_};
  lock.unlock();
  channel_.send(call_subject, answers_, write_message(call, key_));
}

// Files are read on a thread of their own.
void Crew::answer_questions() {
  if (asked_.empty() || librarian_.busy()) return;
  librarian_.run([this, asked = std::exchange(asked_, {})] {
    for (const Asked& one : asked)
      channel_.send(one.reply_to, "", write_message(shelf_.answer(one.question), key_));
  });
}

void Crew::take_call_answer(const CallAnswer& answer, double now) {
  std::lock_guard lock(mutex_);
  if (answer.server != server_ || answer.number != calls_) return;
  if (!members_.contains(answer.worker) && members_.size() >= most_members) return;
  const bool known = members_.contains(answer.worker);
  Member& member = members_[answer.worker];
  if (!known) log::info("worker {}: {} cores, {}", answer.worker, answer.cores, answer.version);
  member.cores = int(answer.cores);
  member.same_bits = answer.instructions == instruction_set();
  member.heard = now;
  member.unanswered = 0;
  if (now >= member.rests_until) member.problem.clear();
  note_called(member.pace, now - called_);
}

void Crew::take_answer(TraceAnswer answer, double now) {
  std::lock_guard lock(mutex_);
  auto found = answer.server == server_ ? orders_.find(answer.number) : orders_.end();
  if (found == orders_.end() || found->second.worker != answer.worker) {
    totals_.late += answer.samples.size();
    return;
  }
  Order order = std::move(found->second);
  orders_.erase(found);
  auto who = members_.find(order.worker);
  if (who == members_.end()) {
    totals_.lost += uint64_t(order.requests);
    return;
  }
  Member& member = who->second;
  member.heard = now;
  member.unanswered = 0;
  if (answer.refusal != Refusal::none) {
    totals_.refused[size_t(answer.refusal)] += uint64_t(order.requests);
    note_unanswered(member.pace, order.requests, order.errand.rests);
    // Who is merely late or busy is asked for less, others not at all.
    if (answer.refusal != Refusal::late && answer.refusal != Refusal::busy)
      rest(member, fmt::format("{} refuses: {}", order.worker, to_word(answer.refusal)),
           now + (is_passing(answer.refusal) ? fetching_rest : refused_rest));
    return;
  }
  if (answer.samples.size() != size_t(order.requests) || !are_within(answer.samples, bounds_)) {
    totals_.spoiled++;
    lose(member, order);
    member.rest = std::clamp(2 * member.rest, first_garbage_rest, most_garbage_rest);
    rest(member, fmt::format("{} answers what cannot be", order.worker), now + member.rest);
    return;
  }
  note_answered(member.pace, order.requests, order.errand.rests, now - order.sent,
                double(answer.waited), double(answer.traced));
  member.samples += answer.samples.size();
  take_samples(std::move(order), std::move(answer.samples), member.same_bits);
}

// The lock is held.
void Crew::verify(const std::vector<Sample>& here, const std::vector<Sample>& there,
                  bool same_bits) {
  for (size_t i = 0; i < here.size(); i++) {
    if (same_bits) {
      totals_.verified++;
      totals_.differing += !are_same(here[i], there[i]);
      continue;
    }
    const vec3 light = there[i].radiance();
    const vec3 others = light - here[i].radiance();
    const double off = double(others.x + others.y + others.z) / 3;
    totals_.alike++;
    totals_.alike_light += double(light.x + light.y + light.z) / 3;
    totals_.alike_difference += off, totals_.alike_squares += off * off;
  }
}

double CrewTotals::alike_deviation() const {
  const double count = double(alike);
  if (count < 2) return 0;
  const double mean = alike_difference / count;
  const double variance = std::max(alike_squares / count - mean * mean, 0.0);
  return variance > 0 ? mean / std::sqrt(variance / count) : 0;
}

// The lock is held.
void Crew::take_samples(Order order, std::vector<Sample> samples, bool same_bits) {
  totals_.samples += samples.size();
  if (!order.expected.empty()) verify(order.expected, samples, same_bits);
  std::vector<CrewSamples>* done = &done_;
  if (order.errand.asker >= first_apart) {
    const auto apart = apart_.find(order.errand.asker);
    if (apart == apart_.end()) return;
    done = &apart->second;
  }
  if (done->size() >= most_done) return;  // nobody takes them
  CrewSamples delivery{order.errand.asker, order.errand.rests, {}};
  auto next = samples.begin();
  for (cache::Piece& piece : order.pieces) {
    const auto end = next + std::ptrdiff_t(piece.requests.size());
    delivery.answers.push_back({std::move(piece), order.errand.pose, {next, end}});
    next = end;
  }
  done->push_back(std::move(delivery));
}

// The lock is held.
void Crew::lose(Member& member, const Order& order) {
  totals_.lost += uint64_t(order.requests);
  member.lost += uint64_t(order.requests);
  note_unanswered(member.pace, order.requests, order.errand.rests);
}

// The lock is held.
void Crew::give_up(double now) {
  for (auto it = orders_.begin(); it != orders_.end();) {
    const Order& order = it->second;
    if (now < order.until) {
      ++it;
      continue;
    }
    if (auto who = members_.find(order.worker); who == members_.end()) {
      totals_.lost += uint64_t(order.requests);
    } else {
      lose(who->second, order);
      if (++who->second.unanswered == most_unanswered)
        who->second.problem = fmt::format("{} does not answer", order.worker);
    }
    it = orders_.erase(it);
  }
}

int Crew::room(bool rests) const {
  if (!channel_.connected()) return 0;
  std::lock_guard lock(mutex_);
  const double now = seconds_now();
  int room = 0;
  for (const auto& [name, member] : members_)
    if (is_asked(member, now)) room += room_for(member.pace, rests);
  return room;
}

int Crew::send(Broker& broker, const Errand& errand, int most, const TraceHere& trace) {
  if (!channel_.connected()) return 0;
  const double now = seconds_now();
  std::lock_guard lock(mutex_);
  // Workers have one set of maps.
  if (errand.asker < first_apart) light_ = errand.light;
  else if (light_ != 0 && light_ != errand.light) return 0;
  std::vector<std::pair<const std::string, Member>*> asked;
  std::vector<int> rooms;
  for (auto& one : members_) {
    if (!is_asked(one.second, now)) continue;
    asked.push_back(&one);
    rooms.push_back(room_for(one.second.pace, errand.rests));
  }
  int left = most;
  for (const OrderPlan& plan : share_out(rooms, most)) {
    auto& [name, member] = *asked[plan.worker];
    const uint64_t before = member.pace.in_flight;
    const int size = std::min(left, plan.requests);
    if (size <= 0 || !send_order(broker, errand, name, member, size, trace)) break;
    left -= int(member.pace.in_flight - before);
  }
  return most - left;
}

// Sends one order of at most about `most` requests; false: the broker has no more, or the line
// takes none. The lock is held.
bool Crew::send_order(Broker& broker, const Errand& errand, const std::string& name, Member& member,
                      int most, const TraceHere& trace) {
  const double now = seconds_now();
  Order sent{name, errand, {}, {}, now, 0, 0};
  TraceOrder order;
  while (sent.requests < most) {
    std::optional<cache::Piece> piece = broker.take();
    if (!piece) break;
    order.requests.insert(order.requests.end(), piece->requests.begin(), piece->requests.end());
    sent.requests += int(piece->requests.size());
    if (settings_.verifies) {
      const std::vector<Sample> here = trace(*piece);
      sent.expected.insert(sent.expected.end(), here.begin(), here.end());
    }
    sent.pieces.push_back(std::move(*piece));
  }
  if (sent.pieces.empty()) return false;
  const TraceJob& job = sent.pieces.front().order;
  const double worth = errand.rests ? worth_resting : worth_walking;
  order.server = server_;
  order.number = ++numbers_;
  order.worth_ms = uint32_t(1000 * worth);
  order.exhibit = exhibit_;
  order.same = {settings_.version, instruction_set(), scene_, errand.light};
  order.exact = settings_.exact;
  order.plain = errand.plain;
  order.technique = job.technique->name;
  order.transport = job.transport;
  order.state = errand.state;
  totals_.requests += uint64_t(sent.requests);
  if (!channel_.send(orders_subject(name), answers_, write_message(order, key_))) {
    totals_.lost += uint64_t(sent.requests);
    return false;
  }
  sent.until = now + worth + member.pace.line;
  totals_.orders++;
  note_sent(member.pace, sent.requests, errand.rests);
  orders_.emplace(order.number, std::move(sent));
  return true;
}

std::vector<CrewSamples> Crew::take() {
  std::lock_guard lock(mutex_);
  return std::exchange(done_, {});
}

uint64_t Crew::begin_apart() {
  std::lock_guard lock(mutex_);
  const uint64_t asker = first_apart + ++numbers_;
  apart_[asker];
  return asker;
}

void Crew::end_apart(uint64_t asker) {
  std::lock_guard lock(mutex_);
  apart_.erase(asker);
}

std::vector<CrewSamples> Crew::take_apart(uint64_t asker) {
  std::lock_guard lock(mutex_);
  const auto found = apart_.find(asker);
  return found == apart_.end() ? std::vector<CrewSamples>() : std::exchange(found->second, {});
}

CrewReport Crew::report() const {
  CrewReport report;
  report.used = true;
  report.connected = channel_.connected();
  const double now = seconds_now();
  std::lock_guard lock(mutex_);
  report.totals = totals_;
  report.totals.dropped = channel_.dropped();
  for (const auto& [name, member] : members_) {
    WorkerReport one{name,
                     member.problem,
                     member.same_bits,
                     member.cores,
                     member.pace.rate,
                     member.pace.line,
                     member.pace.share,
                     member.pace.in_flight,
                     member.samples,
                     member.lost};
    if (one.problem.empty() && now - member.heard >= gone_after) one.problem = name + " is gone";
    report.workers.push_back(std::move(one));
  }
  return report;
}

}  // namespace wellspring::workers
