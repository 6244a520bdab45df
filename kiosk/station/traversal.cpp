// SPDX-License-Identifier: Apache-2.0
#include "kiosk/station/traversal.h"

#include <algorithm>
#include <set>
#include <stdexcept>

namespace wellspring::kiosk {

Traversal::Traversal(const RecognitionTree& tree, Solvers solvers)
    : tree_(tree), solvers_(std::move(solvers)), refresh_(tree.nodes.size()) {
  for (const RecognitionNode& node : tree.nodes)
    for (const SolverChoice& choice : node.solvers)
      if (!solvers_.contains(choice.solver))
        throw std::invalid_argument("node '" + node.name + "' names no solver that there is: '" +
                                    choice.solver + "'");
  find_dependencies();
}

void Traversal::find_dependencies() {
  // Visits nodes on every way from the root; what is above a node is on the stack.
  std::vector<std::set<std::string>> needed(tree_.nodes.size());
  std::vector<char> known(tree_.nodes.size(), 0);
  auto needs_below = [&](auto& self, int at) -> const std::set<std::string>& {
    std::set<std::string>& out = needed[size_t(at)];
    if (known[size_t(at)]) return out;
    known[size_t(at)] = 1;
    const RecognitionNode& node = tree_.nodes[size_t(at)];
    for (const SolverChoice& choice : node.solvers)
      for (const std::string& name : solvers_.at(choice.solver)->needs()) out.insert(name);
    for (const Conditions& one : node.cases)
      for (const Condition& condition : one) out.insert(condition.value);
    for (const int child : node.children) {
      const std::set<std::string> below = self(self, child);
      out.insert(below.begin(), below.end());
    }
    return out;
  };
  std::vector<std::set<int>> above(tree_.nodes.size());
  std::vector<int> waiting{tree_.root};
  // A node is looked at again when more has come to lie above it; there are no circles.
  while (!waiting.empty()) {
    const int at = waiting.back();
    waiting.pop_back();
    for (const int child : tree_.nodes[size_t(at)].children) {
      std::set<int>& of_child = above[size_t(child)];
      const size_t before = of_child.size();
      of_child.insert(above[size_t(at)].begin(), above[size_t(at)].end());
      of_child.insert(at);
      if (of_child.size() != before) waiting.push_back(child);
    }
  }
  for (size_t n = 0; n < tree_.nodes.size(); n++) {
    refresh_[n] = tree_.nodes[n].refresh;
    if (!refresh_[n].empty()) continue;
    const std::set<std::string>& names = needs_below(needs_below, int(n));
    for (const int one : above[n])
      for (const SolverChoice& choice : tree_.nodes[size_t(one)].solvers) {
        const auto gives = solvers_.at(choice.solver)->gives();
        const bool gives_one = std::ranges::any_of(
            gives, [&](const std::string& name) { return names.contains(name); });
        if (gives_one && (refresh_[n].empty() || refresh_[n].back() != one))
          refresh_[n].push_back(one);
      }
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

// Goes down from the end of the path. False: nothing is there, and the path is as it was. Where
// `may_stay`, the node itself has just been matched, so that its class can be the result.
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
    const int child = node.children[i];
    const Answer answer = solver.match(at, child, context);
    out.matches++;
    if (answer.verdict == Verdict::sure && enter(child, at, &solver, context, out)) return true;
    if (answer.verdict == Verdict::likely) likely.emplace_back(-answer.score, child);
    if (answer.verdict == Verdict::undecided && !hinted && !answer.hint.empty())
      hint = answer.hint, hinted = true;
  }
  std::ranges::sort(likely);
  for (const auto& [score, child] : likely)
    if (enter(child, at, &solver, context, out)) return true;
  if (may_stay && !node.id.empty() && path_.size() > 1) {
    out.node = at;
    out.hint = hint;
    return true;
  }
  failed_[size_t(at)] = 1;
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
      if (descend(context, out, false)) return out;
    }
    return out;
  }
  path_ = {{tree_.root, -1, nullptr}};
  descend(context, out, false);
  return out;
}

std::vector<int> Traversal::path() const {
  std::vector<int> out;
  for (const Step& step : path_) out.push_back(step.node);
  return out;
}

}  // namespace wellspring::kiosk
