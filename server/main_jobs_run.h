// SPDX-License-Identifier: Apache-2.0
// Runs Wellspring's other programs for `wellspring jobs`: shards at a machine that takes them, and
// at home what puts their files together.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "workers/jobs/job.h"
#include "workers/jobs/job_words.h"
#include "workers/jobs/line.h"

namespace wellspring::program {

// Holds where things lie on this machine.
struct JobFolders {
  std::string inputs = ".";            // below it all paths of jobs lie
  std::string scratch = "build/jobs";  // for files of shards while they are worked on
  std::string cache = "build/cache";   // folder that keeps bakes
};

struct ProgramEnd {
  int status = 0;            // exit code, or minus the signal that ended it
  std::string last_lines;    // last lines of stderr, but for progress
  bool was_stopped = false;  // as `goes_on` wished
};
// Runs a program of this folder, `wellspring_NAME`, which does not outlive this one. Its stdout and
// stderr go to files in `folder`. `goes_on` is called ten times a second with the share of its work
// that it says is done.
ProgramEnd run_program(const std::string& name, const std::vector<std::string>& words,
                       const std::string& folder, const std::function<bool(float)>& goes_on);

// Returns the words of a command for this machine. Throws std::runtime_error for a path that is not
// below the folder of inputs.
std::vector<std::string> local_words(const JobCommand& command, const JobFolders& folders);

// Returns the number of all that a command reads: that of the scene, or of the bytes of its files.
uint64_t number_inputs(const JobCommand& command, const JobFolders& folders);

// Takes shards and does them until SIGINT or SIGTERM. Returns the exit status.
struct WorkSettings {
  LineSettings line;
  JobFolders folders;
  std::string name, version;
  int begin = 0, end = 0;  // minutes of the local day between which it takes shards; alike: always
  bool until_empty = false;  // ends when nothing waits any more
};
int work_on_jobs(const WorkSettings& settings);

// Brings a job's files home and puts them together. `out`: folder of what is made, of pictures and
// clips. Returns the exit status.
int fetch_job(JobLine& line, const JobState& job, const JobFolders& folders,
              const std::string& out);

}  // namespace wellspring::program
