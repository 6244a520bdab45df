// SPDX-License-Identifier: Apache-2.0
#include "spectrum/read/spectra_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/core.h>
#include <functional>

#include "base/load_error.h"

namespace wellspring::test {
namespace {

// Writes a table of one spectrum from 380 to 780 nm.
std::string table_of(const std::string& head, double step, const std::function<double(double)>& at,
                     double scale = 1) {
  std::string text = head + "\n";
  for (double nm = 380; nm <= 780; nm += step)
    text += fmt::format("{:.6g},{:.6g}\n", nm * scale, at(nm));
  return text;
}
double ramp(double nm) { return 0.1 + 0.8 * (nm - 380) / 400; }

SpectraFile read(const std::string& text, const SpectraChoice& choice = {},
                 const std::string& file = "pigments.csv") {
  return read_spectra_text(file, text, choice);
}

// Reads what is to be refused, and returns the error's place and words.
std::string refusal(const std::string& text, const SpectraChoice& choice = {},
                    const std::string& file = "pigments.csv") {
  try {
    read(text, choice, file);
  } catch (const LoadError& error) {
    EXPECT_EQ(error.file, file);
    return error.where + ": " + error.what_;
  }
  return "";
}

bool has_note(const SpectraFile& read, const std::string& words) {
  return std::ranges::any_of(read.notes, [&](const SpectraNote& note) {
    return (note.where + ": " + note.what).find(words) != std::string::npos;
  });
}

double at(const SpectraFile& read, double nm) {
  return read.spectra.at(0).spectrum[size_t(nm) - 360];
}

TEST(SpectraFile, TablesAreReadAsTheyStand) {
  const SpectraFile csv = read(table_of("wavelength_nm,ochre", 5, ramp));
  ASSERT_EQ(csv.spectra.size(), 1u);
  EXPECT_EQ(csv.spectra[0].name, "ochre");
  EXPECT_EQ(csv.spectra[0].source, "pigments.csv");
  EXPECT_TRUE(csv.notes.empty());
  EXPECT_NEAR(at(csv, 580), ramp(580), 1e-6);
  const SpectraFile bare = read(table_of("# no names", 5, ramp));
  EXPECT_EQ(bare.spectra.at(0).name, "column 2");
  const SpectraFile blanks = read("nm a \"b c\"\n400 0.1 0.2\n  550\t0.2 0.3\n700  0.3 0.4\n");
  ASSERT_EQ(blanks.spectra.size(), 2u);
  EXPECT_EQ(blanks.spectra[1].name, "b c");
  const SpectraFile comma =
      read("nm;a\n400;0,1\n440;0,1\n480;0,1\n520;0,5\n560;0,3\n600;0,3\n640;0,3\n700;0,3\n");
  EXPECT_NEAR(at(comma, 520), 0.5, 0.01);
}

TEST(SpectraFile, WordsBesideNumbersTellSpectraApart) {
  std::string text = "group,name,wavelength_nm,relative_power\n";
  for (const char* name : {"one", "two"})
    for (int nm = 380; nm <= 780; nm += 10)
      text += fmt::format("lab,{},{},{}\n", name, nm, nm / 10);
  const SpectraFile lamps = read(text, {.quantity = Quantity::power});
  ASSERT_EQ(lamps.spectra.size(), 2u);
  EXPECT_EQ(lamps.spectra[1].name, "lab two");
  EXPECT_NEAR(at(lamps, 500), 50, 1e-9);
}

TEST(SpectraFile, UnitsAreFoundByTheNumbers) {
  const SpectraFile um = read(table_of("w,ochre", 5, ramp, 1e-3));
  EXPECT_NEAR(at(um, 580), ramp(580), 1e-6);
  const SpectraFile percent =
      read(table_of("nm,ochre", 5, [](double nm) { return 100 * ramp(nm); }));
  EXPECT_NEAR(at(percent, 580), ramp(580), 1e-6);
  const SpectraFile dark = read(table_of("nm,soot %", 5, [](double) { return 1.2; }));
  EXPECT_NEAR(at(dark, 580), 0.012, 1e-9);
}

TEST(SpectraFile, WrongUnitsAreNamed) {
  EXPECT_NE(
      refusal(table_of("wavelength_nm,ochre", 5, ramp, 1e-3))
          .find("line 2: 'wavelength_nm' says nanometres, but wavelengths from 0.38 to 0.78 are "
                "micrometres"),
      std::string::npos);
  EXPECT_NE(refusal(table_of("w,ochre", 5, ramp), {.wavelengths = WavelengthUnit::micrometres})
                .find("the command line says micrometres"),
            std::string::npos);
  EXPECT_NE(refusal(table_of("wavelength,ochre", 5, ramp, 10)).find("neither nanometres nor"),
            std::string::npos);
  EXPECT_NE(refusal(table_of("nm,ochre", 5, [](double nm) { return 100 * ramp(nm); }),
                    {.values = ValueUnit::fractions})
                .find("are per cent"),
            std::string::npos);
}

TEST(SpectraFile, UnsortedTablesAreSortedAndNamed) {
  const std::string text =
      "nm,a\n700,0.7\n400,0.4\n440,0.44\n480,0.48\n520,0.52\n560,0.56\n640,0.64\n600,0.6\n";
  const SpectraFile sorted = read(text);
  EXPECT_TRUE(has_note(sorted, "line 3: a: wavelengths are in no order"));
  EXPECT_NEAR(at(sorted, 600), 0.6, 1e-3);
  EXPECT_TRUE(std::ranges::is_sorted(sorted.spectra[0].table.nm));
  std::string falling = "nm,a\n";
  for (int nm = 780; nm >= 380; nm -= 10) falling += fmt::format("{},{}\n", nm, nm / 1000.0);
  EXPECT_TRUE(read(falling).notes.empty());
  const SpectraFile twice = read(table_of("nm,a", 5, ramp) + "580,0.9\n");
  EXPECT_TRUE(has_note(twice, "580 nm was measured twice"));
  EXPECT_NEAR(twice.spectra[0].table.value[40], (ramp(580) + 0.9) / 2, 1e-6);
}

TEST(SpectraFile, GapsAreBridgedOrRefused) {
  std::string narrow = "nm,a\n", wide = "nm,a\n";
  for (int nm = 380; nm <= 780; nm += 5) {
    if (nm <= 500 || nm >= 530) narrow += fmt::format("{},0.4\n", nm);
    if (nm <= 500 || nm >= 600) wide += fmt::format("{},0.4\n", nm);
  }
  EXPECT_TRUE(has_note(read(narrow), "line 27: a: nothing was measured between 500 and 530 nm"));
  EXPECT_NE(refusal(wide).find("between 500 and 600 nm; left out"), std::string::npos);
  EXPECT_NE(refusal("nm,a\n620,0.1\n700,0.2\n780,0.3\n").find("reaches from 620 to 780 nm only"),
            std::string::npos);
  EXPECT_NE(refusal("nm,a\n400,0.1\n700,0.2\n").find("fewer than three"), std::string::npos);
}

TEST(SpectraFile, MissingValuesAreCounted) {
  std::string text = "nm,a,b\n";
  for (int nm = 380; nm <= 780; nm += 5)
    text += fmt::format("{},{},{}\n", nm, nm == 500 ? "NaN" : nm == 505 ? "" : "0.4", "0.3");
  const SpectraFile some = read(text);
  EXPECT_EQ(some.spectra.size(), 2u);
  EXPECT_TRUE(has_note(some, "line 26: a: 2 values are missing"));
  EXPECT_NEAR(at(some, 502), 0.4, 1e-9);
  EXPECT_NE(refusal("nm,a\n400,0.4\n500,0.4x\n700,0.4\n").find("line 3: a: '0.4x' is no number"),
            std::string::npos);
  EXPECT_NE(refusal("nm,a\n400,0.4\n500,inf\n700,0.4\n").find("line 3"), std::string::npos);
  EXPECT_NE(refusal("nm,a\n400,0.4\n500\n700,0.4\n").find("line 3: there are 1 cells"),
            std::string::npos);
  EXPECT_NE(refusal("nm,a\n400,0.4\n,0.4\n700,0.4\n").find("line 3: the wavelength is missing"),
            std::string::npos);
}

TEST(SpectraFile, NoiseAndNegativeValuesAreNamedAndCut) {
  int i = 0;
  const SpectraFile noisy = read(table_of("nm,smalt", 0.25, [&](double nm) {
    return (nm < 400 ? -0.02 : 0.2) + (i++ % 2 ? 0.05 : -0.05);
  }));
  EXPECT_TRUE(has_note(noisy, "smalt: single values are noisy"));
  EXPECT_TRUE(has_note(noisy, "smalt: is below zero between 380 and 399 nm"));
  EXPECT_EQ(at(noisy, 385), 0);
  EXPECT_NEAR(at(noisy, 550), 0.2, 0.02);
}

TEST(SpectraFile, MoreLightThanFallsOnASurfaceIsRefusedKindly) {
  const SpectraFile white = read(table_of("nm,titanium white", 5, [](double) { return 1.15; }));
  EXPECT_TRUE(has_note(white, "more than all light; taken for 1"));
  EXPECT_EQ(at(white, 550), 1);
  std::string text = "nm,white,daylight paint\n";
  for (int nm = 380; nm <= 780; nm += 5)
    text += fmt::format("{},0.9,{}\n", nm, nm > 500 && nm < 540 ? 1.6 : 0.3);
  const SpectraFile glowing = read(text);
  EXPECT_EQ(glowing.spectra.size(), 1u);
  EXPECT_TRUE(has_note(glowing, "daylight paint: sends back 1.60 times the light"));
  EXPECT_TRUE(glowing.notes[0].is_left_out);
}

TEST(SpectraFile, AColumnThatRepeatsTheWavelengthsIsLeftOut) {
  std::string text = "A,van dyke,ochre\n";
  for (int nm = 380; nm <= 780; nm += 5) text += fmt::format("{},{},{}\n", nm, nm, 40);
  const SpectraFile some = read(text);
  ASSERT_EQ(some.spectra.size(), 1u);
  EXPECT_EQ(some.spectra[0].name, "ochre");
  EXPECT_TRUE(has_note(some, "van dyke: repeats the wavelengths; left out"));
}

TEST(SpectraFile, JsonOfBothForms) {
  std::string nm, values;
  for (int i = 380; i <= 780; i += 10) {
    nm += (nm.empty() ? "" : ",") + std::to_string(i);
    values += values.empty() ? "40" : ",40";
  }
  const std::string list = "[{\"type\":\"wavelengths\",\"values\":[" + nm +
                           "]},"
                           "{\"name\":\"white\",\"type\":\"masstone\",\"reflectance\":[" +
                           values +
                           "]},"
                           "{\"name\":\"white\",\"type\":\"masstone\",\"reflectance\":[" +
                           values + "]}]";
  const SpectraFile paints = read(list, {}, "paints.json");
  ASSERT_EQ(paints.spectra.size(), 2u);
  EXPECT_EQ(paints.spectra[1].name, "white (2)");
  EXPECT_NEAR(at(paints, 550), 0.4, 1e-9);
  const std::string named =
      "{\"source\":\"own\",\"unit\":\"percent\",\"spectra\":[{\"name\":\"a\","
      "\"nm\":[" +
      nm + "],\"values\":[" + values + "]}]}";
  EXPECT_EQ(read(named, {}, "a.json").spectra.at(0).source, "own");
  EXPECT_NE(refusal("[{\"name\":\"a\",\"reflectance\":[1]}]", {}, "a.json").find("no wavelengths"),
            std::string::npos);
  EXPECT_NE(
      refusal("{\"spectra\":[{\"name\":\"a\",\"nm\":[400,500],\"values\":[1]}]}", {}, "a.json")
          .find("1 values for 2 wavelengths"),
      std::string::npos);
  EXPECT_NE(refusal("{", {}, "a.json"), "");
  EXPECT_NE(refusal("x", {}, "a.doc").find("is no .csv"), std::string::npos);
  EXPECT_NE(refusal("").find("no numbers"), std::string::npos);
}

TEST(SpectraFile, PowerIsNoReflectance) {
  const SpectraFile lamp =
      read(table_of("nm,bulb", 5, [](double nm) { return 2 * nm; }), {.quantity = Quantity::power});
  EXPECT_NEAR(at(lamp, 600), 1200, 1e-9);
  EXPECT_NE(refusal(table_of("nm,off", 5, [](double) { return 0; }), {.quantity = Quantity::power})
                .find("no light"),
            std::string::npos);
}

TEST(SpectraFile, HistoricPigments) {
  const std::string file =
      std::string(WELLSPRING_DATA) + "/10_exhibits/spectra/pigments/paints.csv";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no pigments";
  const SpectraFile paints = read_spectra(file);
  EXPECT_EQ(paints.spectra.size(), 54u);
  EXPECT_TRUE(has_note(paints, "vandykebrown: repeats the wavelengths"));
  EXPECT_TRUE(has_note(paints, "titaniumwhite: is 1.1"));
}

TEST(SpectraFile, MasstonePaints) {
  const std::string folder = std::string(WELLSPRING_DATA) + "/10_exhibits/spectra/paints_masstone/";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no paints";
  EXPECT_EQ(read_spectra(folder + "masstone.json").spectra.size(), 39u);
  EXPECT_EQ(read_spectra(folder + "mix1.json").spectra.size(), 36u);
}

}  // namespace
}  // namespace wellspring::test
