// SPDX-License-Identifier: Apache-2.0
#include "kiosk/station/traversal.h"

#include <algorithm>
#include <set>
#include <stdexcept>
#include <utility>

namespace wellspring::kiosk {
namespace {

// A child is tried if its score is at least this share of the best one's.
constexpr double worth_trying = 0.4;
// So many finds at a node halve its counts, so that last month's visitors count little.
constexpr int halved_after = 200;

}  // namespace

Traversal::Traversal(const RecognitionTree& tree, Solvers solvers)
    : tree_(tree), solvers_(std::move(solvers)), refresh_(tree.nodes.size()) {
  for (const RecognitionNode& node : tree.nodes)
    for (const SolverChoice& choice : node.solvers)
      if (!solvers_.contains(choice.solver))
        throw std::invalid_argument("node '" + node.name + "' names no solver that there is: '" +
                                    choice.solver + "'");
  find_dependencies();
  for (const RecognitionNode& node : tree.nodes) {
    order_.push_back(node.children);
    found_.emplace_back(node.children.size(), 0);
  }
}

// Counts the way to what was found. Children as often found stay in the order that they have.
void Traversal::learn_order() {
  for (size_t i = 1; i < path_.size(); i++) {
    const size_t from = size_t(path_[i].from);
    if (follows_switch(i)) continue;
    const std::vector<int>& children = tree_.nodes[from].children;
    std::vector<int>& counts = found_[from];
    auto count = [&](int child) -> int& {
      return counts[size_t(std::ranges::find(children, child) - children.begin())];
    };
    if (++count(path_[i].node) > halved_after)
      for (int& one : counts) one /= 2;
    std::ranges::stable_sort(order_[from], std::ranges::greater(), count);
  }
}

void Traversal::find_dependencies() {
  const size_t count = tree_.nodes.size();
  // Solvers at or below a node need these. Nodes end up in `order` after all below them.
  std::vector<std::set<std::string>> needed(count);
  std::vector<char> known(count, 0);
  std::vector<size_t> order;
  auto visit = [&](auto& self, size_t at) -> void {
    if (std::exchange(known[at], 1)) return;
    const RecognitionNode& node = tree_.nodes[at];
    for (const SolverChoice& choice : node.solvers)
      for (const std::string& name : solvers_.at(choice.solver)->needs()) needed[at].insert(name);
    for (const Conditions& one : node.cases)
      for (const Condition& condition : one) needed[at].insert(condition.value);
    for (const int child : node.children) {
      self(self, size_t(child));
      needed[at].insert(needed[size_t(child)].begin(), needed[size_t(child)].end());
    }
    order.push_back(at);
  };
  visit(visit, size_t(tree_.root));
  std::vector<std::vector<char>> above(count);
  for (const size_t at : order) above[at].assign(count, 0);
  for (size_t i = order.size(); i-- > 0;) {
    const std::vector<char> own = above[order[i]];
    for (const int child : tree_.nodes[order[i]].children) {
      std::vector<char>& to = above[size_t(child)];
      for (size_t n = 0; n < count; n++) to[n] |= own[n];
      to[order[i]] = 1;
    }
  }
  for (const size_t at : order) {
    refresh_[at] = tree_.nodes[at].refresh;
    if (!refresh_[at].empty() || needed[at].empty()) continue;
    std::set<std::string> givers;
    for (const auto& [name, solver] : solvers_)
      for (const std::string& value : solver->gives())
        if (needed[at].contains(value)) givers.insert(name);
    for (size_t n = 0; n < count; n++)
      if (above[at][n] && std::ranges::any_of(tree_.nodes[n].solvers, [&](const auto& choice) {
            return givers.contains(choice.solver);
          }))
        refresh_[at].push_back(int(n));
  }
}

// Takes the first solver whose conditions hold, else the default.
Solver& Traversal::choose(const RecognitionNode& node, const ContextStore& context) const {
  for (const SolverChoice& choice : node.solvers)
    if (!choice.when.empty() && context.holds(choice.when)) return *solvers_.at(choice.solver);
  for (const SolverChoice& choice : node.solvers)
    if (choice.when.empty()) return *solvers_.at(choice.solver);
  return *solvers_.at(node.solvers.front().solver);
}

bool Traversal::enter(int child, int from, Solver* by, ContextStore& context, Recognition& out) {
  path_.push_back({child, from, by});
  if (descend(context, out, true)) return true;
  path_.pop_back();
  return false;
}

// Goes down from the end of the path. False: nothing is there, and the path is as it was. With
// `may_stay` the node itself has just been matched, so that its class can be the result.
bool Traversal::descend(ContextStore& context, Recognition& out, bool may_stay) {
  const int at = path_.back().node;
  const RecognitionNode& node = tree_.nodes[size_t(at)];
  if (node.kind == NodeKind::model) {
    out.node = at;
    return true;
  }
  if (node.kind == NodeKind::context_switch) {
    const Step step = path_.back();
    for (size_t i = 0; i < node.children.size(); i++)
      if (context.holds(node.cases[i]))
        return enter(node.children[i], step.from, step.by, context, out);
    return false;
  }
  if (failed_[size_t(at)]) return false;
  Solver& solver = choose(node, context);
  const auto needs = solver.needs();
  const bool can = std::ranges::all_of(needs, [&](const auto& name) { return context.has(name); });
  std::vector<std::pair<double, int>> likely;
  std::string hint = node.hint;
  bool hinted = false;
  for (size_t i = 0; can && i < node.children.size(); i++) {
    const int child = order_[size_t(at)][i];
    const Answer answer = solver.match(at, child, context);
    out.matches++;
    if (answer.verdict == Verdict::sure && enter(child, at, &solver, context, out)) return true;
    if (answer.verdict == Verdict::likely) likely.emplace_back(-answer.score, child);
    if (answer.verdict == Verdict::undecided && !hinted && !answer.hint.empty())
      hint = answer.hint, hinted = true;
  }
  std::ranges::sort(likely);
  for (const auto& [minus_score, child] : likely) {
    if (minus_score > std::min(worth_trying * likely[0].first, 0.0) && likely[0].first < 0) break;
    if (enter(child, at, &solver, context, out)) return true;
  }
  if (may_stay && !node.id.empty() && path_.size() > 1) {
    out.node = at;
    out.hint = hint;
    return true;
  }
  if (can) failed_[size_t(at)] = 1;
  return false;
}

// Asks the verifier nearest to the end of the path.
bool Traversal::verify(ContextStore& context, Recognition& out) {
  for (size_t i = path_.size(); i-- > 1;) {
    const Step& step = path_[i];
    if (!step.by || !step.by->verifies() || follows_switch(i)) continue;
    out.verifications++;
    if (step.by->verify(step.node, context)) return refresh(context, out);
    for (const std::string& name : step.by->gives()) context.forget(name);
    return false;
  }
  return false;
}

// Runs solvers again on whose results later ones depend, but for the verifier's own.
bool Traversal::refresh(ContextStore& context, Recognition& out) {
  const std::vector<int>& nodes = refresh_[size_t(path_.back().node)];
  for (size_t i = 1; i < path_.size(); i++) {
    const Step& step = path_[i];
    if (!step.by || step.by->verifies() || follows_switch(i)) continue;
    if (std::ranges::find(nodes, step.from) == nodes.end()) continue;
    out.refreshed++;
    if (step.by->match(step.from, step.node, context).verdict < Verdict::likely) return false;
  }
  return true;
}

void Traversal::go_back() {
  const int link = tree_.nodes[size_t(path_.back().node)].backtrack;
  path_.pop_back();
  const bool on_path =
      std::ranges::any_of(path_, [&](const Step& step) { return step.node == link; });
  while (on_path && path_.back().node != link) path_.pop_back();
}

Recognition Traversal::step(ContextStore& context) {
  Recognition out;
  failed_.assign(tree_.nodes.size(), 0);
  if (path_.size() > 1) {
    if (verify(context, out)) {
      out.kept = true;
      if (descend(context, out, true)) return out;
    }
    out.kept = false;
    while (path_.size() > 1) {
      go_back();
      out.back++;
      if (!descend(context, out, false)) continue;
      learn_order();
      return out;
    }
    return out;
  }
  path_ = {{tree_.root, -1, nullptr}};
  if (descend(context, out, false)) learn_order();
  return out;
}

std::vector<int> Traversal::path() const {
  std::vector<int> out;
  for (const Step& step : path_) out.push_back(step.node);
  return out;
}

}  // namespace wellspring::kiosk
