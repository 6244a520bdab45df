// SPDX-License-Identifier: Apache-2.0
#include "kiosk/gesture/spot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>

namespace wellspring::kiosk {

namespace {

constexpr float no_score = -1e30f;
constexpr long longest = 150;    // steps that a gesture may have: 9 shoulder widths
constexpr long look = 4;         // steps to either side that show an edge
constexpr float hopeless = -12;  // nats below other motion: no gesture begins here

// Holds a gesture's states with their logarithms.
struct Followed {
  const GestureModel* model;
  size_t first = 0;  // token of its first state
  std::vector<float> stay, next;
  std::vector<std::array<float, orientation_codes>> output;
};

struct Token {
  float score = no_score;
  std::array<int16_t, most_states> entry{};  // steps from the beginning to each state
};

// This is a place where a gesture may have begun.
struct Beginning {
  long first = 0;  // number of its first step
  std::vector<Token> tokens;
  std::vector<float> other;
  float ahead = 0;  // the best gesture's difference now, in any state
};

struct Found {
  const GestureModel* model = nullptr;
  long first = 0, last = 0;
  double score = 0, difference = 0;  // with and without evidence
};

}  // namespace

struct GestureSpotter::Impl {
  SpotSettings settings;
  std::vector<Followed> gestures;
  size_t tokens = 0;
  std::vector<float> other_initial, other_stay, other_leave;
  std::vector<std::array<float, orientation_codes>> other_output;
  OrientationCoder coder;
  std::deque<CodedStep> steps;  // the newest ones; the last has number made - 1
  long made = 0;                // steps ever made
  long count = 0;               // number of steps that the models have followed
  long motion = 0;              // number of the first step of this motion
  std::vector<Beginning> beginnings;
  Found found, found_dwelling;  // the latter requires a rest, too
  std::vector<CodedStep> fresh;

  Impl(const GestureModels& models, const SpotSettings& s) : settings(s) {
    auto ln = [](double p) { return p > 0 ? float(std::log(p)) : no_score; };
    auto ln_rows = [&](const Hmm& hmm) {
      std::vector<std::array<float, orientation_codes>> rows(size_t(hmm.states));
      for (size_t i = 0; i < rows.size(); i++)
        for (size_t o = 0; o < orientation_codes; o++) rows[i][o] = ln(hmm.output[i][o]);
      return rows;
    };
    for (const GestureModel& model : models.gestures) {
      Followed g{&model, tokens, {}, {}, ln_rows(model.hmm)};
      for (int i = 0; i < model.hmm.states; i++) {
        g.stay.push_back(ln(model.hmm.at(i, i)));
        g.next.push_back(i + 1 < model.hmm.states ? ln(model.hmm.at(i, i + 1)) : no_score);
      }
      tokens += g.stay.size();
      gestures.push_back(std::move(g));
    }
    const Hmm& other = models.other;
    other_output = ln_rows(other);
    for (int i = 0; i < other.states; i++) {
      other_initial.push_back(ln(other.initial[size_t(i)]));
      other_stay.push_back(ln(other.at(i, i)));
      other_leave.push_back(other.states > 1 ? ln(other.at(i, (i + 1) % other.states)) : no_score);
    }
  }

  // Follows other motion. All its states lead to each other alike, so the best and the second best
  // that are left are enough. Returns the best score.
  float follow_other(std::vector<float>& delta, Code code, bool first) const {
    float best = no_score;
    if (first) {
      for (size_t i = 0; i < delta.size(); i++) {
        delta[i] = other_initial[i] + other_output[i][code];
        best = std::max(best, delta[i]);
      }
      return best;
    }
    float left = no_score, left_second = no_score;
    size_t from = 0;
    for (size_t i = 0; i < delta.size(); i++) {
      const float score = delta[i] + other_leave[i];
      if (score > left) left_second = left, left = score, from = i;
      else left_second = std::max(left_second, score);
    }
    for (size_t i = 0; i < delta.size(); i++) {
      const float moved = i == from ? left_second : left;
      delta[i] = std::max(delta[i] + other_stay[i], moved) + other_output[i][code];
      best = std::max(best, delta[i]);
    }
    return best;
  }

