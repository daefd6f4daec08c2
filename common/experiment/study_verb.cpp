#include "common/experiment/study_verb.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <map>
#include <mutex>
#include <numeric>
#include <string>
#include <utility>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/json.h"
#include "common/base/parallel.h"
#include "common/base/text.h"
#include "common/base/version.h"
#include "common/cli/verbs.h"
#include "common/cli/window_touch.h"
#include "common/compose/text/stereo_text.h"
#include "common/experiment/contact_sheet.h"
#include "common/experiment/participant_window.h"
#include "common/hand/mode/haptic_mode.h"
#include "common/render/png.h"
#include "common/study/study_folder.h"

namespace palpate {
namespace {

namespace fs = std::filesystem;

class StudyWork {
 public:
  StudyWork(const std::function<StudyTasks()>& make_tasks, const Document& options,
            const VerbContext& context)
      : make_tasks_(make_tasks), options_(options), asked_(options.study), context_(context) {}

  void make();
  void run();
  void simulate();
  void analyse();
  ExitCode replay();
  void sheet();

 private:
  /// The tasks of those names, prepared. Says out of how many stimuli they were chosen where `tell`.
  StudyTasks prepared(const std::vector<std::string>& names, const DesignRequest& design, bool tell);
  [[nodiscard]] StudyFolder open() const;
  /// The tasks of the folder, prepared; their stimuli are the folder's.
  [[nodiscard]] StudyTasks tasks_of(const StudyFolder& folder);
  /// Who sits down, and the place, which nobody else takes from then on.
  [[nodiscard]] std::pair<StudyParticipant, StudyLock> seated(const StudyFolder& folder) const;
  [[nodiscard]] std::pair<StudyParticipant, StudyLock> at_place(const StudyFolder& folder, int number,
                                                                const std::string& code) const;
  [[nodiscard]] RecordingHeader header() const;
  void print(const std::string& text) const { context_.console.print(text + "\n"); }

