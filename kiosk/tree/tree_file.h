// SPDX-License-Identifier: Apache-2.0
// Reads and writes recognition trees: one JSON file, a foreign one.
//   root      name of a node
//   hints     {NAME: {LANGUAGE: text}}: what a visitor is asked for
//   nodes     {NAME: node}; a node has a kind, and may have id, title and text ({LANGUAGE: text}),
//             hint (a name), backtrack (a node), refresh (nodes):
//     search   solvers [{solver, when?}], children [NAME]
//     switch   cases [{when, child}]; the first whose conditions hold is taken
//     model    the object `id`
//     when     [{value, least?, most?, is?, quality?}], of the context store
//   metadata  {NAME: {views, marks, code, box}}; features, pictures and marks are base64, code is
//             the text of a QR code, box the width, height and depth of a box in metres
#pragma once
#include <string>

#include "kiosk/tree/tree.h"

namespace wellspring::kiosk {

inline constexpr size_t most_nodes = 4000, most_depth = 64, most_children = 1000;
inline constexpr size_t most_links = 20'000, most_all_views = 4000;  // in all
inline constexpr int most_view_side = 1024;                          // pixels
inline constexpr size_t most_features = 2000, most_views = 16, most_marks = 64;
inline constexpr size_t most_code_bytes = 2000;
// Name the solvers that a tree may ask for (kiosk/station/station.cpp).
inline constexpr const char* solver_names[] = {"pattern", "twins", "colors", "outline",
                                               "box",     "code",  "always"};

// Throws LoadError that names the first fault and its place.
RecognitionTree load_tree(const std::string& file);
RecognitionTree parse_tree(const std::string& file, const std::string& text);
void save_tree(const RecognitionTree& tree, const std::string& file);
std::string write_tree(const RecognitionTree& tree);

}  // namespace wellspring::kiosk
