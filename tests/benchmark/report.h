// SPDX-License-Identifier: Apache-2.0
// The benchmark's report: named values with units, and where, when and how they were measured.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace wellspring::test {

struct BenchOptions {
  bool quick = false;
  std::string content = "content", web = "web";
  std::string scenes = "tests/benchmark/scenes";
  std::string plots;        // beginning of the file names of curves' pictures
  std::string programs;     // folder of the other programs
  std::string cycles_case;  // light.cycles: only this one
  // The simulated visits take these: one trace only, the technique of samples, a folder for judged
  // pictures.
  std::vector<std::string> visit_methods;  // cache: only these; empty: all
  std::vector<int> visit_mismatches;
  std::string visit_trace, visit_technique = "gather", visit_pictures;
  std::vector<std::string> server_words;  // stream: more of the server's command line
  double bake_seconds = 0;                // seconds to bake illumination maps; 0: the run's own
  int visit_width = 0, visit_instants = 0, visit_spp = 0;  // 0: the run's own
};
// Returns the folder that keeps converged pictures from run to run.
std::string truths_folder(const BenchOptions& options);

// Says how a report came about: {"date":"YYYY-MM-DD" (UTC), "commit":.., "arguments":[..]}. The
// commit is that of the checkout that `folder` lies in, with "-dirty" where files differ from it;
// without git there is none.
nlohmann::json describe_run(const std::vector<std::string>& arguments, const std::string& folder);

class BenchReport {
 public:
  explicit BenchReport(nlohmann::json run = {}) : run_(std::move(run)) {}
  // Names the report that results belong to from now on: "cache.warp".
  void begin(const std::string& part) { part_ = part; }
  // Prints the line as it is added. `fields`: scene, technique and whatever else tells results
  // apart.
  void add(const std::string& name, double value, const std::string& unit,
           nlohmann::json fields = {});
  // {"machine":{..},"run":{..},"results":[{"report","name","metric","value","unit",..},..]}
  nlohmann::json to_json() const;
  // Writes that; throws std::runtime_error when the file cannot be written.
  void save(const std::string& file) const;
  size_t size() const { return results_.size(); }

 private:
  nlohmann::json run_, results_ = nlohmann::json::array();
  std::string part_;
};

// {"cpu":..,"cores":..,"memory_gib":..,"compiler":..,"load_at_end":..}

nlohmann::json describe_machine();
// The p-quantile (0..1) of values, by the nearest rank; NaN of none.
double quantile(std::vector<double> values, double p);

// One function a part; each adds its results.
void bench_stream(BenchReport& report, const BenchOptions& options);
void bench_load_seats(BenchReport& report, const BenchOptions& options);
void bench_workers(BenchReport& report, const BenchOptions& options);
void bench_load_plan(BenchReport& report, const BenchOptions& options);
void bench_load_visitors(BenchReport& report, const BenchOptions& options);
void bench_pieces_picture(BenchReport& report, const BenchOptions& options);
void bench_pieces_bands(BenchReport& report, const BenchOptions& options);
void bench_pieces_particles(BenchReport& report, const BenchOptions& options);
void bench_pieces_scan(BenchReport& report, const BenchOptions& options);
void bench_pieces_splats(BenchReport& report, const BenchOptions& options);
void bench_pieces_lawn(BenchReport& report, const BenchOptions& options);
void bench_volume_reconstruct(BenchReport& report, const BenchOptions& options);
void bench_lamps(BenchReport& report, const BenchOptions& options);
void bench_spectral(BenchReport& report, const BenchOptions& options);
void bench_spectral_color(BenchReport& report, const BenchOptions& options);
void bench_volume_march(BenchReport& report, const BenchOptions& options);
void bench_volume_compressed(BenchReport& report, const BenchOptions& options);
void bench_show_rest(BenchReport& report, const BenchOptions& options);
void bench_show_storyteller(BenchReport& report, const BenchOptions& options);
void bench_show_walk(BenchReport& report, const BenchOptions& options);
void bench_show_load(BenchReport& report, const BenchOptions& options);
void bench_cache_display(BenchReport& report, const BenchOptions& options);
void bench_cache_warp(BenchReport& report, const BenchOptions& options);
void bench_cache_visit(BenchReport& report, const BenchOptions& options);
void bench_cache_rest(BenchReport& report, const BenchOptions& options);
void bench_cache_starve(BenchReport& report, const BenchOptions& options);
void bench_cache_turns(BenchReport& report, const BenchOptions& options);
void bench_cache_switch(BenchReport& report, const BenchOptions& options);
void bench_corrective(BenchReport& report, const BenchOptions& options);
void bench_corrective_error(BenchReport& report, const BenchOptions& options);  // a part of it
void bench_denoise_time(BenchReport& report, const BenchOptions& options);
void bench_denoise_flip(BenchReport& report, const BenchOptions& options);
void bench_bake(BenchReport& report, const BenchOptions& options);
void bench_picture(BenchReport& report, const BenchOptions& options);
void bench_light_error(BenchReport& report, const BenchOptions& options);
void bench_light_hall(BenchReport& report, const BenchOptions& options);  // one scene of it
void bench_light_frame(BenchReport& report, const BenchOptions& options);
void bench_light_scaling(BenchReport& report, const BenchOptions& options);
void bench_attention(BenchReport& report, const BenchOptions& options);
void bench_attention_steer(BenchReport& report, const BenchOptions& options);  // a part of it
void bench_avatar(BenchReport& report, const BenchOptions& options);
void bench_kiosk_face(BenchReport& report, const BenchOptions& options);
void bench_kiosk_eye(BenchReport& report, const BenchOptions& options);
void bench_kiosk_figures(BenchReport& report, const BenchOptions& options);
void bench_kiosk_expression(BenchReport& report, const BenchOptions& options);
void bench_kiosk_hard(BenchReport& report, const BenchOptions& options);
void bench_kiosk_screen(BenchReport& report, const BenchOptions& options);
void bench_kiosk_map(BenchReport& report, const BenchOptions& options);
void bench_kiosk_gestures(BenchReport& report, const BenchOptions& options);
void bench_kiosk_hands(BenchReport& report, const BenchOptions& options);
void bench_kiosk_station(BenchReport& report, const BenchOptions& options);

}  // namespace wellspring::test
