// SPDX-License-Identifier: Apache-2.0
#include "show/exhibit/pieces/exhibit_sources.h"

#include "show/exhibit/exhibit_files.h"
#include "store/remote/http_get.h"

namespace wellspring::show {

void read_allowed_hosts(Exhibit& exhibit, FieldReader& root) {
  const std::vector<std::string> hosts =
      read_texts(root, "allowed_hosts", "servers whose pictures may hang here: HOST or HOST:PORT");
  for (size_t i = 0; i < hosts.size(); i++) {
    const auto address = store::read_http_address("http://" + hosts[i]);
    const bool is_host = address && hosts[i].find_first_of("/?#*") == std::string::npos;
    if (is_host) exhibit.allowed_hosts.push_back(hosts[i]);
    else
      root.fail("allowed_hosts/" + std::to_string(i),
                "'" + hosts[i] + "' is no HOST or HOST:PORT, such as iiif.example.org");
  }
}

std::string find_source(const Exhibit& exhibit, FieldReader& fields, const std::string& source) {
  if (!store::is_http_address(source))
    return package_file(fields, "source", exhibit.folder, source, PackagePart::file_or_folder);
  const auto address = store::read_http_address(source);
  if (!address) {
    fields.fail("source", "'" + source + "' is no http or https address");
    return "";
  }
  if (store::is_allowed(*address, exhibit.allowed_hosts)) return source;
  const std::string host = store::host_text(*address);
  fields.fail("source", "host '" + host + "' is not allowed: add \"" + host +
                            "\" to \"allowed_hosts\" of this file");
  return "";
}

BandView read_band_view(FieldReader& fields) {
  BandView view;
  fields.text("lamp", view.lamp,
              "that a picture of many bands is seen by: a name of `wellspring lamps`, 2700K, "
              "D5700K, or lines");
  fields.boolean("adapted", view.adapted, "whether eyes are used to the lamp; else to daylight");
  double nm = 0;
  if (fields.number("band_nm", shortest_nm, longest_nm, nm,
                    "wavelength of a picture of many bands that is shown in grey"))
    view.shown_nm = {nm};
  dvec3 three(0);
  const bool has_three = fields.vector("false_color_nm", longest_nm, three,
                                       "wavelengths that are shown as red, green and blue");
  if (int(!view.lamp.empty()) + int(!view.shown_nm.empty()) + int(has_three) > 1)
    fields.fail("has more than one of \"lamp\", \"band_nm\" and \"false_color_nm\"");
  if (view.adapted && view.lamp.empty())
    fields.fail("adapted", "needs a \"lamp\", to which eyes are used");
  if (has_three) view.shown_nm = {three.x, three.y, three.z};
  return view;
}

void read_year(const Exhibit& exhibit, FieldReader& fields, PieceLayer& layer) {
  int year = 0;
  fields.integer("year", -10000, 10000, year, "of the map or scan", Need::required);
  layer.year = year, layer.id = std::to_string(year);
  layer.label = read_local_text(fields, "label", "without it the year");
  if (layer.label.empty()) layer.label[exhibit.languages.front()] = layer.id;
  layer.text = read_local_text(fields, "text", "what there is to see in it");
}

}  // namespace wellspring::show
