// SPDX-License-Identifier: Apache-2.0
// Learns a recognition tree from photographs: one folder for each object with PNG or JPEG files of
// its sides, each seen squarely and on its own; the part of a name before '-', '_', ' ' or a digit
// says the side. A background that is transparent or all of one colour is left out. An optional
// object.json has
//   title, text  {LANGUAGE: text}
//   class        {LANGUAGE: text}: what objects that are nearly equal to it are called together
//   size         {SIDE: [width, height]} in metres; or [width, height] for all sides
//   hints        {NAME: {LANGUAGE: text}} in place of the usual ones
//
// Objects with sides that are nearly equal become a class, told apart by the marks in which they
// differ. Objects without texture need a size and several colours, or, as boxes, the sizes of two
// sides that meet. The rest is divided by likeness into groups of two, so that the way to an object
// is as long as the logarithm of their number.
#pragma once
#include <string>
#include <vector>

#include "kiosk/station/learn_view.h"

namespace wellspring::kiosk {

struct LearnObject {
  std::string id;
  Texts title, text, of_class;
  std::map<std::string, vec2> sizes;  // by side; "": of all sides
  std::vector<Photo> photos;
  std::string code;  // NodeData::code
  std::map<std::string, Texts> hints;
};

struct Learnt {
  RecognitionTree tree;
  std::vector<std::string> notes;  // about what could be better, for who took the photographs
};

// Reads the folder. Throws LoadError.
std::vector<LearnObject> load_objects(const std::string& folder);
// Makes the tree; about 0.2 s a photograph. Throws LoadError, which names the folder of an object
// that cannot be told from all others.
Learnt learn_tree(std::vector<LearnObject> objects, const std::string& folder);

}  // namespace wellspring::kiosk
