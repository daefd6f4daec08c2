/// What verbs of devices take: calibrations, errors of head tracking, and trials.
#pragma once

#include <filesystem>
#include <string>

namespace palpate {

/// What is calibrated, and how a model is fitted to measurements of it.
struct CalibrationOptions {
  std::string kind;                 ///< tracker, apparatus, arm, coregister, pivot, eyes; empty: not said
  std::filesystem::path table;      ///< of measurements; empty: none
  bool made = false;                ///< measurements of known truth in place of a table
  std::string loss = "square";      ///< name_of(Loss)
  std::string method = "combined";  ///< tracker: name_of(TrackerMethod)
  int degree = 4;                   ///< tracker: of the polynomial
  int nodes = 0;                    ///< tracker: TrackerFitOptions::table_nodes
  bool offsets_only = false;        ///< arm: of the joints
  std::filesystem::path nominal;    ///< arm: a workbench file that the search starts from; empty: PHANToM 3.0
  std::string noise;                ///< position [mm], orientation [degrees], markers [mm]; empty: usual ones
};

/// A head before a screen. Lengths in metres.
struct HeadErrorOptions {
  double distance = 0.6;  ///< of the eyes from the screen
  double separation = 0.063;
  double width = 1.2;  ///< of the screen
  double front = 0.2;  ///< how far objects stand out of the screen
  double behind = 0.3;
  double pixel = 0.0;                    ///< size of one; 0: not known
  std::string position_error = "10,10";  ///< along the screen and away from it [mm]
  double orientation_error = 2.0;        ///< [degrees]
};

/// A device that is tried.
struct TrialOptions {
  std::string device;           ///< as HandOptions::device; empty: none
  std::string model = "ideal";  ///< of walls: a class of devices, or a file that describes one
  double seconds = 3.0;         ///< of measurement
  double patience = 30.0;       ///< [s] in which the device must become ready
  double rate = 10.0;           ///< [Hz] of read-outs
  std::string effect = "wall";  ///< wall, groove, sphere
  double stiffness = 400.0;     ///< [N/m]
  double damping = 0.0;         ///< [N s/m]
  int places = 7;               ///< of the workspace: 1, 7 or 27
  double least = 100.0;         ///< [N/m] to begin with
  double most = 3000.0;         ///< [N/m] not to go beyond
  double knock = 3.0;           ///< [N]
  double margin = 0.7;          ///< part of what is found that may be used
};

/// What these write beside OutputOptions::file.
struct DeviceOutputs {
  std::filesystem::path section;   ///< a workbench file: one section is written, the rest stays; empty: none
  std::filesystem::path report;    ///< folder; empty: none
  std::filesystem::path pictures;  ///< folder of pictures of a tracker's distortion; empty: none
  std::filesystem::path picture;   ///< of a menu in space; empty: none
};

}  // namespace palpate
