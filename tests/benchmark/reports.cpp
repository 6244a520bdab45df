// SPDX-License-Identifier: Apache-2.0
#include "reports.h"

#include <filesystem>
#include <fstream>
#include <map>
#include <stdexcept>

#include "light_cycles.h"
#include "light_dynamic.h"
#include "light_photons.h"
#include "light_rays.h"
#include "splat_bench.h"

namespace wellspring::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr ReportEntry entries[] = {{"stream", bench_stream},
                                   {"avatar", bench_avatar},
                                   {"attention", bench_attention},
                                   {"kiosk.face", bench_kiosk_face},
                                   {"kiosk.eye", bench_kiosk_eye},
                                   {"kiosk.page", bench_kiosk_screen},
                                   {"kiosk.figures", bench_kiosk_figures},
                                   {"kiosk.expression", bench_kiosk_expression},
                                   {"kiosk.hard", bench_kiosk_hard},
                                   {"kiosk.gestures", bench_kiosk_gestures},
                                   {"kiosk.hands", bench_kiosk_hands},
                                   {"kiosk.station", bench_kiosk_station},
                                   {"kiosk.map", bench_kiosk_map},
                                   {"cache.display", bench_cache_display},
                                   {"cache.warp", bench_cache_warp},
                                   {"cache.visit", bench_cache_visit},
                                   {"cache.rest", bench_cache_rest},
                                   {"show.walk", bench_show_walk},
                                   {"show.rest", bench_show_rest},
                                   {"show.storyteller", bench_show_storyteller},
                                   {"show.load", bench_show_load},
                                   {"load.visitors", bench_load_visitors},
                                   {"load.seats", bench_load_seats},
                                   {"workers", bench_workers},
                                   {"load.plan", bench_load_plan},
                                   {"pieces.picture", bench_pieces_picture},
                                   {"pieces.bands", bench_pieces_bands},
                                   {"pieces.scan", bench_pieces_scan},
                                   {"pieces.splats", bench_pieces_splats},
                                   {"pieces.particles", bench_pieces_particles},
                                   {"pieces.lawn", bench_pieces_lawn},
                                   {"lamps", bench_lamps},
                                   {"spectral", bench_spectral},
                                   {"spectral.color", bench_spectral_color},
                                   {"volume.reconstruct", bench_volume_reconstruct},
                                   {"volume.march", bench_volume_march},
                                   {"volume.compressed", bench_volume_compressed},
                                   {"cache.starve", bench_cache_starve},
                                   {"cache.turns", bench_cache_turns},
                                   {"cache.switch", bench_cache_switch},
                                   {"corrective", bench_corrective},
                                   {"denoise.ms", bench_denoise_time},
                                   {"denoise.flip", bench_denoise_flip},
                                   {"bake", bench_bake},
                                   {"picture", bench_picture},
                                   {"light.frame", bench_light_frame},
                                   {"light.scaling", bench_light_scaling},
                                   {"light.error", bench_light_error},
                                   {"light.rays", bench_light_rays},
                                   {"light.cycles", bench_light_cycles},
                                   {"light.photons", bench_light_photons},
                                   {"light.dynamic", bench_light_dynamic},
                                   {"splat", bench_splat},
                                   {"splat.error", bench_splat_error},
                                   {"light.hall", bench_light_hall, true}};

using Pages = std::map<std::string, std::string>;

void add_pages(const json& report, Pages& pages) {
  for (const std::string& name : reports_in(report))
    pages[name] = make_page(find_page(name), report);
}

void save(const std::string& text, const std::string& file) {
  std::ofstream out(file);
  out << text;
  if (!out.flush()) throw std::runtime_error(file + ": cannot be written");
}

void save(const Pages& pages, const std::string& where) {
  if (fs::path(where).extension() == ".md") {
    std::string all;
    for (const auto& [name, text] : pages) all += (all.empty() ? "" : "\n") + text;
    return save(all, where);
  }
  fs::create_directories(where);
  for (const auto& [name, text] : pages) {
    std::string file = name;
    for (char& c : file)
      if (c == '/') c = '_';
    save(text, (fs::path(where) / (file + ".md")).string());
  }
}

}  // namespace

std::span<const ReportEntry> report_entries() { return entries; }

void write_pages(const json& report, const std::string& where) {
  Pages pages;
  add_pages(report, pages);
  save(pages, where);
}

void write_pages_from(const std::vector<std::string>& files, const std::string& where) {
  Pages pages;
  for (const std::string& file : files) {
    std::ifstream in(file);
    json report = json::parse(in, nullptr, false);
    if (!report.is_object() || !report.contains("results") || !report["results"].is_array())
      throw std::runtime_error(file + ": is no report of wellspring bench");
    add_pages(report, pages);
  }
  save(pages, where);
}

}  // namespace wellspring::test
