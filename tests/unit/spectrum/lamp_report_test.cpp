// SPDX-License-Identifier: Apache-2.0
#include "spectrum/report/lamp_report.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "spectrum/read/spectra_file.h"

namespace wellspring::test {
namespace {

NamedSpectrum pigment(const std::string& name, const Spectrum& spectrum) {
  return {name, "made", {}, spectrum};
}

std::vector<LampSpectrum> lamps_of(std::initializer_list<const char*> names) {
  std::vector<LampSpectrum> lamps;
  for (const char* name : names) lamps.push_back(*find_lamp(name));
  return lamps;
}

// Returns a white, and a red whose reflectance is a step.
std::vector<NamedSpectrum> some_pigments() {
  Spectrum step = even_spectrum(0.1);
  for (size_t i = 0; i < spectrum_size; i++)
    if (nm_of(i) > 580) step[i] = 0.8;
  return {pigment("white", even_spectrum(0.9)), pigment("a \"red\", <step>", step)};
}

TEST(LampReport, GreyStaysGreyForEyesThatAdapt) {
  const LampReport report =
      make_lamp_report("test", {}, lamps_of({"candle", "A", "HP1"}), some_pigments());
  ASSERT_EQ(report.lamps.size(), 4u);
  EXPECT_EQ(report.lamps[0].lamp.name, "D65");
  for (const ReportedColor& color : report.pigments[0].colors) {
    EXPECT_NEAR(color.shift, 0, 1e-6);
    EXPECT_NEAR(color.rgb_error, 0, 0.03);  // Rec. 709 rounds its white
    EXPECT_NEAR(color.lab.y, 0, 1e-6);
  }
  EXPECT_GT(report.pigments[1].colors[1].shift, 3);
}

TEST(LampReport, CandlesAreOrangeForEyesUsedToDaylight) {
  const LampReport report = make_lamp_report("test", {.adaptation = Adaptation::none},
                                             lamps_of({"candle"}), some_pigments());
  EXPECT_GT(report.pigments[0].colors[1].shift, 30);
  EXPECT_GT(report.pigments[0].colors[1].lab.z, 60);
}

TEST(LampReport, MetamersAreToldWithTheirLamps) {
  // Under yellow light alone these two are the same; in daylight they are not.
  std::vector<NamedSpectrum> two{pigment("one", even_spectrum(0.3)),
                                 pigment("two", even_spectrum(0.3))};
  for (size_t i = 0; i < spectrum_size; i++)
    if (nm_of(i) < 500) two[1].spectrum[i] = 0.8;
  const LampReport report = make_lamp_report("test", {}, lamps_of({"sodium"}), two);
  ASSERT_EQ(report.pairs.size(), 1u);
  EXPECT_EQ(report.lamps[report.pairs[0].near_lamp].lamp.name, "sodium");
  EXPECT_EQ(report.lamps[report.pairs[0].far_lamp].lamp.name, "D65");
  EXPECT_NEAR(report.pairs[0].near_de00, 0, 1e-3);
  EXPECT_GT(report.pairs[0].far_de00, 20);
}

TEST(LampReport, FormsQuoteNames) {
  const LampReport report = make_lamp_report("a <title>", {}, lamps_of({"A"}), some_pigments());
  const std::string csv = lamp_report_csv(report), html = lamp_report_html(report);
  EXPECT_NE(csv.find("\"a \"\"red\"\", <step>\",A,"), std::string::npos);
  EXPECT_NE(html.find("a &quot;red&quot;, &lt;step&gt;"), std::string::npos);
  EXPECT_EQ(html.find("<step>"), std::string::npos);
  EXPECT_EQ(html.find("a <title>"), std::string::npos);
  EXPECT_EQ(html.find("http"), std::string::npos);  // it needs nothing else
  const auto json = nlohmann::json::parse(lamp_report_json(report));
  EXPECT_EQ(json["pigments"][1]["name"], "a \"red\", <step>");
  EXPECT_EQ(json["lamps"].size(), 2u);
  EXPECT_NE(lamp_report_text(report).find("white"), std::string::npos);
}

// Products of red, green and blue against products of spectra, as exhibits were planned by.
TEST(LampReport, ThreeColorsAreVisiblyWrongForHistoricPigments) {
  const std::string file =
      std::string(WELLSPRING_DATA) + "/10_exhibits/spectra/pigments/paints.csv";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no pigments";
  const struct {
    const char *lamp, *worst;
    double median, most;
  } known[] = {{"A", "cobaltyellow", 2.9, 8.7},       {"1850K", "cobaltyellow", 10.1, 30.2},
               {"LED-B1", "cobaltyellow", 4.4, 11.5}, {"LED-B3", "gamboge", 2.8, 6.2},
               {"LED-V2", "cadmiumgreen", 1.0, 2.9},  {"FL11", "cobaltblue", 3.0, 9.3},
               {"HP1", "redlead", 12.7, 34.4}};
  std::vector<LampSpectrum> lamps;
  for (const auto& one : known) lamps.push_back(*find_lamp(one.lamp));
  const LampReport report = make_lamp_report("pigments", {}, lamps, read_spectra(file).spectra);
  for (size_t i = 0; i < std::size(known); i++) {
    const ReportedLamp& lamp = report.lamps[i + 1];
    EXPECT_NEAR(lamp.error_median, known[i].median, 0.15) << lamp.lamp.name;
    EXPECT_NEAR(lamp.error_max, known[i].most, 0.15) << lamp.lamp.name;
    EXPECT_EQ(report.pigments[lamp.worst_pigment].name, known[i].worst);
  }
}

}  // namespace
}  // namespace wellspring::test
