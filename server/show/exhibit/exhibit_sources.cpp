// SPDX-License-Identifier: Apache-2.0
#include "show/exhibit/exhibit_sources.h"

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

}  // namespace wellspring::show
