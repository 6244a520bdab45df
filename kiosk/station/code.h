// SPDX-License-Identifier: Apache-2.0
// Recognises objects by the QR code on them. Codes are found by OpenCV and compared module by
// module with those of the tree; Debian's OpenCV reads no text from them, and none is needed.
#pragma once
#include <string>

#include "kiosk/station/sight.h"
#include "kiosk/station/traversal.h"

namespace wellspring::kiosk {

// Returns the modules of the code in a grey picture, as NodeData::code has them; empty: there is
// none that can be read whole.
std::string read_code(int width, int height, const uint8_t* gray);

class CodeSolver : public Solver {
 public:
  // Borrows both.
  CodeSolver(const RecognitionTree& tree, Sight& sight) : tree_(tree), sight_(sight) {}
  Answer match(int node, int child, ContextStore& context) override;
  bool verifies() const override { return true; }
  bool verify(int node, ContextStore& context) override;

 private:
  bool sees(int node);

  const RecognitionTree& tree_;
  Sight& sight_;
  uint64_t number_ = 0;  // Sight::number in which corners_ were sought
  std::vector<vec2> corners_;
};

}  // namespace wellspring::kiosk