  const std::function<StudyTasks()>& make_tasks_;
  const Document& options_;
  const StudyOptions& asked_;
  const VerbContext& context_;
};

StudyTasks StudyWork::prepared(const std::vector<std::string>& names, const DesignRequest& design,
                               bool tell) {
  StudyTasks all = make_tasks_(), out;
  for (const std::string& name : names) {
    const auto found = std::ranges::find_if(all, [&](const auto& task) { return task->info().name == name; });
    if (found == all.end()) {
      std::string known;
      for (const auto& task : all) known += (known.empty() ? "" : ", ") + task->info().name;
      throw usage_error("--tasks: there is no task '" + name + "'; tasks of " + context_.explorer.name +
                        " are " + known);
    }
    const std::string line =
        (*found)->prepare(design.seed, design.practice + design.recorded, context_.progress);
    context_.progress.check();
    if (tell) print(line);
    out.push_back(*found);
  }
  return out;
}

StudyTasks StudyWork::tasks_of(const StudyFolder& folder) {
  StudyTasks tasks = prepared(folder.plan().tasks, folder.plan().design, false);
  folder.check_stimuli(tasks);
  return tasks;
}

StudyFolder StudyWork::open() const {
  StudyFolder folder(asked_.folder);
  if (folder.plan().program != context_.explorer.name) {
    throw usage_error(asked_.folder.string() + " is an experiment of " + folder.plan().program + ": try " +
                      folder.plan().program + " study " + asked_.action + " " + asked_.folder.string());
  }
  return folder;
}

RecordingHeader StudyWork::header() const {
  RecordingHeader header;
  header.program = context_.explorer.name;
  header.version = version();
  header.build = build_text();
  return header;
}

void StudyWork::make() {
  StudyPlan plan{.program = context_.explorer.name, .version = version(), .guidance = asked_.guidance};
  for (const auto& task : make_tasks_()) plan.tasks.push_back(task->info().name);
  if (!asked_.tasks.empty()) {
    plan.tasks.clear();
    for (const std::string_view name : split(asked_.tasks, ',')) plan.tasks.emplace_back(trimmed(name));
  }
  plan.design = {.participants = asked_.participants,
                 .tasks = static_cast<int>(plan.tasks.size()),
                 .practice = asked_.practice,
                 .recorded = asked_.recorded,
                 .seed = options_.common.seed};
  StudyFolder::check(plan);
  const DesignBalance balance = balance_of(make_design(plan.design));
  const StudyTasks tasks = prepared(plan.tasks, plan.design, true);
  const StudyFolder folder = StudyFolder::make(asked_.folder, plan, tasks, options_.common.force);
  print(folder.path().string() + ": " + std::to_string(folder.design().size()) + " trials of " +
        counted(static_cast<std::uint64_t>(asked_.participants), "participant"));
  const std::array<std::pair<const char*, int>, 5> counts{
      {{"conditions of a participant", balance.conditions_of_participant},
       {"conditions of a stimulus", balance.conditions_of_stimulus},
       {"conditions at a place of the order", balance.conditions_of_place},
       {"stimuli at a place of the order", balance.stimuli_at_place},
       {"tasks at a place of the session", balance.tasks_at_place}}};
  Json json{
      {"out", folder.path().string()}, {"trials", folder.design().size()}, {"sequences", balance.sequences}};
  if (asked_.recorded < 2 * kLeastOfCondition)
    context_.console.note("--recorded " + std::to_string(asked_.recorded) + " is too few: analyse needs " +
                          std::to_string(kLeastOfCondition) +
                          " trials of each condition of a participant, and leaves everybody out; " +
                          std::to_string(2 * kLeastOfCondition) + " or more are needed");
  std::string off;
  for (const auto& [what, difference] : counts) {
    json["imbalance"][what] = difference;
    if (difference != 0)
      off += std::string(off.empty() ? "" : ", ") + what + " by " + std::to_string(difference);
  }
  if (off.empty()) {
    print(
        "balanced: conditions, stimuli and tasks occur equally often, for participants and at all places; " +
        std::to_string(balance.sequences) + " sequences of conditions");
  } else {
    context_.console.note("counts that should be equal differ: " + off + "; a multiple of " +
                          std::to_string(std::lcm(asked_.recorded, plan.design.tasks)) +
                          " participants (and of 4 trials) has them equal");
  }
  context_.console.print_json(json.dump());
}

void StudyWork::simulate() {
  StudyFolder folder = open();
  const StudyPlan& plan = folder.plan();
  const StudyLock alone = folder.hold(StudyLock::Kind::kAlone, "study simulate");
  const StudyTasks tasks = tasks_of(folder);
  std::vector<StudyParticipant> participants;
  const std::vector<StudyParticipant> known = folder.participants();
  for (int number = 0; number < plan.design.participants; ++number) {
    const auto found = std::ranges::find(known, number, &StudyParticipant::number);
    if (found != known.end() && !found->simulated) continue;
    StudyParticipant one{StudyFolder::code_of(number), number, true, {}};
    if (found != known.end()) one.code = found->code;
    if (!asked_.participant.empty() && asked_.participant != one.code) continue;
    one.traits = values_of(draw_traits(plan.design.seed, number));
    folder.enter(one);
    participants.push_back(std::move(one));
  }
  if (participants.empty())
    throw usage_error("--participant " + asked_.participant +
                      ": the design has no such simulated participant");
  std::vector<std::pair<const StudyParticipant*, PlannedTrial>> left;
  const auto find_left = [&] {
    left.clear();
    for (const StudyParticipant& one : participants) {
      for (const PlannedTrial& trial : folder.left_for(one)) left.emplace_back(&one, trial);
    }
    return !left.empty();
  };
  const RecordingHeader head = header();
  std::atomic<std::size_t> timed_out{0}, flawed{0};
  std::size_t done = 0;
  for (; find_left(); done += left.size()) {  // again for those that are to be repeated
    context_.progress.begin("simulated participants", left.size());
    parallel_for(left.size(), options_.common.threads, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) {
        context_.progress.check();
        const auto& [who, planned] = left[i];
        const StudyTask& task = *tasks[as_size(planned.task)];
        const std::unique_ptr<StudyTrial> trial = task.open(planned.stimulus);
        const ChainSpec words{task.info().name, planned.stimulus, planned.guided, plan.guidance};
        const RandomStream random({plan.design.seed, 12, static_cast<std::uint64_t>(who->number),
                                   static_cast<std::uint64_t>(planned.task),
                                   static_cast<std::uint64_t>(folder.run_of(planned))});
        const TrialRun run = simulate_trial(*trial, task.info(), words,
                                            draw_traits(plan.design.seed, who->number), random, &head);
        if (run.outcome.timed_out) ++timed_out;
        if (run.outcome.flaws.any()) ++flawed;
        folder.write(
            {who->code, task.info().name, folder.run_of(planned), planned.stimulus, planned.practice,
             planned.guided, true, "simulated:premium3,hand=relaxed", run.outcome, HUGE_VAL, planned.attempt},
            run.recording, run.steps);
        context_.progress.advance();
      }
    });
  }
  print("simulated: " + counted(participants.size(), "participant") + ", " + counted(done, "trial") + ", " +
        std::to_string(timed_out.load()) + " ended by the clock, " + std::to_string(flawed.load()) +
        " without force at some step -> " + folder.path().string());
  context_.console.print_json(Json{
      {"participants", participants.size()},
      {"trials", done},
      {"timed_out", timed_out.load()},
      {"flawed", flawed.load()},
      {"simulated", true}}.dump());
}

