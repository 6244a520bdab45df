// SPDX-License-Identifier: Apache-2.0
#include "show/exhibit/exhibit_lamps.h"

#include "world/load/lamp.h"

namespace wellspring::show {

void read_lamps(Exhibit& exhibit, Fields& root) {
  root.objects("lamps", false, [&](Fields fields) {
    ExhibitLamp lamp;
    lamp.id = fields.text("id", true);
    if (!lamp.id.empty() && find_lamp(exhibit, lamp.id) >= 0)
      fields.problem("id", "'" + lamp.id + "' is taken by another lamp");
    lamp.title = fields.local_text("title", true);
    for (const std::string& lang : exhibit.languages)
      if (!lamp.title.empty() && !lamp.title.contains(lang))
        fields.problem("title", "has nothing in '" + lang + "'", false);
    lamp.on = fields.flag("on", true);
    lamp.shared = fields.flag("shared", false);
    LampNames names{lamp.id, fields.texts("nodes"), fields.texts("materials")};
    if (names.nodes.empty() && names.materials.empty())
      fields.problem("", "names neither \"nodes\" nor \"materials\" of the scene");
    fields.finish();
    if (exhibit.lamps.size() == most_lamps) {
      fields.problem(
          "", "is one more than the " + std::to_string(most_lamps) + " lamps an exhibit may have");
      return;
    }
    const bool loaded = !exhibit.scene.objects.empty();  // else every name would be missed
    for (const LampFault& fault : add_lamp(names, exhibit.scene))
      if (loaded)
        fields.problem((fault.is_material ? "materials/" : "nodes/") + std::to_string(fault.index),
                       fault.what);
    exhibit.lamps.push_back(std::move(lamp));
  });
}

std::vector<char> first_lamps(const Exhibit& exhibit) {
  std::vector<char> on;
  for (const ExhibitLamp& lamp : exhibit.lamps) on.push_back(lamp.on);
  return on;
}

LampLevels first_levels(const Exhibit& exhibit) {
  return lamp_levels(exhibit.day, first_lamps(exhibit), {});
}

}  // namespace wellspring::show