  // Follows a gesture. Returns the best score of any state; `age` counts the steps since the
  // beginning.
  static float follow(const Followed& g, Token* token, Code code, long age) {
    const size_t states = g.stay.size();
    float best = no_score;
    for (size_t j = states; j-- > 0;) {
      if (age == 0) token[j].score = j == 0 ? 0 : no_score;
      else {
        const float kept = token[j].score + g.stay[j];
        const float moved = j > 0 ? token[j - 1].score + g.next[j - 1] : no_score;
        if (moved > kept) {
          token[j] = token[j - 1];
          token[j].score = moved;
          token[j].entry[j] = int16_t(age);
        } else token[j].score = kept;
      }
      token[j].score = std::max(no_score, token[j].score + g.output[j][code]);
      best = std::max(best, token[j].score);
    }
    return best;
  }

  void consider(const Followed& g, const Beginning& from, const Token& last, double difference) {
    const ptrdiff_t oldest = ptrdiff_t(made) - ptrdiff_t(steps.size());
    scratch.assign(steps.begin() + (from.first - oldest), steps.begin() + (count - oldest));
    entries.assign(last.entry.begin(), last.entry.begin() + ptrdiff_t(g.stay.size()));
    entries[0] = 0;
    const double score =
        settings.evidence > 0
            ? difference +
                  settings.evidence * eval_evidence(*g.model, measure_motion(scratch, entries))
            : difference;
    Found& best = g.model->dwell > 0 ? found_dwelling : found;
    const double usual = g.model->usual_difference + settings.evidence * g.model->usual_evidence;
    if (score > std::max(g.model->least, settings.margin * usual) &&
        (!best.model || score > best.score))
      best = {g.model, from.first, count - 1, score, difference};
  }
  std::vector<CodedStep> scratch;
  std::vector<int> entries;

  const CodedStep& step_at(long number) const {
    return steps[size_t(number - (made - long(steps.size())))];
  }

  // Returns whether a gesture can begin with this step, or end before it: if motion begins or ends,
  // the hand turns, or it slows (Kang, Lee, Jung 2004, section 3).
  bool is_edge(long number, bool over) const {
    if (number <= motion || (number >= made && over)) return true;
    const long low = std::max(motion, number - look), high = std::min(made, number + look);
    const vec2 before = step_at(number - 1).to - step_at(std::max(low, number - 3)).from;
    const vec2 after = step_at(std::min(high, number + 3) - 1).to - step_at(number).from;
    constexpr float turned = 0.64f;  // cosine of 50 degrees
    if (glm::dot(before, after) < turned * glm::length(before) * glm::length(after)) return true;
    double fast_before = 0, fast_after = 0, here = 1e9;
    for (long i = low; i < high; i++) {
      const double speed = code_step / std::max(1e-3, step_at(i).end - step_at(i).begin);
      double& fast = i < number ? fast_before : fast_after;
      fast = std::max(fast, speed);
      if (i == number || i == number - 1) here = std::min(here, speed);
    }
    return here < 0.7 * std::min(fast_before, fast_after);
  }

  // Advances a beginning; false when no gesture begins there.
  bool advance(Beginning& b, Code code, bool edge) {
    const long age = count - 1 - b.first;
    const float other = follow_other(b.other, code, age == 0);
    b.ahead = no_score;
    for (const Followed& g : gestures) {
      Token* token = b.tokens.data() + g.first;
      const float best = follow(g, token, code, age);
      b.ahead = std::max(b.ahead, best - other);
      const Token& last = token[g.stay.size() - 1];
      if (edge && age + 1 >= settings.least_steps && last.score > other)
        consider(g, b, last, last.score - other);
    }
    if (age + 1 == settings.window && b.ahead <= 0) return false;
    return b.ahead > hopeless && age < longest;
  }