void StudyWork::analyse() {
  const StudyFolder folder = open();
  Document document = options_;
  if (document.output.file.empty()) {
    document.output.file = folder.path() / "analysis";
    document.common.force = true;  // the last one gives way
  }
  run_study("experiment", document, {document.output.file}, context_);
}

ExitCode StudyWork::replay() {
  const StudyFolder folder = open();
  const StudyTasks tasks = tasks_of(folder);
  std::vector<TrialRecord> records = folder.trials();
  std::erase_if(records, [&](const TrialRecord& r) {
    const bool other = !asked_.participant.empty() && r.participant != asked_.participant;
    return other || (!asked_.trial.empty() && r.task + "/" + std::to_string(r.run) != asked_.trial);
  });
  if (records.empty())
    throw usage_error("there is no such trial; name one by --participant P01 --trial " +
                      folder.plan().tasks.front() + "/1");
  context_.progress.begin("replaying", records.size());
  std::vector<std::string> differing(records.size());
  parallel_for(records.size(), options_.common.threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      context_.progress.check();
      const TrialRecord& r = records[i];
      const auto task = std::ranges::find_if(tasks, [&](const auto& t) { return t->info().name == r.task; });
      const std::unique_ptr<StudyTrial> trial = (*task)->open(r.stimulus);
      const TrialReplay again = replay_trial(*trial, folder.recording(r.participant, r.task, r.run));
      const bool same = again.outcome.error == r.outcome.error &&
                        again.outcome.seconds == r.outcome.seconds &&
                        again.outcome.reached == r.outcome.reached;
      const ChainSpec logged{r.task, r.stimulus, r.guided, folder.plan().guidance, r.most_stiffness};
      if (again.spec != logged || again.outcome.begin != r.outcome.begin ||
          again.outcome.end != r.outcome.end) {
        differing[i] = r.participant + " " + r.task + "/" + std::to_string(r.run) +
                       ": the recording is of '" + chain_text(again.spec) + "', steps " +
                       std::to_string(again.outcome.begin) + " to " + std::to_string(again.outcome.end) +
                       "; logged is '" + chain_text(logged) + "', steps " + std::to_string(r.outcome.begin) +
                       " to " + std::to_string(r.outcome.end);
      } else if (!same || !again.identical) {
        differing[i] = r.participant + " " + r.task + "/" + std::to_string(r.run) + ": error " +
                       exact_number(again.outcome.error) + " mm, logged " + exact_number(r.outcome.error) +
                       " mm; " + again.verdict;
      }
      context_.progress.advance();
    }
  });
  std::size_t differ = 0;
  for (const std::string& line : differing) {
    if (line.empty()) continue;
    ++differ;
    print(line);
  }
  print(std::to_string(records.size() - differ) + " of " + counted(records.size(), "trial") +
        " give the logged error, time, proxies and forces again, bit for bit");
  context_.console.print_json(Json{{"trials", records.size()}, {"differ", differ}}.dump());
  return differ == 0 ? ExitCode::kDone : ExitCode::kWorkFailed;
}

void StudyWork::sheet() {
  const StudyFolder folder = open();
  const StudyTasks tasks = tasks_of(folder);
  const fs::path out = options_.output.file.empty() ? folder.path() / "sheet.png" : options_.output.file;
  const Image sheet =
      contact_sheet(tasks, folder.plan().design.practice + folder.plan().design.recorded, context_.progress);
  write_png(out, sheet,
            {{"Software", version_text(context_.explorer.name)}, {"Description", context_.command_line}});
  print(out.string() + ": " + std::to_string(sheet.width) + " x " + std::to_string(sheet.height) + " pixels");
  context_.console.print_json(
      Json{{"out", out.string()}, {"width", sheet.width}, {"height", sheet.height}}.dump());
}

std::pair<StudyParticipant, StudyLock> StudyWork::at_place(const StudyFolder& folder, int number,
                                                           const std::string& code) const {
  return {StudyParticipant{code, number, false, {}}, folder.hold_place(number, "study run of " + code)};
}

