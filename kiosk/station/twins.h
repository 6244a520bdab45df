// SPDX-License-Identifier: Apache-2.0
// Tells nearly equal objects apart by the marks in which they differ: by their structure (the
// paper's diff-edge solver) or by their colours (its colour-spot solver). Both need a pose. Marks
// are remembered for some seconds, so that an object may be turned over meanwhile; who cannot tell
// says what would help, and never asks for a side that was just seen.
#pragma once
#include <map>

#include "kiosk/station/sight.h"
#include "kiosk/station/traversal.h"

namespace wellspring::kiosk {

enum class MarkKind : uint8_t { edges, colors };

// Returns how far a mark is from being like another, 0 to about 1.
float marks_apart(MarkKind kind, const Mark& a, const Mark& b);

// Names the hints that solvers give; a tree has a text for each.
inline constexpr const char* hint_names[] = {"turn", "closer", "light", "tilt", "whole", "still"};

class TwinSolver : public Solver {
 public:
  // Borrows both.
  TwinSolver(const RecognitionTree& tree, Sight& sight, MarkKind kind);
  Answer match(int node, int child, ContextStore& context) override;
  std::vector<std::string> needs() const override;

 private:
  struct Seen {
    std::vector<float> apart;  // by child, means over frames; empty: never seen
    double time = 0;
  };
  struct Memory {
    std::vector<Seen> marks;
    std::vector<double> views;  // times at which the views of the class were seen last
  };
  struct Judged {
    uint64_t sight = 0;
    int node = -1;
    std::vector<Answer> answers;
  };
  void judge(int node, const ContextStore& context);
  void look(int node, const ContextStore& context, Memory& memory, std::string& trouble);
  std::vector<float> measure(int node, size_t mark, const mat3& pose, const View& view, float scale,
                             std::string& trouble) const;
  Answer decide(int node, int child, int view, const Memory& memory,
                const std::string& trouble) const;

  const RecognitionTree& tree_;
  Sight& sight_;
  MarkKind kind_;
  std::map<int, Memory> memories_;  // by node
  // How far the marks of two children are apart: by node, then [mark][a * children + b].
  std::map<int, std::vector<std::vector<float>>> apart_;
  Judged judged_;
};

}  // namespace wellspring::kiosk
