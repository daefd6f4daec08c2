#include "apps/workbench/command_line.h"

#include <map>

#include <CLI/CLI.hpp>

#include "common/base/error.h"
#include "common/base/version.h"
#include "common/math/quaternion.h"

namespace palpate {
namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  workbench                                             a report of made calibrations, in "
    "workbench-report\n"
    "  workbench calibrate tracker poses.csv --out workbench.toml --report report\n"
    "  workbench calibrate arm grid.csv --out workbench.toml\n"
    "  workbench calibrate pivot --example                   what a calibration says, on made measurements\n"
    "  workbench example arm --out grid.csv                  how a table of measurements looks\n"
    "  workbench screen --distance 0.7 --position-error 5,5 --orientation-error 1\n"
    "  workbench stability --out stability                   how stiff walls may be\n"
    "  workbench devices                                     what is plugged in\n"
    "  workbench doctor --device falcon                      whether it works, and what to do if not\n"
    "  workbench feel --device simulated:falcon --effect groove      how truly it shows a groove\n"
    "  workbench tune --device falcon:enable=pedal --out workbench.toml   how stiff it may be\n";

constexpr const char* kCalibrateExamples =
    "Measurements (CSV with a header; metres, radians, unit quaternions):\n"
    "  tracker     tx,ty,tz,tqw,tqx,tqy,tqz (reported), mx,my,mz,mqw,mqx,mqy,mqz (measured)[,validation]\n"
    "  apparatus   px,py,pz,qw,qx,qy,qz (tracker), v1x,v1y,v1z,... (markers as the camera sees them; nan: "
    "not)\n"
    "  arm         x,y,z (where the tip was put), j1,...,jn (readings)[,grid]\n"
    "  coregister  px,py,pz,qw,qx,qy,qz (arm), v1x,v1y,v1z (the tracker's sensor)\n"
    "  pivot       px,py,pz,qw,qx,qy,qz (sensor; the tip rests)\n"
    "  eyes        px,py,pz,qw,qx,qy,qz (head), eye (0 left, 1 right), ax,ay,az,bx,by,bz (points seen in "
    "line)\n"
    "Examples:\n"
    "  workbench calibrate tracker poses.csv --degree 4 --method combined --out workbench.toml\n"
    "  workbench calibrate tracker poses.csv --pictures pictures\n"
    "  workbench calibrate arm grid.csv --nominal workbench.toml --out workbench.toml --force\n"
    "  workbench calibrate coregister --example --json\n";

template <typename Value>
CLI::Validator words(std::map<std::string, Value> known) {
  return CLI::CheckedTransformer(std::move(known), CLI::ignore_case);
}

void add_common(CLI::App& verb, WorkbenchOptions& o) {
  verb.add_flag("--json", o.json, "one JSON object on stdout");
  verb.add_flag("--quiet", o.quiet, "errors only on stderr");
  verb.add_flag("--force", o.force, "replace what is there already");
  verb.add_option("--seed", o.seed, "of made measurements");
  verb.add_option("--threads", o.threads, "0: all cores");
}

void add_kind(CLI::App& verb, WorkbenchOptions& o) {
  verb.add_option("KIND", o.kind, "tracker, apparatus, arm, coregister, pivot or eyes")
      ->required()
      ->check(CLI::IsMember({"tracker", "apparatus", "arm", "coregister", "pivot", "eyes"}));
}

void add_workbench(CLI::App& verb, WorkbenchOptions& o) {
  verb.add_option("--workbench", o.workbench,
                  "workbench.toml whose calibration, [device.NAME], [tuned.NAME] and [interaction] are used");
}

/// Verbs that show a force.
void add_force_verbs(CLI::App& app, WorkbenchOptions& o) {
  constexpr const char* kDevice =
      "simulated[:premium3|falcon|ideal][,hand=relaxed|firm], or a driver as for doctor";
  CLI::App& feel = *app.add_subcommand("feel", "reference effects, to judge how truly a device shows them");
  add_common(feel, o);
  feel.add_option("--device", o.device, std::string(kDevice) + "; with --path none is needed");
  feel.add_option("--effect", o.effect,
                  "wall (through the middle, pushed into along -z), groove (along x) or sphere (25 mm)")
      ->transform(words<FeelEffect>(
          {{"wall", FeelEffect::kWall}, {"groove", FeelEffect::kGroove}, {"sphere", FeelEffect::kSphere}}));
  feel.add_option("--stiffness", o.stiffness, "[N/m]; default 400")->check(CLI::Range(1.0, 1e5));
  feel.add_option("--damping", o.damping, "[N s/m]; default 0")->check(CLI::Range(0.0, 1e3));
  feel.add_option("--servo-rate", o.servo_rate, "[Hz]; default 1000")->check(CLI::Range(100.0, 10000.0));
  feel.add_option("--seconds", o.seconds, "how long; default 3")->check(CLI::Range(0.1, 86400.0));
  feel.add_option("--rate", o.rate, "read-outs a second; default 10")->check(CLI::Range(0.1, 1000.0));
  feel.add_option("--path", o.path,
                  "a recorded hand in place of a live one: a table t,x,y,z in seconds and metres");
  feel.add_option("--out", o.out, "with --path: log of every step, as that of the explorers' probe");
  add_workbench(feel, o);
  feel.footer(
      "On a terminal F12 or any other key switches the force off, `a` on again, `q` ends.\n"
      "Examples:\n  workbench feel --device simulated:falcon --effect groove --seconds 20\n"
      "  workbench feel --device falcon:enable=pedal --stiffness 800 --workbench workbench.toml\n"
      "  workbench feel --device simulated:falcon --path hand.csv --out log.csv\n");

  CLI::App& tune =
      *app.add_subcommand("tune", "the stiffness that a device bears, unheld, at several places");
  add_common(tune, o);
  tune.add_option("--device", o.device, kDevice)->required();
  tune.add_option("--places", o.tune.places, "1, 7 (middle and axes) or 27 of its workspace; default 7")
      ->check(CLI::IsMember({1, 7, 27}));
  tune.add_option("--least", o.tune.least, "stiffness to begin with [N/m]; default 100")
      ->check(CLI::Range(1.0, 1e5));
  tune.add_option("--most", o.tune.most, "stiffness not to go beyond [N/m]; default 3000")
      ->check(CLI::Range(1.0, 1e5));
  tune.add_option("--knock", o.tune.knock,
                  "hardest push at each step; more than twice the arm's friction is enough [N]; default 3")
      ->check(CLI::Range(0.01, 20.0));
  tune.add_option("--margin", o.tune.margin, "part of what is found that explorers may use; default 0.7")
      ->check(CLI::Range(0.05, 1.0));
  tune.add_option("--servo-rate", o.servo_rate, "[Hz]; default 1000")->check(CLI::Range(100.0, 10000.0));
  tune.add_option("--patience", o.patience, "seconds in which a real device must become ready; default 30")
      ->check(CLI::Range(0.1, 3600.0));
  tune.add_option("--out", o.out, "workbench.toml whose [tuned.NAME] is written; the rest of it stays");
  add_workbench(tune, o);
  tune.footer(
      "The arm moves by itself: clear its way, let go of it, and keep a hand on F12; any key ends the run "
      "without\n"
      "force. A point draws it to each place, is made stiffer by quarters and knocks, until the arm does not "
      "come\n"
      "to rest. Explorers with --workbench use no more than the written stiffness on that device.\n"
      "Examples:\n  workbench tune --device simulated:falcon --json\n"
      "  workbench tune --device falcon:enable=pedal --out workbench.toml\n");
}

/// Verbs of devices in the hand.
void add_device_verbs(CLI::App& app, WorkbenchOptions& o) {
  constexpr const char* kDevice =
      "driver and its options: falcon[:firmware=FILE][,button=N|none][,enable=pedal], "
      "spacemouse[:invert=LETTERS], pedal, vrpn:NAME@HOST[:PORT][,cap=N], inverse3[:host=NAME][,port=N], "
      "dhd[:library=FILE], openhaptics[:library=FILE]";
  CLI::App& devices = *app.add_subcommand("devices", "devices that are plugged in, and drivers for them");
  add_common(devices, o);
  devices.add_option("--device", o.device, kDevice);
  devices.footer("Examples:\n  workbench devices\n  workbench devices --json\n");

  CLI::App& doctor = *app.add_subcommand(
      "doctor", "permissions, firmware, rate, jitter and latency of a device, and what to do about them");
  add_common(doctor, o);
  doctor.add_option("--device", o.device, std::string(kDevice) + "; default: all that are plugged in");
  doctor.add_option("--seconds", o.seconds, "of measurement; default 3")->check(CLI::Range(0.1, 3600.0));
  doctor.add_option("--patience", o.patience, "seconds in which it must become ready; default 30")
      ->check(CLI::Range(0.1, 3600.0));
  add_workbench(doctor, o);
  doctor.footer(
      "Ends with 0 where every device that it found, or the one of --device, is ready, else with 1.\n"
      "Examples:\n  workbench doctor\n  workbench doctor --device "
      "falcon:firmware=firmware.bin,enable=pedal\n");

  CLI::App& monitor =
      *app.add_subcommand("monitor", "read-outs of a device as it is moved; it shows no force");
  add_common(monitor, o);
  monitor.add_option("--device", o.device, kDevice)->required();
  monitor.add_option("--seconds", o.seconds, "how long; default 3")->check(CLI::Range(0.1, 86400.0));
  monitor.add_option("--rate", o.rate, "read-outs a second; default 10")->check(CLI::Range(0.1, 1000.0));
  add_workbench(monitor, o);
  monitor.footer(
      "Examples:\n  workbench monitor --device spacemouse --seconds 60\n"
      "  workbench monitor --device falcon --rate 100 --json\n"
      "  workbench monitor --device vrpn:Tracker0@lab,sensor=1\n"
      "  workbench monitor --device polhemus --workbench workbench.toml       poses without the tracker's "
      "distortion\n");
}

void add_controls_verb(CLI::App& app, WorkbenchOptions& o) {
  CLI::App& controls = *app.add_subcommand(
      "controls",
      "work a menu in space, its sliders and knobs, with a recorded stylus, and pick by ray and aperture");
  add_common(controls, o);
  controls.add_option("FILE", o.file, "recorded hands with the header t,x,y,z,qw,qx,qy,qz[,b0,...]")
      ->required();
  controls.add_option(
      "--workbench", o.nominal,
      "workbench.toml: distortion, tip of the stylus, and [interaction] middle, where the menu's "
      "upper left corner is; default: at 0,0,0");
  controls.add_option("--out", o.out, "table of what was pointed at, chosen, set and picked, a row a step");
  controls.add_option("--picture", o.picture, "PNG of the menu as it was left");
  controls.footer(
      "Examples:\n  workbench controls hands.csv --out controls.csv --picture controls.png\n"
      "  workbench controls hands.csv --workbench workbench.toml --json\n");
}

}  // namespace

