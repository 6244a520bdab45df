// SPDX-License-Identifier: Apache-2.0
// The reports of `wellspring bench --only NAME`, and the page that each is printed on.
#pragma once
#include <span>
#include <string_view>

#include "markdown_page.h"
#include "report.h"

namespace wellspring::test {

struct ReportEntry {
  const char* name;
  void (*run)(BenchReport& report, const BenchOptions& options);
  bool is_part = false;  // part of another report: run only when it is named
};

std::span<const ReportEntry> report_entries();

// A page that stands beside what it shows.
ReportPage kiosk_face_page();
ReportPage kiosk_eye_page();
ReportPage kiosk_screen_page();
ReportPage kiosk_figures_page();
ReportPage kiosk_expression_page();
ReportPage kiosk_hard_page();
ReportPage kiosk_gestures_page();
ReportPage kiosk_hands_page();
ReportPage kiosk_station_page();
ReportPage kiosk_map_page();
ReportPage load_visitors_page();
ReportPage load_seats_page();
ReportPage workers_page();
ReportPage load_plan_page();
ReportPage light_frame_page();
ReportPage light_scaling_page();
ReportPage light_error_page(const std::string& name);
ReportPage light_rays_page();
ReportPage light_cycles_page();
ReportPage light_photons_page();
ReportPage light_dynamic_page();
ReportPage show_walk_page();
ReportPage show_rest_page();
ReportPage show_storyteller_page();
ReportPage show_load_page();
ReportPage pieces_picture_page();
ReportPage pieces_bands_page();
ReportPage pieces_particles_page();
ReportPage pieces_scan_page();
ReportPage pieces_splats_page();
ReportPage pieces_lawn_page();
ReportPage lamps_page();
ReportPage spectral_page();
ReportPage spectral_color_page();
ReportPage volume_reconstruct_page();
ReportPage volume_march_page();
ReportPage volume_compressed_page();

// Returns the page that is declared for this report, else plain_page.
ReportPage find_page(const std::string& name);

// Writes a page for each report of `report`: into the file `where` if that ends with .md, one below
// the other, else into that folder as NAME.md. A page that is there is replaced. Throws
// std::runtime_error when a file cannot be written.
void write_pages(const nlohmann::json& report, const std::string& where);
// The same of JSON files, which may tell the same report again: the last one counts.
void write_pages_from(const std::vector<std::string>& files, const std::string& where);

}  // namespace wellspring::test
