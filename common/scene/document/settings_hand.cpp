#include "common/scene/document/tables.h"

namespace palpate {
namespace {

const Setting kHandRows[] = {
    {.name = "annotation",
     .place = kTouchAt<&TouchOptions::annotations>,
     .help = "a place, length, angle (at the second place), curve or area in the data, with '=TEXT' behind "
             "it for a label; may be repeated",
     .value = "point|length|angle|curve|area:x,y,z,...",
     .heading = "Annotations",
     .groups = {Group::kNotes}},
    {.name = "drawn-lines",
     .place = kTouchAt<&TouchOptions::drawn_lines>,
     .help =
         "lines or tracts that a hand has drawn, as a window saves them as .csv; with its session it saves "
         "them next to that",
     .value = "FILE.csv",
     .heading = "Annotations",
     .groups = {Group::kNotes},
     .kinds = {FieldKind::kVector, FieldKind::kTensor, FieldKind::kFibre},
     .otherwise = "those of the session",
     .saved = false},

    {.name = "path",
     .place = kHandAt<&HandOptions::path>,
     .help = "table of the probe's path, header t,x,y,z[,b0]: one step a row",
     .value = "FILE.csv",
     .heading = "Touch",
     .groups = {Group::kPath},
     .saved = false},
    {.name = "workbench",
     .place = kHandAt<&HandOptions::workbench>,
     .help = "calibrations of a workbench, its screens for --head, and how hands work there: [interaction] "
             "technique = \"immersive\" takes tracked hands, with the header "
             "t,x,y,z,qw,qx,qy,qz[,b0,b1,hx,hy,hz,hqw,hqx,hqy,hqz,h0], in place of a mouse or a path",
     .value = "W.toml",
     .heading = "Touch",
     .groups = {Group::kPath, Group::kRecord, Group::kPicture, Group::kStudy},
     .saved = false},
    {.name = "tract",
     .place = kOutputAt<&OutputOptions::tract>,
     .help = "write the way of the proxy as a tract: .tck, .trk, or .vtp and .csv, which hold force, cl, cp "
             "and fa as well",
     .value = "FILE",
     .heading = "Output",
     .groups = {Group::kPath},
     .kinds = kTensors,
     .saved = false},
    {.name = "device",
     .place = kHandAt<&HandOptions::device>,
     .help = "simulated[:DEVICE][,hand=relaxed|firm][,button=N]: an arm and a hand that follow the path",
     .value = "D",
     .heading = "Touch",
     .groups = {Group::kHand},
     .otherwise = "the path itself",
     .saved = false},
    {.name = "device",
     .place = kHandAt<&HandOptions::device>,
     .help = "what moves the probe: mouse, replay:FILE.csv, a path with the header t,x,y,z, hands:FILE.csv, "
             "tracked hands at an immersive --workbench, simulated[:DEVICE][,hand=relaxed|firm][,button=N], "
             "an arm and a hand that follow the mouse or wander, or a real device by its driver: "
             "falcon[:firmware=FILE][,button=N|none][,enable=pedal], spacemouse, "
             "vrpn:NAME@HOST[:PORT][,cap=N], inverse3[:host=NAME], dhd[:library=FILE] (Force Dimension), "
             "openhaptics[:library=FILE], or, at an immersive --workbench, the tracker "
             "polhemus[:port=FILE][,hemisphere=+x]; an arm shows force only while its button, its button=N, "
             "or the pedal is held",
     .value = "D",
     .heading = "Touch",
     .groups = {Group::kRecord, Group::kStudy},
     .saved = false},
    {.name = "rate",
     .place = kHandAt<&HandOptions::rate>,
     .help = "updates of the hand a second",
     .value = "HZ",
     .heading = "Touch",
     .groups = {Group::kHand, Group::kRecord},
     .unit = "Hz",
     .range = {.lower = 100.0, .upper = 10'000.0},
     .saved = false},
    {.name = "head",
     .place = kViewAt<&ViewOptions::head>,
     .help = "show the data as the first screen of --workbench does to a head before it, which is there, is "
             "replayed, with 'hands' is that of --device hands:FILE.csv, or is seen by a tracker, named as "
             "for --device, at the head_station of the workbench; --screen all opens a window for each "
             "screen, in addition to that of the desktop",
     .value = "x,y,z[,qw,qx,qy,qz]|replay:FILE.csv",
     .heading = "View",
     .groups = {Group::kRecord},
     .otherwise = "the [head] of the workbench, or none",
     .saved = false},
    {.name = "head",
     .place = kViewAt<&ViewOptions::head>,
     .help = "the picture as a screen of --workbench shows it to this head: where its sensor is in the "
             "tracker's frame, in metres, and how it is turned, or a recording of that with the header "
             "t,x,y,z,qw,qx,qy,qz; --camera has no effect then",
     .value = "x,y,z[,qw,qx,qy,qz]|replay:FILE.csv",
     .heading = "View",
     .groups = {Group::kPicture},
     .saved = false},
    {.name = "screen",
     .place = kViewAt<&ViewOptions::screen>,
     .help = "which screen of --workbench, or all of them, each with a picture of its own",
     .value = "NAME|all",
     .heading = "View",
     .groups = {Group::kRecord, Group::kPicture},
     .otherwise = "its first",
     .saved = false},
    {.name = "play-rate",
     .place = kViewAt<&ViewOptions::play_rate>,
     .help = "time steps a second while they play",
     .value = "N",
     .heading = "View",
     .groups = {Group::kRecord},
     .unit = "1/s",
     .range = {.lower = 0.2, .upper = 60.0},
     .log_slider = true},
    {.name = "record",
     .place = kHandAt<&HandOptions::record>,
     .help =
         "write all input and every servo step to this file; one that --force overwrites stays as FILE~ until the new one is whole",
     .value = "FILE",
     .heading = "Touch",
     .groups = {Group::kRecord},
     .saved = false},
    {.name = "replay",
     .place = kHandAt<&HandOptions::replay>,
     .help = "play a recording back, with the same proxies and forces to the bit",
     .value = "FILE",
     .heading = "Touch",
     .groups = {Group::kReplay},
     .saved = false},
};

}  // namespace

std::span<const Setting> hand_settings() { return kHandRows; }

}  // namespace palpate
