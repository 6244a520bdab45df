// SPDX-License-Identifier: Apache-2.0
// Walks a recognition tree, one iteration a frame (Eissele, Sanftmann, Ertl, section 4.3). It knows
// solvers by their interface alone, and no pictures.
//
// An iteration begins at the node that the last one returned, and asks a verifier whether the
// object is still the same. If it is not, the walk goes back towards the root and tries to descend
// from each node on the way. A search descends into the first child that surely matches; children
// that may match are tried afterwards, the best first. A search that has a class and cannot tell
// its children apart is the result, with a hint for the visitor.
//
// Children are tried in the order of how often the way to what was found led through them, lately:
// what visitors hold up most is found soonest.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "kiosk/station/context.h"
#include "kiosk/tree/tree.h"

namespace wellspring::kiosk {

enum class Verdict : uint8_t {
  no,
  undecided,  // the child cannot be told from others in this view
  likely,     // the child matches unless a sibling matches better
  sure,
};

struct Answer {
  Verdict verdict = Verdict::no;
  double score = 0;    // the larger, the better it matches
  std::string hint{};  // undecided: name of a hint that would help; empty: the node's own
};

class Solver {
 public:
  virtual ~Solver() = default;
  // Says whether `child` of `node` is seen.
  virtual Answer match(int node, int child, ContextStore& context) = 0;
  // Says whether verify() can be asked.
  virtual bool verifies() const { return false; }
  // Says whether what was found at `node` is still there, beginning with the last context.
  virtual bool verify(int node, ContextStore& context) { return false; }
  // Name values of the context that it cannot do without, and those that it sets.
  virtual std::vector<std::string> needs() const { return {}; }
  virtual std::vector<std::string> gives() const { return {}; }
};
using Solvers = std::map<std::string, Solver*>;  // by their names in the tree; borrowed

struct Recognition {
  int node = -1;      // a model, or a search that has a class; -1: nothing is seen
  std::string hint;   // name; empty: none is needed
  bool kept = false;  // verified rather than found
  // How often solvers were called.
  int matches = 0, verifications = 0, refreshed = 0;
  int back = 0;  // steps back towards the root
};

class Traversal {
 public:
  // Borrows all. Dependencies of nodes that list none are found here: searches above that give what
  // solvers at or below the node need. Throws std::invalid_argument for a solver that is not there.
  Traversal(const RecognitionTree& tree, Solvers solvers);
  Recognition step(ContextStore& context);
  // Returns the node of the last result's path at each depth, the root first.
  std::vector<int> path() const;
  // Forgets the last result.
  void restart() { path_.clear(); }

 private:
  struct Step {
    int node;
    int from;    // search by which it was entered; -1: the root
    Solver* by;  // solver that matched it; null: the root
  };
  // Says whether a context switch stands before step `i`: one match entered both.
  bool follows_switch(size_t i) const { return path_[i - 1].from == path_[i].from; }
  Solver& choose(const RecognitionNode& node, const ContextStore& context) const;
  bool verify(ContextStore& context, Recognition& out);
  bool refresh(ContextStore& context, Recognition& out);
  bool descend(ContextStore& context, Recognition& out, bool may_stay);
  bool enter(int child, int from, Solver* by, ContextStore& context, Recognition& out);
  void go_back();
  void find_dependencies();
  void learn_order();

  const RecognitionTree& tree_;
  Solvers solvers_;
  std::vector<std::vector<int>> refresh_;  // for each node
  // For each node: its children as they are tried, and how often each was on the way.
  std::vector<std::vector<int>> order_, found_;
  std::vector<Step> path_;
  std::vector<char> failed_;  // nodes from which no way down was found in this iteration
};

}  // namespace wellspring::kiosk
