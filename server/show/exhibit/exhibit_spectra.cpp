// SPDX-License-Identifier: Apache-2.0
#include "show/exhibit/exhibit_spectra.h"

#include <fmt/format.h>

#include "base/load_error.h"
#include "show/exhibit/exhibit_files.h"
#include "spectrum/lamps.h"
#include "spectrum/observer.h"
#include "spectrum/read/dispersion_file.h"
#include "spectrum/read/spectra_file.h"
#include "world/load/scene_spectra.h"

namespace wellspring::show {
namespace {

// Splits "file#name" and returns the file's path; empty if it is not there, which is noted.
std::string spectra_path(const Exhibit& exhibit, FieldReader& fields, const char* field,
                         const std::string& text, std::string& name) {
  const size_t mark = text.find('#');
  name = mark == std::string::npos ? std::string() : text.substr(mark + 1);
  return package_file(fields, field, exhibit.folder, text.substr(0, mark));
}

// Reads "file#name" and returns the spectrum's index in the scene; -1 if there is none, which is
// noted. The same spectrum of a file is in the scene once.
int read_spectrum(Exhibit& exhibit, FieldReader& fields, const char* field, const std::string& text,
                  Quantity quantity) {
  std::vector<SceneSpectrum>& known = exhibit.scene.spectra;
  for (size_t i = 0; i < known.size(); i++)
    if (known[i].name == text) return int(i);
  std::string name;
  const std::string path = spectra_path(exhibit, fields, field, text, name);
  if (path.empty()) return -1;
  try {
    SpectraChoice choice;
    choice.quantity = quantity;
    const SpectraFile file = read_spectra(path, choice);
    for (const SpectraNote& note : file.notes)
      fields.warn(field, fmt::format("{}: {}", note.where, note.what));
    const NamedSpectrum* found = nullptr;
    for (const NamedSpectrum& one : file.spectra)
      if (one.name == name) found = &one;
    if (name.empty() && file.spectra.size() == 1) found = &file.spectra.front();
    if (found) return add_spectrum(exhibit.scene, text, found->spectrum);
    std::string names;
    for (const NamedSpectrum& one : file.spectra) names += (names.empty() ? "" : ", ") + one.name;
    fields.fail(field, name.empty() ? "names none of the file's spectra, as \"file#name\": " + names
                                    : "has no spectrum '" + name + "', only " + names);
  } catch (const LoadError& error) {
    fields.fail(field, fmt::format("{}: {}", error.where, error.what_));
  }
  return -1;
}

void read_glass(Exhibit& exhibit, FieldReader& fields, std::span<const int> materials) {
  std::string text, name;
  if (!fields.text("glass", text, "a file of refractiveindex.info: how light is bent")) return;
  const std::string path = spectra_path(exhibit, fields, "glass", text, name);
  if (path.empty()) return;
  try {
    Dispersion glass = read_dispersion(path);
    glass.name = text;
    for (const std::string& note : glass.notes) fields.warn("glass", note);
    for (int i : materials) {
      Material& material = exhibit.scene.materials[size_t(i)];
      if (!encloses_medium(material))
        fields.fail("glass",
                    "the material is no solid that light goes through: it needs "
                    "KHR_materials_transmission and a thickness");
      else if (!set_glass(exhibit.scene, material, glass))
        fields.fail("glass", "the file tells no index of refraction at 587.6 nm");
    }
  } catch (const LoadError& error) {
    fields.fail("glass", fmt::format("{}: {}", error.where, error.what_));
  }
}

void read_material(Exhibit& exhibit, const std::string& name, FieldReader& fields) {
  std::vector<int> materials;
  for (size_t i = 0; i < exhibit.scene.materials.size(); i++)
    if (exhibit.scene.materials[i].name == name) materials.push_back(int(i));
  const bool loaded = !exhibit.scene.objects.empty();
  if (loaded && materials.empty()) fields.fail("the scene has no material of this name");
  std::string text;
  if (fields.text("reflectance", text,
                  "\"file#name\" of a table, or \"rgb\": a smooth one of the base colour")) {
    if (text == "rgb")
      for (int i : materials)
        upsample_base_color(exhibit.scene, exhibit.scene.materials[size_t(i)]);
    else if (const int at =
                 read_spectrum(exhibit, fields, "reflectance", text, Quantity::reflectance);
             at >= 0)
      for (int i : materials)
        set_reflectance(exhibit.scene, exhibit.scene.materials[size_t(i)], at);
  }
  read_glass(exhibit, fields, materials);
  if (fields.text("absorption", text, "\"file#name\" of a table: per metre of the solid"))
    if (const int at = read_spectrum(exhibit, fields, "absorption", text, Quantity::power); at >= 0)
      for (int i : materials) set_absorption(exhibit.scene, exhibit.scene.materials[size_t(i)], at);
}

// Returns the index of a lamp's relative power, by its name or out of a file.
int read_power(Exhibit& exhibit, FieldReader& fields, const char* field, const std::string& text) {
  const std::vector<SceneSpectrum>& known = exhibit.scene.spectra;
  for (size_t i = 0; i < known.size(); i++)
    if (known[i].name == text) return int(i);
  int at = -1;
  if (const std::optional<LampSpectrum> lamp = spectrum::find_lamp(text))
    at = add_spectrum(exhibit.scene, text, lamp->power);
  else if (text.find('.') == std::string::npos)
    fields.fail(field, "'" + text +
                           "' is no lamp that is known by name (./wellspring lamps --list-lamps) "
                           "and no file");
  else at = read_spectrum(exhibit, fields, field, text, Quantity::power);
  if (at >= 0 && !(xyz_of(known[size_t(at)].value).y > 0)) {
    fields.fail(field, "the lamp has no power that is seen");
    return -1;
  }
  return at;
}

}  // namespace

void read_spectra(Exhibit& exhibit, FieldReader& root) {
  root.members(
      "spectra", "what materials are by wavelength, by the materials' names",
      [&](const std::string& name, FieldReader& fields) { read_material(exhibit, name, fields); });
}

void read_lamp_light(Exhibit& exhibit, FieldReader& fields, ExhibitLamp& lamp, int lit) {
  int own = -1;
  if (fields.text("spectrum", lamp.spectrum,
                  "its relative power over wavelength: a lamp by name, or \"file#name\""))
    own = read_power(exhibit, fields, "spectrum", lamp.spectrum);
  const bool made = own >= 0 && size_t(lit) < exhibit.scene.lamps.size();
  if (made) set_lamp_spectrum(exhibit.scene, exhibit.scene.lamps[size_t(lit)], own);
  if (fields.has("dial") && lamp.spectrum.empty())
    fields.fail("dial", "needs \"spectrum\": the light that the lamp has at first");
  fields.parts("dial", most_dial_lights, "lights that visitors may give it", [&](FieldReader& one) {
    DialLight light;
    const bool named = one.text("spectrum", light.spectrum, "as of a lamp", Need::required);
    light.title = read_local_text(one, "title", "", Need::required);
    if (!named) return;
    const int at = read_power(exhibit, one, "spectrum", light.spectrum);
    if (at < 0 || !made) return;
    exhibit.scene.lamps[size_t(lit)].dial.push_back(
        {at, lamp_color(exhibit.scene.spectra[size_t(at)].value) /
                 lamp_color(exhibit.scene.spectra[size_t(own)].value)});
    lamp.dial.push_back(std::move(light));
  });
}

}  // namespace wellspring::show
