/// What the command line of workbench asked for, and its spelling.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "apps/workbench/calibration_section.h"
#include "apps/workbench/feel_score.h"
#include "common/calibration/least_squares.h"
#include "common/calibration/registration.h"
#include "common/calibration/tracker_fit.h"

namespace palpate {

struct TuneSettings {
  int places = 7;                       ///< 1, 7 or 27
  double least = 100.0, most = 3000.0;  ///< [N/m]
  double knock = 3.0;                   ///< [N]
  double margin = 0.7;                  ///< part of what was found that explorers may use
};

struct WorkbenchOptions {
  std::string verb;  ///< "calibrate", "controls", "devices", "doctor", "example", "feel", "monitor",
                     ///< "report", "screen", "stability", "tune"; empty: `text` is all
  std::string text;  ///< --help or --version
  std::string kind;  ///< "tracker", "apparatus", "arm", "coregister", "pivot", "eyes"
  std::filesystem::path file, out, report, nominal, pictures;
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
  std::string device;               ///< as for `--device` of the explorers
  double seconds = 3.0;             ///< doctor: of measurement; monitor: how long
  double patience = 30.0;           ///< [s] doctor: in which the device must become ready
  double rate = 10.0;               ///< [Hz] monitor, feel: of read-outs
  std::filesystem::path workbench;  ///< of the device's options, switch and limits; empty: none
  std::filesystem::path path;       ///< feel: a recorded hand; empty: live
  double servo_rate = 1000.0;       ///< [Hz] feel, tune
  FeelEffect effect = FeelEffect::kWall;
  double stiffness = 400.0;  ///< [N/m] feel
  double damping = 0.0;      ///< [N s/m] feel
  TuneSettings tune;
  std::string model = "ideal";  ///< stability: a class of devices, or a file that describes one
};

/// @throws Error (usage).
[[nodiscard]] WorkbenchOptions parse_workbench(const std::vector<std::string>& arguments);

}  // namespace palpate
