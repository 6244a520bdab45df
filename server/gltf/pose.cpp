// SPDX-License-Identifier: Apache-2.0
#include "gltf/pose.h"

#include <algorithm>
#include <cmath>

#include "gltf/animation.h"

namespace wellspring::gltf {
namespace {

glm::dquat unit(glm::dquat q) {
  double length = glm::length(q);
  return length > 1e-12 && std::isfinite(length) ? q / length : glm::dquat(1, 0, 0, 0);
}

dvec3 triple(const json* list, dvec3 otherwise) {
  if (!list) return otherwise;
  return {(*list)[0].get<double>(), (*list)[1].get<double>(), (*list)[2].get<double>()};
}

size_t target_count(const File& file, const json& mesh) {
  size_t count = 0;
  for (const json& primitive : items(mesh, "primitives"))
    count = std::max(count, items(primitive, "targets").size());
  return count;
}

Node read_node(File& file, size_t index) {
  const json& object = items(file.root, "nodes")[index];
  const std::string where = at("/nodes", index);
  Node node;
  const json* rotation = find(object, "rotation");
  node.translation = triple(find(object, "translation"), dvec3(0));
  node.scale = triple(find(object, "scale"), dvec3(1));
  if (rotation) {
    glm::dquat q((*rotation)[3].get<double>(), (*rotation)[0].get<double>(),
                 (*rotation)[1].get<double>(), (*rotation)[2].get<double>());
    if (std::abs(glm::length(q) - 1) > 1e-3)
      warn(file, where + "/rotation", "a rotation that is not of unit length is normalised");
    node.rotation = unit(q);
  }
  if (const json* matrix = find(object, "matrix")) {
    if (rotation || find(object, "translation") || find(object, "scale"))
      refuse(file, where, "has both a matrix and translation, rotation or scale");
    node.has_matrix = true;
    for (int i = 0; i < 16; i++) node.matrix[i / 4][i % 4] = (*matrix)[size_t(i)].get<double>();
    if (node.matrix[0][3] != 0 || node.matrix[1][3] != 0 || node.matrix[2][3] != 0 ||
        node.matrix[3][3] != 1) {
      warn(file, where + "/matrix",
           "a matrix whose last row is not 0 0 0 1 is taken as if it were");
      for (int i = 0; i < 4; i++) node.matrix[i][3] = i == 3;
    }
  }
  if (const json* mesh_index = find(object, "mesh")) {
    const json& mesh = items(file.root, "meshes")[mesh_index->get<size_t>()];
    size_t count = target_count(file, mesh);
    node.weights.assign(count, 0);
    const json& own = items(object, "weights");
    const json& weights = own.empty() ? items(mesh, "weights") : own;
    if (!weights.empty() && weights.size() != count)
      warn(file, where, "the number of morph weights is not that of the morph targets");
    for (size_t i = 0; i < std::min(count, weights.size()); i++)
      node.weights[i] = weights[i].get<double>();
  } else if (find(object, "weights") || find(object, "skin")) {
    warn(file, where, "a skin or morph weights without a mesh are ignored");
  }
  return node;
}

// One parent each and no cycles, so that walking down costs no more than the nodes there are.
std::vector<uint32_t> link_parents(File& file, std::vector<Node>& nodes) {
  const json& list = items(file.root, "nodes");
  for (size_t i = 0; i < nodes.size(); i++) {
    const json& children = items(list[i], "children");
    for (size_t c = 0; c < children.size(); c++) {
      size_t child = children[c].get<size_t>();
      if (nodes[child].parent >= 0 || child == i)
        refuse(file, at(at("/nodes", i) + "/children", c),
               child == i ? "a node is its own child"
                          : "node " + std::to_string(child) + " has another parent, node " +
                                std::to_string(nodes[child].parent));
      nodes[child].parent = int(i);
    }
  }
  std::vector<uint32_t> order = parents_first(nodes);
  if (order.size() < nodes.size()) {
    std::vector<char> reached(nodes.size(), 0);
    for (uint32_t i : order) reached[i] = 1;
    size_t first = size_t(std::find(reached.begin(), reached.end(), 0) - reached.begin());
    refuse(file, at("/nodes", first), "is part of a cycle: a node cannot be its own ancestor");
  }
  return order;
}

// Marks the default scene's nodes and what hangs below them.
void mark_shown(File& file, std::vector<Node>& nodes, const std::vector<uint32_t>& order) {
  const json& scenes = items(file.root, "scenes");
  if (scenes.empty()) {
    if (!nodes.empty()) warn(file, "/scenes", "the file has no scene; all its nodes are shown");
    for (Node& node : nodes) node.shown = true;
    return;
  }
  size_t index = size_t(integer(file.root, "scene", 0));
  const json& roots = items(scenes[index], "nodes");
  if (roots.empty()) warn(file, at("/scenes", index), "the scene is empty");
  for (size_t i = 0; i < roots.size(); i++) {
    Node& node = nodes[roots[i].get<size_t>()];
    if (node.parent >= 0)
      warn(file, at(at("/scenes", index) + "/nodes", i), "a scene lists a node that has a parent");
    node.shown = true;
  }
  for (uint32_t i : order)
    if (nodes[i].parent >= 0 && nodes[size_t(nodes[i].parent)].shown) nodes[i].shown = true;
}

}  // namespace

std::vector<uint32_t> parents_first(const std::vector<Node>& nodes) {
  std::vector<uint32_t> order, first(nodes.size() + 1, 0), children;
  for (const Node& node : nodes)
    if (node.parent >= 0) first[size_t(node.parent) + 1]++;
  for (size_t i = 0; i < nodes.size(); i++) first[i + 1] += first[i];
  children.resize(first.back());
  std::vector<uint32_t> next = first;
  for (uint32_t i = 0; i < uint32_t(nodes.size()); i++)
    if (nodes[i].parent < 0) order.push_back(i);
    else children[next[size_t(nodes[i].parent)]++] = i;
  for (size_t done = 0; done < order.size(); done++)
    for (uint32_t c = first[order[done]]; c < first[order[done] + 1]; c++)
      order.push_back(children[c]);
  return order;
}

void place_nodes(const std::vector<uint32_t>& order, std::vector<Node>& nodes) {
  for (uint32_t i : order) {
    Node& node = nodes[i];
    if (!node.has_matrix) {
      node.matrix =
          glm::translate(dmat4(1), node.translation) * glm::mat4_cast(unit(node.rotation));
      node.matrix = glm::scale(node.matrix, node.scale);
    }
    node.global = node.parent < 0 ? node.matrix : nodes[size_t(node.parent)].global * node.matrix;
  }
}

std::vector<Node> make_pose(File& file, double time) {
  std::vector<Node> nodes;
  for (size_t i = 0; i < items(file.root, "nodes").size(); i++) nodes.push_back(read_node(file, i));
  std::vector<uint32_t> order = link_parents(file, nodes);
  animate(file, time, nodes);
  place_nodes(order, nodes);
  for (size_t i = 0; i < nodes.size(); i++)
    for (int k = 0; k < 16; k++)
      if (!(std::abs(nodes[i].global[k / 4][k % 4]) < 1e18))
        refuse(file, at("/nodes", i), "stands at no finite place");
  mark_shown(file, nodes, order);
  return nodes;
}

}  // namespace wellspring::gltf