WorkbenchOptions parse_workbench(const std::vector<std::string>& arguments) {
  WorkbenchOptions o;
  CLI::App app(
      "Calibrate devices and displays, judge what their errors do, and look after what is plugged in",
      "workbench");
  app.footer(kExamples);
  app.set_version_flag("--version", version_text("workbench"));
  add_common(app, o);

  CLI::App& calibrate = *app.add_subcommand("calibrate", "fit a model to a table of measurements");
  add_common(calibrate, o);
  add_kind(calibrate, o);
  calibrate.footer(kCalibrateExamples);
  calibrate.add_option("FILE", o.file, "table of measurements");
  calibrate.add_flag("--example", o.example, "made measurements of known truth in place of FILE");
  calibrate.add_option("--out", o.out, "workbench.toml whose section is written; the rest of it stays");
  calibrate.add_option("--report", o.report, "folder for a report with pictures");
  calibrate.add_option(
      "--pictures", o.pictures,
      "tracker: folder for pictures of the distortion: streamlines, icons of orientation and field");
  calibrate.add_option("--loss", o.loss, "how measurements far from the fit count: square, huber or cauchy")
      ->transform(
          words<Loss>({{"square", Loss::kSquare}, {"huber", Loss::kHuber}, {"cauchy", Loss::kCauchy}}));
  calibrate
      .add_option("--method", o.method, "tracker: polynomial, table, spline, combined or combined-spline")
      ->transform(words<TrackerMethod>({{"polynomial", TrackerMethod::kPolynomial},
                                        {"table", TrackerMethod::kTable},
                                        {"spline", TrackerMethod::kSpline},
                                        {"combined", TrackerMethod::kCombined},
                                        {"combined-spline", TrackerMethod::kCombinedSpline}}));
  calibrate.add_option("--degree", o.degree, "tracker: of the polynomial")->check(CLI::Range(0, kMaxDegree));
  calibrate
      .add_option("--nodes", o.nodes, "tracker: of the table along its longest side; 0: by the measurements")
      ->check(CLI::Range(0, 100));
  calibrate.add_flag("--offsets", o.offsets_only, "arm: the joints' offsets alone");
  calibrate.add_option("--nominal", o.nominal,
                       "arm: a workbench.toml whose [arm] the search starts from (default: PHANToM 3.0)");
  std::vector<double> noise;
  CLI::Option* noise_option =
      calibrate
          .add_option("--noise", noise,
                      "apparatus, coregister: standard deviations an axis of position [mm], orientation "
                      "[degrees] and markers [mm]")
          ->delimiter(',')
          ->expected(3)
          ->check(CLI::PositiveNumber);

  CLI::App& example = *app.add_subcommand("example", "write a made table of measurements");
  add_common(example, o);
  add_kind(example, o);
  example.add_option("--out", o.out, "CSV file")->required();

  CLI::App& report = *app.add_subcommand("report", "made calibrations of every kind, and head tracking");
  add_common(report, o);
  report.add_option("--out", o.out, "folder (default: workbench-report)");

  CLI::App& screen = *app.add_subcommand("screen", "what errors of head tracking do before your screen");
  add_common(screen, o);
  HeadErrorSetup& s = o.screen;
  screen.add_option("--distance", s.eye_distance, "of the eyes from the screen [m]");
  screen.add_option("--separation", s.separation, "of the eyes [m]");
  screen.add_option("--width", s.screen_width, "of the screen [m]");
  screen.add_option("--front", s.front, "how far objects stand out [m]");
  screen.add_option("--behind", s.behind, "how far they lie behind the screen [m]");
  screen.add_option("--pixel", s.pixel, "size of a pixel [m]");
  std::vector<double> position;
  double degrees = s.orientation_error / kDegree;
  screen.add_option("--position-error", position, "of the tracked head: along the screen, away from it [mm]")
      ->delimiter(',')
      ->expected(2);
  screen.add_option("--orientation-error", degrees, "[degrees]");
  screen.add_option("--out", o.out, "folder for a report with figures 4.14 and 4.15 for this screen");
  screen.footer(
      "Examples:\n  workbench screen --distance 0.5 --width 0.6 --pixel 0.00025\n"
      "  workbench screen --position-error 5,5 --orientation-error 1 --out screen-report\n");

  CLI::App& stability =
      *app.add_subcommand("stability", "how stiff walls may be, by rate, damping, delay, encoder");
  add_common(stability, o);
  stability.add_option("--out", o.out, "folder for the report")->required();
  stability.add_option(
      "--model", o.model,
      "device that is swept: premium3, falcon, ideal (default), or a file that describes one: "
      "NAME.toml with mass, damping, friction, encoder_step, sensor_delay, actuator_delay, "
      "peak_force, max_stiffness in SI units");
  stability.footer(
      "Examples:\n  workbench stability --out stability\n"
      "  workbench stability --model arm.toml --out stability\n");
  add_device_verbs(app, o);
  add_controls_verb(app, o);
  add_force_verbs(app, o);
  app.require_subcommand(0, 1);

  std::vector<std::string> reversed(arguments.rbegin(), arguments.rend());
  try {
    app.parse(reversed);
  } catch (const CLI::CallForHelp&) {
    o.text = app.help();
    return o;
  } catch (const CLI::CallForAllHelp&) {
    o.text = app.help("", CLI::AppFormatMode::All);
    return o;
  } catch (const CLI::CallForVersion& version) {
    o.text = std::string(version.what()) + "\n";
    return o;
  } catch (const CLI::ParseError& error) {
    throw usage_error(std::string(error.what()) + "; see workbench --help");
  }
  const auto verbs = app.get_subcommands();
  o.verb = verbs.empty() ? "report" : verbs.front()->get_name();
  if (!position.empty()) s.position_error = 1e-3 * Vec2{position[0], position[1]};
  s.orientation_error = degrees * kDegree;
  if (o.kind == "coregister") {
    // The arm's and, near its transmitter, the tracker's.
    o.noise = {.pose_position = 0.4e-3, .pose_orientation = 1.5e-3, .marker = 0.5e-3};
  }
  if (noise_option->count() > 0) o.noise = {1e-3 * noise[0], noise[1] * kDegree, 1e-3 * noise[2]};
  if (!o.pictures.empty() && o.kind != "tracker")
    throw usage_error("--pictures shows the distortion of a tracker: try calibrate tracker");
  if (o.verb == "feel" && o.device.empty() && o.path.empty())
    throw usage_error("feel needs a device, or a recorded hand: try --device simulated, or --path hand.csv");
  if (o.verb == "feel" && !o.out.empty() && o.path.empty())
    throw usage_error("feel writes a log of a recorded hand alone: give --path, or leave --out away");
  if (o.verb == "tune" && o.tune.least > o.tune.most) throw usage_error("tune: --least is above --most");
  if (o.verb == "calibrate" && o.example == !o.file.empty())
    throw usage_error("calibrate " + o.kind + " needs a table of measurements, or --example for made ones");
  if (verbs.empty() && o.out.empty()) o.force = true;  // the first five minutes: a demonstration is replaced
  if (o.verb == "report" && o.out.empty()) o.out = "workbench-report";
  return o;
}

}  // namespace palpate