  // Follows steps whose neighbours show whether they are edges; all of them when motion is over.
  void follow_steps(bool over) {
    while (count < (over ? made : made - look)) {
      const Code code = step_at(count).code;
      if (is_edge(count, over))
        beginnings.push_back(
            {count, std::vector<Token>(tokens), std::vector<float>(other_output.size()), 0});
      count++;
      const bool edge = is_edge(count, over);
      std::erase_if(beginnings, [&](Beginning& b) { return !advance(b, code, edge); });
    }
  }

  SpottedGesture tell(const Found& what) {
    SpottedGesture out{what.model->label, step_at(what.first).begin, step_at(what.last).end,
                       what.score};
    std::erase_if(beginnings, [&](const Beginning& b) { return b.first <= what.last; });
    found = found_dwelling = {};
    return out;
  }

  bool awaits_better() const {
    const long since = count - 1 - found.last;
    if (since < settings.hold) return true;
    if (since > longest / 3) return false;
    return std::any_of(beginnings.begin(), beginnings.end(), [&](const Beginning& b) {
      return b.first <= found.last && b.ahead > found.difference;
    });
  }

  // Decides. `rest`: seconds for which the hand has rested; a hand out of sight does not dwell.
  std::optional<SpottedGesture> decide(double rest, bool seen) {
    const bool over = rest > OrientationCoder::rest;
    if (found_dwelling.model) {
      const bool clearest = !found.model || found_dwelling.score > found.score;
      const bool still = seen && count - 1 - found_dwelling.last <= 2;
      if (!clearest || (!still && over)) found_dwelling = {};
      else if (still && rest >= found_dwelling.model->dwell) return tell(found_dwelling);
      else if (still && over) return {};
    }
    if (found.model && (over || !awaits_better())) return tell(found);
    return {};
  }
};

GestureSpotter::GestureSpotter(const GestureModels& models, const SpotSettings& settings)
    : impl_(std::make_unique<Impl>(models, settings)) {}
GestureSpotter::~GestureSpotter() = default;

std::optional<SpottedGesture> GestureSpotter::step(double time, std::optional<vec2> place) {
  Impl& m = *impl_;
  std::optional<SpottedGesture> out;
  m.fresh.clear();
  const bool anew = place && m.coder.step({time, *place}, m.fresh);
  if (anew) {
    m.follow_steps(true);
    if (m.found.model) out = m.tell(m.found);
    m.found = m.found_dwelling = {};
    m.beginnings.clear();
    m.motion = m.made;
  }
  for (const CodedStep& step : m.fresh) {
    m.steps.push_back(step);
    if (long(m.steps.size()) > 2 * longest) m.steps.pop_front();
    m.made++;
  }
  const double rest = m.coder.resting(time);
  m.follow_steps(rest > OrientationCoder::rest);
  if (!out) out = m.decide(rest, place.has_value());
  return out;
}

size_t GestureSpotter::memory_bytes() const {
  const Impl& m = *impl_;
  const size_t beginning =
      sizeof(Beginning) + m.tokens * sizeof(Token) + m.other_output.size() * sizeof(float);
  return sizeof(Impl) + m.steps.size() * sizeof(CodedStep) + m.beginnings.capacity() * beginning +
         m.fresh.capacity() * sizeof(CodedStep);
}

std::vector<SpottedGesture> spot_path(const GestureModels& models, const SpotSettings& settings,
                                      const HandPath& path) {
  GestureSpotter spotter(models, settings);
  std::vector<SpottedGesture> out;
  for (const auto& [time, place] : path.places)
    if (auto found = spotter.step(time, place)) out.push_back(*found);
  for (int i = 1; i <= 10 && !path.places.empty(); i++)
    if (auto found = spotter.step(path.places.back().time + 0.1 * i, {})) out.push_back(*found);
  return out;
}

}  // namespace wellspring::kiosk
