// SPDX-License-Identifier: Apache-2.0
// Holds a recognition tree as data (Eissele, Sanftmann, Ertl, section 4.2), and the metadata that
// solvers keep for its nodes. Plain values; tree_file.h reads and writes them, traversal.h walks
// the tree. A node may be the child of several others, but no node is below itself.
#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "base/vec.h"

namespace wellspring::kiosk {

using Texts = std::map<std::string, std::string>;  // by language: "en", "de"

// Asks for a value of the context store (context.h). A number lies within [least, most]; a text is
// `is`, if that is not empty.
struct Condition {
  std::string value;
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  std::string is;
  double quality = 0;  // least quality of the value, 0..1
};
using Conditions = std::vector<Condition>;  // all of them have to hold

enum class NodeKind : uint8_t {
  search,          // a solver looks which child matches
  context_switch,  // conditions choose the child
  model,           // a leaf: one object
};

struct SolverChoice {
  std::string solver;
  Conditions when;  // empty: the default
};

struct RecognitionNode {
  std::string name;
  NodeKind kind = NodeKind::model;
  std::vector<SolverChoice> solvers;  // a search has some
  std::vector<int> children;
  std::vector<Conditions> cases;  // for each child of a context switch
  int backtrack = -1;             // node where the way back goes on; -1: the one above
  std::vector<int> refresh;       // searches above whose solvers run again before one resumes here
  std::string hint;               // name of the hint that is given where no child can be told
  // Names the object, or the class that is the result of a search that cannot decide; a search
  // without one only divides.
  std::string id;
  Texts title, text;
};

// Is a corner of a picture with what surrounds it, as 256 bits (ORB).
using Descriptor = std::array<uint64_t, 4>;
struct Feature {
  vec2 place{0};  // pixels of the view
  Descriptor bits{};
};

// Shows one side of an object, seen squarely.
struct View {
  std::string side;
  int width = 0, height = 0;      // pixels
  vec2 size{0};                   // metres; 0: not known
  vec3 mean{0};                   // mean blue, green, red
  std::vector<Feature> features;  // those that are found again most often come first
  // The picture in grey, half as wide and high, rows from the top; empty: the side has no texture.
  std::vector<uint8_t> gray;
  int gray_width() const { return width / 2; }
  int gray_height() const { return height / 2; }
};

// Shows a part of a view in which nearly equal objects differ, as one of them has it.
struct Mark {
  int view = 0;  // index of the view of the class
  int x = 0, y = 0, width = 0, height = 0;
  std::vector<uint8_t> bgr;  // width * height pixels
};

// Is what solvers know of a node: the metadata store has one for each.
struct NodeData {
  std::vector<View> views;
  std::vector<Mark> marks;  // the children of a search have as many, of the same places
  vec3 box{0};              // width, height, depth in metres of a box; 0: it is none
  std::string code;         // text of the QR code on it; empty: it has none
};

struct RecognitionTree {
  int root = 0;
  std::vector<RecognitionNode> nodes;
  std::vector<NodeData> data;          // for each node
  std::map<std::string, Texts> hints;  // by name
};

}  // namespace wellspring::kiosk
