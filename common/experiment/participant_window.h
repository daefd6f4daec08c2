/// The window in which a participant of an experiment sits: instructions, trials, breaks and a form.
///
/// At each trial the hand is pulled to the blue start, where the device can; the space bar begins, once the
/// cursor is at the start, and ends. A trial is on the disk before the next one begins: a window that is killed
/// loses the trial at work and nothing else, and the next one goes on from there.
///
/// No trial begins without force: what keeps it away is said, and the space bar switches on what was switched off. A
/// trial in which it was cut is kept as it was, told, and repeated at the end of its block (study_folder.h).
///
/// Where each eye has a half of the window, it has a whole picture and all of the text in it.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "common/hand/probe_options.h"
#include "common/render/camera.h"
#include "common/render/stereo/stereo_view.h"
#include "common/study/study_folder.h"

namespace palpate {

/// What is on the screen.
enum class ParticipantScreen : std::uint8_t {
  kWelcome,  ///< text; the space bar goes on, likewise below
  kTask,     ///< what is to be done in the task that follows
  kStart,    ///< a trial: the cursor is to be brought to the start
  kTrial,    ///< a trial at work
  kPause,    ///< a break, as long as is liked
  kForm,     ///< questions
  kThanks
};

/// The window as somebody sees it who works it: for tests and demonstrations.
struct ParticipantSight {
  int frame = 0;
  ParticipantScreen screen = ParticipantScreen::kWelcome;
  int width = 0, height = 0;          ///< [pixels] of what an eye sees: the window, or its half
  Camera camera;                      ///< of a trial
  const StudyTrial* trial = nullptr;  ///< null on other screens
  Vec3 cursor{0.0};                   ///< [m]
  Vec3 lead{0.0};                     ///< [m] where the mouse leads it
  bool guided = false;                ///< the condition of the trial
  std::string task;                   ///< name; empty on other screens
  std::string hint;                   ///< what is written below the picture
  std::size_t left = 0;               ///< trials
};

struct ParticipantWindowOptions {
  ProbeSessionOptions touch;  ///< of which device, limits and rate are taken
  std::string device;         ///< how it was named
  StereoView stereo;
  int width = 1152, height = 864;  ///< [screen coordinates] those of the reference
  /// What whoever leads the experiment is told: a line at a time, when there is no force. Null: nobody listens.
  std::function<void(const std::string&)> tell;
  std::function<bool()> stop_requested;  ///< asked each frame; true closes the window
  /// Called at each frame: for who works the window, or tells of it.
  std::function<void(const ParticipantSight&)> each_frame;
  /// Where a picture of the window is saved that was asked for at the end of a frame; empty: none.
  std::function<std::filesystem::path(const ParticipantSight&)> photograph;
};

/// Shows the window until the participant has done all trials, or it is closed. Call it on the main thread.
/// @param who is entered in the folder. @throws Error (work failed) where no window can be opened or a trial cannot be
/// written.
void run_participant_window(StudyFolder& folder, const StudyTasks& tasks, const StudyParticipant& who,
                            const RecordingHeader& header, const ParticipantWindowOptions& options);

}  // namespace palpate
