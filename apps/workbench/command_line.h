/// What the command line of workbench asked for, and its spelling.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "apps/workbench/calibration_section.h"
#include "common/calibration/least_squares.h"
#include "common/calibration/registration.h"
#include "common/calibration/tracker_fit.h"

namespace palpate {

struct WorkbenchOptions {
  std::string verb;  ///< "calibrate", "controls", "devices", "doctor", "example", "monitor", "report",
                     ///< "screen", "stability"; empty: `text` is all
  std::string text;  ///< --help or --version
  std::string kind;  ///< "tracker", "apparatus", "arm", "coregister", "pivot", "eyes"
  std::filesystem::path file, out, report, nominal;
  std::filesystem::path picture;  ///< controls: of the menu as it was left
  bool json = false, quiet = false, force = false;
  bool example = false;  ///< made measurements in place of a file
  std::uint64_t seed = 1;
  int threads = 0;
  Loss loss = Loss::kSquare;
  TrackerMethod method = TrackerMethod::kCombined;
  int degree = 4;
  int nodes = 0;
  bool offsets_only = false;
  RegistrationNoise noise;
  HeadErrorSetup screen;
  std::string device;      ///< as for `--device` of the explorers
  double seconds = 3.0;    ///< doctor: of measurement; monitor: how long
  double patience = 30.0;  ///< [s] doctor: in which the device must become ready
  double rate = 10.0;      ///< [Hz] monitor: of read-outs
};

/// @throws Error (usage).
[[nodiscard]] WorkbenchOptions parse_workbench(const std::vector<std::string>& arguments);

}  // namespace palpate
