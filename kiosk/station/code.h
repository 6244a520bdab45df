// SPDX-License-Identifier: Apache-2.0
// Recognises objects by the text of the QR code on them, read by ZXing-C++. It reads codes of 60
// pixels and more in about 1 ms.
#pragma once
#include <string>

#include "kiosk/station/sight.h"
#include "kiosk/station/traversal.h"

namespace wellspring::kiosk {

// Returns the texts of the codes in a grey picture, at most four.
std::vector<std::string> read_codes(int width, int height, const uint8_t* gray);

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
  uint64_t number_ = 0;  // Sight::number in which texts_ were read
  std::vector<std::string> texts_;
};

}  // namespace wellspring::kiosk