std::pair<StudyParticipant, StudyLock> StudyWork::seated(const StudyFolder& folder) const {
  const std::vector<StudyParticipant> known = folder.participants();
  const std::string& code = asked_.participant;
  const int places = folder.plan().design.participants;
  if (const auto found = std::ranges::find(known, code, &StudyParticipant::code); found != known.end()) {
    if (found->simulated)
      throw usage_error("--participant " + code + " is a simulated one; give another code");
    return at_place(folder, found->number, code);
  }
  const auto taken = [&](int number) {
    return std::ranges::find(known, number, &StudyParticipant::number) != known.end();
  };
  // A code of the design is of the place that it names.
  const auto named = code.starts_with('P') ? parsed<int>(std::string_view(code).substr(1)) : std::nullopt;
  if (named && *named > 0 && code == StudyFolder::code_of(*named - 1)) {
    if (*named > places)
      throw usage_error("--participant " + code + ": the design has places P01 to " +
                        StudyFolder::code_of(places - 1));
    if (taken(*named - 1))
      throw usage_error("--participant " + code + ": somebody with another code has that place");
    print(code + " is new");
    return at_place(folder, *named - 1, code);
  }
  for (int number = 0; number < places; ++number) {
    if (taken(number)) continue;
    if (code.empty()) {
      auto out = at_place(folder, number, StudyFolder::code_of(number));
      print(out.first.code + " is new");
      return out;
    }
    try {
      auto out = at_place(folder, number, code);
      print(code + " is new, at place " + std::to_string(number) + " of design.tsv");
      return out;
    } catch (const Error& error) {  // somebody who is about to begin there
      if (error.code() != ExitCode::kUsage) throw;
    }
  }
  throw usage_error("all places of the design are taken; make one with more --participants");
}

void StudyWork::run() {
  StudyFolder folder = open();
  for (const char* device : {"replay:", "hands:"}) {
    if (options_.hand.device.starts_with(device))
      throw usage_error("--device " + options_.hand.device +
                        " is a file, and no participant; name a device, mouse or simulated");
  }
  if (!options_.hand.replay.empty()) throw usage_error("study run replays no recording; study replay does");
  const StereoView stereo = stereo_of(options_.view);
  if (stereo.mode == StereoMode::kAnaglyph || stereo.mode == StereoMode::kAnaglyphGrey)
    context_.console.note(
        "an anaglyph changes the colours of which the tasks speak: red line and blue dot are seen as others, in grey they are not "
        "told from displayed lines; all other modes of --stereo keep them");
  const StudyLock session = folder.hold(StudyLock::Kind::kShared, "study run");
  const auto seat = seated(folder);
  const StudyParticipant& who = seat.first;
  ParticipantWindowOptions window;
  window.touch = window_touch(modes_of(context_.explorer.kind), options_, context_);
  window.device = options_.hand.device;
  window.stereo = stereo;
  window.tell = [this](const std::string& what) { context_.console.note(what); };
  window.stop_requested = [this] { return context_.progress.cancelled(); };
  if (window.touch.tracker)
    throw usage_error("--device " + options_.hand.device +
                      ": a tracker shows no force; an experiment needs an arm, mouse or simulated");
  if (!window.touch.link && !window.touch.simulated)
    context_.console.note(
        "a mouse shows no force, so that both conditions feel alike; --device simulated leads a "
        "simulated hand that feels it, or name a device");
  const StudyTasks tasks = tasks_of(folder);
  const std::size_t before = folder.left_for(who).size();
  run_participant_window(folder, tasks, who, header(), window);
  const std::size_t left = folder.left_for(who).size();
  print(who.code + ": " + counted(before - left, "trial") + " done, " + std::to_string(left) + " left" +
        (left > 0 ? "; go on with --participant " + who.code : ""));
  context_.console.print_json(
      Json{{"participant", who.code}, {"done", before - left}, {"left", left}}.dump());
}

}  // namespace

Verb study_verb(std::function<StudyTasks()> tasks, std::vector<UsageExample> examples) {
  return {
      .name = "study",
      .summary = "an experiment: does guidance of the hand help?",
      .details =
          "make      draws stimuli and design from --seed, into DIR\n"
          "run       the window in which a participant sits; goes on where it was left\n"
          "simulate  simulated participants take the places that are free\n"
          "analyse   tests, tables and figures of what is there: DIR/analysis/index.html\n"
          "replay    plays recorded trials back and compares errors and forces to the last bit\n"
          "sheet     a picture of all stimuli",
      .groups = {Group::kStudy},
      .examples = std::move(examples),
      .run = [tasks = std::move(tasks)](const Document& options, const VerbContext& context) {
        const StudyOptions& asked = options.study;
        if (asked.action.empty())
          throw usage_error("study needs to know what to do: make, run, simulate, analyse, replay or sheet");
        if (asked.folder.empty())
          throw usage_error("study " + asked.action + " needs the folder of the experiment");
        StudyWork work(tasks, options, context);
        if (asked.action == "make") work.make();
        if (asked.action == "run") work.run();
        if (asked.action == "simulate") work.simulate();
        if (asked.action == "analyse") work.analyse();
        if (asked.action == "sheet") work.sheet();
        return asked.action == "replay" ? work.replay() : ExitCode::kDone;
      }};
}

}  // namespace palpate
