// The built program, run as a user runs it.

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <thread>

#include "tests/e2e/explorer_test.h"
#include "tests/support/shared_data.h"

namespace palpate::test {
namespace {

class Flow : public ExplorerTest {
 protected:
  Flow() : ExplorerTest("flow") {}
};

std::size_t sum_of(const Json& ends) {
  std::size_t sum = 0;
  for (const auto& item : ends.items()) sum += item.value().get<std::size_t>();
  return sum;
}

TEST_F(Flow, HelpsWithExamplesAndListsItsVerbs) {
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{"--help"},
                                                    {"trace", "--help"},
                                                    {"info", "-h"},
                                                    {"probe", "--help"},
                                                    {"render", "--help"},
                                                    {"report", "--help"},
                                                    {"open", "--help"}}) {
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_NE(result.out.find("Examples:"), std::string::npos) << arguments[0];
    EXPECT_NE(result.out.find("  flow "), std::string::npos) << arguments[0];
    EXPECT_EQ(result.err, "");
  }
  EXPECT_EQ(run({"--version"}).out.rfind("flow (Palpate) ", 0), 0U);
}

TEST_F(Flow, ListsTheBuiltInExamples) {
  const ProgramResult result = run({"--example", "list"});
  EXPECT_EQ(result.exit_code, 0);
  for (const char* name : {"tornado", "abc", "hill", "cavity", "saddle", "boundary-layer"}) {
    EXPECT_NE(result.out.find(name), std::string::npos) << name;
  }
  EXPECT_GE(json({"info", "--example", "list"})["examples"].size(), 6U);
}

// Below what the values leave open no tolerance can be kept, which is said.
TEST_F(Flow, SaysThatAToleranceIsBelowTheRoundingOfTheValues) {
  const auto written = [&](const std::string& type) {
    std::string text =
        "# vtk DataFile Version 3.0\nrow\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 2 2\nORIGIN 0 0 0\n"
        "SPACING 1 1 1\nPOINT_DATA 8\nVECTORS v " +
        type + "\n";
    for (int p = 0; p < 8; ++p) text += "0.1 0.3 0.7\n";
    return folder_.write(type + ".vtk", text).string();
  };
  const auto trace = [&](const std::string& type, const std::string& tolerance) {
    const ProgramResult result = run({"trace", written(type), "--seeds", "point:0.5,0.2,0.1", "--out",
                                      "t.vtp", "--force", "--tolerance", tolerance});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.out;
  };
  EXPECT_NE(trace("float", "1e-9").find("--tolerance 1e-09 cannot be kept: values are of single precision"),
            std::string::npos);
  EXPECT_EQ(trace("float", "1e-6").find("cannot be kept"), std::string::npos);
  EXPECT_EQ(trace("double", "1e-9").find("cannot be kept"), std::string::npos);
}

TEST_F(Flow, TracesAnExampleIntoEveryFormat) {
  for (const char* name : {"a.vtp", "a.csv", "a.tck", "a.trk"}) {
    const ProgramResult result = run({"trace", "--example", "abc", "--seeds", "grid:2,2,2", "--out", name});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_GT(std::filesystem::file_size(folder_.path(name)), 100U) << name;
  }
  const std::string csv = read_file(folder_.path("a.csv"));
  EXPECT_EQ(csv.substr(0, csv.find('\n')), "line,seed,point,x,y,z,time,arc,speed,error,termination");
  EXPECT_EQ(files().size(), 4U) << "temporary files stay";
}

TEST_F(Flow, StatesTheKeysOfTheContract) {
  const Json object =
      json({"trace", "--example", "abc", "--seeds", "random:20", "--direction", "both", "--out", "l.vtp"});
  for (const char* key : {"seeds", "lines", "points", "ends", "integrator", "tolerance", "threads",
                          "seconds_load", "seconds_prepare", "seconds_trace", "error_max"}) {
    EXPECT_TRUE(object.contains(key)) << key;
  }
  EXPECT_EQ(object["seeds"], 20);
  EXPECT_EQ(object["lines"], 40);
  EXPECT_EQ(sum_of(object["ends"]), 40U);
  EXPECT_GT(object["error_max"].get<double>(), 0.0);
}

/// A rotation about z at the rate 1 + t on 5^3 points, at the times 0, 0.1, ....
/// A particle turns by t + t^2 / 2, which linear interpolation in time has exactly.
void write_growing_turn(const TempFolder& folder, int steps) {
  std::string list = "<VTKFile type=\"Collection\"><Collection>";
  for (int step = 0; step < steps; ++step) {
    const double rate = 1.0 + 0.1 * step;
    std::ostringstream text;
    text.precision(17);
    text
        << "# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 5 5 5\nORIGIN -1 -1 -1\n"
           "SPACING 0.5 0.5 0.5\nPOINT_DATA 125\nVECTORS v double\n";
    for (int p = 0; p < 125; ++p) {
      const double x = -1.0 + 0.5 * (p % 5), y = -1.0 + 0.5 * (p / 5 % 5);
      text << -rate * y << " " << rate * x << " 0\n";
    }
    const std::string name = "t" + std::to_string(step) + ".vtk";
    (void)folder.write(name, text.str());
    list += "<DataSet timestep=\"" + std::to_string(0.1 * step) + "\" file=\"" + name + "\"/>";
  }
  (void)folder.write("turn.pvd", list + "</Collection></VTKFile>");
}

TEST_F(Flow, TracesLinesInTime) {
  write_growing_turn(folder_, 11);
  const Json object =
      json({"trace", "turn.pvd", "--lines", "pathlines", "--seeds", "point:0.5,0,0", "--out", "l.csv"});
  EXPECT_EQ(object["kind"], "pathlines");
  EXPECT_EQ(object["ends"]["end_of_time"], 1);
  EXPECT_EQ(object["in_time"]["steps"], 11);
  EXPECT_EQ(object["in_time"]["steps_in_memory"], 2);
  EXPECT_LT(object["in_time"]["error_sampling"].get<double>(), 1e-4);
  const std::string csv = read_file(folder_.path("l.csv"));
  EXPECT_EQ(csv.substr(0, csv.find('\n')), "line,seed,point,x,y,z,time,arc,speed,error,termination,moment");
  const std::string last = csv.substr(csv.rfind('\n', csv.size() - 2) + 1);
  std::istringstream fields(last);
  std::vector<double> numbers;
  for (std::string field; std::getline(fields, field, ',') && numbers.size() < 7;)
    numbers.push_back(std::stod(field));
  ASSERT_EQ(numbers.size(), 7U) << last;
  EXPECT_NEAR(numbers[3], 0.5 * std::cos(1.5), 1e-4);
  EXPECT_NEAR(numbers[4], 0.5 * std::sin(1.5), 1e-4);
  EXPECT_NEAR(numbers[6], 1.0, 1e-12);

  EXPECT_EQ(json({"trace", "turn.pvd", "--lines", "streaklines", "--time", "0.5", "--seeds",
                  "point:0.5,0,0"})["points"],
            65);
  EXPECT_EQ(json({"trace", "turn.pvd", "--lines", "timelines", "--seeds", "line:0,0,0,0.5,0,0,9",
                  "--time-order", "cubic", "--release-every", "0.25"})["lines"],
            4);
  EXPECT_EQ(run({"render", "turn.pvd", "--lines", "pathlines", "--seeds", "grid:2,2,2", "--size", "64x48",
                 "--out", "p.png"})
                .exit_code,
            0);
  const auto refused = [&](const std::vector<std::string>& arguments, const std::string& why) {
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_NE(result.err.find(why), std::string::npos) << result.err;
  };
  refused({"trace", "turn.pvd", "--lines", "timelines", "--seeds", "random:9", "--json"}, "seeds in a row");
  refused({"trace", "turn.pvd", "--lines", "pathlines", "--until", "9", "--seeds", "grid:2,2,2", "--json"},
          "--until 9");
  refused({"trace", "t3.vtk", "--lines", "pathlines", "--seeds", "grid:2,2,2", "--json"}, "two steps");
  refused({"trace", "--example", "abc", "--lines", "pathlines", "--seeds", "grid:2,2,2", "--json"},
          "two steps");
}

TEST_F(Flow, CountsAndNamesSeedsOutside) {
  folder_.write("s.csv", "x,y,z\n1,1,1\n99,0,0\n");
  const ProgramResult result = run({"trace", "--example", "abc", "--seeds", "s.csv", "--out", "l.csv"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(result.err.find("1 seed outside"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("(99, 0, 0)"), std::string::npos) << result.err;
  const Json object = json({"trace", "--example", "abc", "--seeds", "s.csv", "--out", "l.csv", "--force"});
  EXPECT_EQ(object["seeds"], 2);
  EXPECT_EQ(object["lines"], 1);
  EXPECT_EQ(object["seeds_outside"], 1);
  EXPECT_EQ(object["first_outside"][0]["seed"], 1);
  EXPECT_EQ(object["first_outside"][0]["position"][0], 99.0);
  // However many there are, the object stays short.
  const Json many = json({"trace", "--example", "abc", "--seeds", "line:1,1,1,99,0,0,500", "--out", "m.csv"});
  EXPECT_GT(many["seeds_outside"], 400);
  EXPECT_EQ(many["first_outside"].size(), 10U);
}

// Lines in a file are no volume: `info` describes them, nothing is traced in them, their points are seeds.
TEST_F(Flow, DescribesLinesAndStartsFromTheirPointsButTracesNothingInThem) {
  EXPECT_EQ(run({"trace", "--example", "abc", "--seeds", "grid:2,1,1", "--step", "1", "--max-length", "3",
                 "--out", "l.vtp"})
                .exit_code,
            0);
  const Json info = json({"info", "l.vtp"});
  EXPECT_EQ(info["blocks"][0]["grid"], "polygonal");
  EXPECT_EQ(info["blocks"][0]["cells"], 2);
  EXPECT_FALSE(info["arrays"].empty());
  EXPECT_FALSE(info["not_volume"].is_null());
  const ProgramResult text = run({"info", "l.vtp", "--explain"});
  EXPECT_EQ(text.exit_code, 0) << text.err;
  EXPECT_NE(text.out.find("nothing to trace"), std::string::npos) << text.out;

  for (const char* verb : {"trace", "render", "report"}) {
    const ProgramResult refused = run(
        {verb, "l.vtp", "--seeds", "random:3", "--out", std::string(verb) == "render" ? "r.png" : "r.vtp"});
    EXPECT_EQ(refused.exit_code, 3) << verb;
    EXPECT_NE(refused.err.find("not a volume"), std::string::npos) << refused.err;
    EXPECT_EQ(std::count(refused.err.begin(), refused.err.end(), '\n'), 1) << refused.err;
  }
  const Json again = json({"trace", "--example", "abc", "--seeds", "l.vtp", "--out", "again.vtp"});
  EXPECT_EQ(again["seeds"], info["blocks"][0]["points"]);
}

TEST_F(Flow, SaysWhyThereIsNoLineAndWritesNothing) {
  const ProgramResult result =
      run({"trace", "--example", "abc", "--seeds", "point:99,0,0", "--out", "l.vtp"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find("no line"), std::string::npos);
  EXPECT_TRUE(files().empty());
  EXPECT_TRUE(
      json({"trace", "--example", "abc", "--seeds", "point:99,0,0", "--out", "l.vtp"}, 1).contains("error"));
}

TEST_F(Flow, SaysWhatToChangeWhereALimitEndsLines) {
  const ProgramResult result =
      run({"trace", "--example", "abc", "--seeds", "grid:2,2,2", "--max-length", "0.5", "--out", "l.vtp"});
  EXPECT_NE(result.out.find("--max-length"), std::string::npos) << result.out;
}

TEST_F(Flow, EndsLinesOnAPlane) {
  const ProgramResult result = run({"trace", "--example", "abc", "--seeds", "point:3,3,3", "--stop-plane",
                                    "-1,0,0,-3.5", "--direction", "both", "--out", "l.csv"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(read_file(folder_.path("l.csv")).find("stopped_by_rule"), std::string::npos);
}

TEST_F(Flow, RefusesToOverwriteBeforeAnyWorkIsDone) {
  folder_.write("l.vtp", "precious");
  // The input does not exist either: the output is looked at first.
  const ProgramResult refused = run({"trace", "missing.vtk", "--seeds", "grid:2,2,2", "--out", "l.vtp"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("--force"), std::string::npos);
  EXPECT_EQ(read_file(folder_.path("l.vtp")), "precious");
  EXPECT_EQ(
      run({"trace", "--example", "abc", "--seeds", "grid:2,2,2", "--out", "l.vtp", "--force"}).exit_code, 0);
  EXPECT_NE(read_file(folder_.path("l.vtp")), "precious");
}

TEST_F(Flow, ListsTheKnownWordsForAnUnknownOne) {
  const ProgramResult integrator =
      run({"trace", "--example", "abc", "--seeds", "grid:1,1,1", "--integrator", "rk5", "--out", "l.vtp"});
  EXPECT_EQ(integrator.exit_code, 2);
  for (const char* name : {"exact", "euler", "rk4", "bs32", "rk34", "dp54", "rodas4"}) {
    EXPECT_NE(integrator.err.find(name), std::string::npos) << name;
  }
  EXPECT_EQ(run({"info", "--example", "nothing"}).exit_code, 2);
  EXPECT_EQ(run({"trace", "--example", "abc", "--seeds", "cube:1", "--out", "l.vtp"}).exit_code, 2);
  EXPECT_EQ(run({"trace", "--example", "abc", "--seeds", "grid:1,1,1", "--direction", "up", "--out", "l.vtp"})
                .exit_code,
            2);
  EXPECT_EQ(run({"trace", "--example", "abc", "--seeds", "grid:1,1,1", "--out", "l.doc"}).exit_code, 2);
  EXPECT_EQ(run({"trace", "--example", "abc", "--seeds", "grid:1,1,1"}).exit_code, 2);
  EXPECT_EQ(run({"trace", "--example", "abc", "--out", "l.vtp"}).exit_code, 2);
  EXPECT_EQ(run({"trace", "--example", "abc", "--seeds", "grid:1,1,1", "--out", "l.vtp", "--tolerance", "0"})
                .exit_code,
            2);
  EXPECT_EQ(run({"info", "--no-such-option"}).exit_code, 2);
  EXPECT_EQ(run({"info"}).exit_code, 2);
  EXPECT_EQ(run({"render", "--example", "abc", "--out", "p.png", "--size", "0x10"}).exit_code, 2);
  EXPECT_EQ(run({"render", "--example", "abc", "--out", "p.png", "--color", "smell"}).exit_code, 2);
  EXPECT_TRUE(files().empty());
}

TEST_F(Flow, EndsWithThreeForInputsThatAreMissingOrBroken) {
  folder_.write("noise.vtk", "this is no data file");
  folder_.write("empty.vtk", "");
  for (const char* name : {"missing.vtk", "noise.vtk", "empty.vtk", "."}) {
    const ProgramResult result = run({"info", name});
    EXPECT_EQ(result.exit_code, 3) << name << ": " << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << "one clear line: " << result.err;
    EXPECT_EQ(json({"info", name}, 3)["exit"], 3);
  }
  EXPECT_EQ(run({"trace", "--example", "abc", "--seeds", "missing.csv", "--out", "l.vtp"}).exit_code, 3);
  EXPECT_EQ(run({"missing.vtk"}).exit_code, 3);
  EXPECT_EQ(run({"open", "missing.vtk"}).exit_code, 3);
  const ProgramResult word = run({"tarce"});
  EXPECT_EQ(word.exit_code, 3);
  EXPECT_NE(word.err.find("trace"), std::string::npos) << "the verbs are named: " << word.err;
}

TEST_F(Flow, EndsWithOneForAnOutputThatCannotBeWritten) {
  EXPECT_EQ(
      run({"trace", "--example", "abc", "--seeds", "grid:1,1,1", "--out", "no/such/folder/l.vtp"}).exit_code,
      1);
  EXPECT_EQ(run({"render", "--example", "abc", "--out", "no/such/folder/p.png"}).exit_code, 1);
}

TEST_F(Flow, GivesTheSameBytesForAnyNumberOfThreads) {
  for (const char* threads : {"1", "2", "7"}) {
    ASSERT_EQ(run({"trace", "--example", "tornado", "--seeds", "random:60", "--seed", "5", "--direction",
                   "both", "--threads", threads, "--out", std::string("t") + threads + ".vtp"})
                  .exit_code,
              0);
  }
  EXPECT_EQ(read_file(folder_.path("t1.vtp")), read_file(folder_.path("t2.vtp")));
  EXPECT_EQ(read_file(folder_.path("t1.vtp")), read_file(folder_.path("t7.vtp")));
  ASSERT_EQ(run({"trace", "--example", "tornado", "--seeds", "random:60", "--seed", "6", "--direction",
                 "both", "--out", "s.vtp"})
                .exit_code,
            0);
  EXPECT_NE(read_file(folder_.path("t1.vtp")), read_file(folder_.path("s.vtp")));
}

TEST_F(Flow, KeepsQuietWhenAsked) {
  const ProgramResult result =
      run({"trace", "--example", "abc", "--seeds", "grid:2,2,2", "--quiet", "--out", "l.vtp"});
  EXPECT_EQ(result.err, "");
}

// What was done is what was measured; what was not is named as left out.
TEST_F(Flow, ExplainsWhatItDidAndLeftOut) {
  const auto explained = [this](std::vector<std::string> command) {
    command.push_back("--explain");
    std::map<std::string, Json> entries;
    const Json result = json(command);
    for (const Json& entry : result["explain"]) entries[entry["what"].get<std::string>()] = entry;
    return entries;
  };
  const auto done = [](const std::map<std::string, Json>& entries, const std::string& what) {
    return entries.contains(what) && entries.at(what)["times"].get<int>() > 0;
  };
  const std::filesystem::path grid = folder_.write(
      "a.vtk",
      "# vtk DataFile Version 3.0\n\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 2 2\nORIGIN 0 0 0\n"
      "SPACING 1 1 1\nPOINT_DATA 8\nVECTORS v double\n1 0 0 1 0 0 1 0 0 1 0 0 1 0 0 1 0 0 1 0 0 1 0 0\n"
      "SCALARS p double\nLOOKUP_TABLE default\n1 2 3 4 5 6 7 8\n");
  auto of = explained({"info", "--example", "abc"});
  EXPECT_FALSE(done(of, "traced lines"));
  EXPECT_EQ(of.at("traced lines")["why"], "none was traced");
  EXPECT_TRUE(done(of, "vector field"));

  of = explained({"trace", grid.string(), "--seeds", "grid:2,2,2", "--out", "l.vtp"});
  EXPECT_TRUE(done(of, "helper palpate-load-vtk"));
  EXPECT_FALSE(done(of, "helper palpate-load-nrrd"));
  EXPECT_TRUE(done(of, "array v"));
  EXPECT_EQ(of.at("array v")["bytes"], 8 * 3 * 8);
  EXPECT_FALSE(done(of, "array p"));
  EXPECT_EQ(of.at("array p")["why"], "nothing asked for it");
  EXPECT_TRUE(done(of, "traced lines"));
  EXPECT_TRUE(done(of, "file l.vtp"));
  EXPECT_EQ(of.at("file l.vtp")["bytes"], std::filesystem::file_size(folder_.path("l.vtp")));
  for (const char* what : {"OpenGL off screen", "window", "measures of the velocity gradient",
                           "drivers of devices", "tetrahedra"})
    EXPECT_FALSE(done(of, what)) << what;

  of = explained({"render", grid.string(), "--color", "vorticity", "--size", "64x48", "--out", "v.png"});
  for (const char* what :
       {"OpenGL off screen", "drawing", "measures of the velocity gradient", "traced lines", "file v.png"})
    EXPECT_TRUE(done(of, what)) << what;
  EXPECT_FALSE(done(of, "window"));
  // For people it comes last.
  const ProgramResult text =
      run({"trace", "--example", "abc", "--seeds", "grid:1,1,1", "--out", "e.csv", "--explain"});
  const auto summary = text.out.find("e.csv"), entries = text.out.find("\ndone (measured");
  EXPECT_LT(summary, entries) << text.out;
  EXPECT_LT(entries, text.out.find("\nleft out:\n")) << text.out;
}

TEST_F(Flow, ReportsErrorAgainstTime) {
  const Json summary = json({"report", "--example", "saddle", "--quick", "--seeds", "grid:2,2,2",
                             "--max-length", "1", "--out", "r"});
  EXPECT_EQ(summary["stability_cases_failed"], 0);
  const Json report = parse_json(read_file(folder_.path("r/report.json")));
  EXPECT_TRUE(report.contains("machine"));
  EXPECT_GT(report["work_precision"].size(), 20U);
  for (const char* key : {"subject", "method", "parameter", "error", "error_kind", "seconds"}) {
    EXPECT_TRUE(report["work_precision"][0].contains(key)) << key;
  }
  // The hand's part: every budget on every kind of path, and the distance from lines traced independently.
  std::size_t constraint_rows = 0;
  for (const Json& row : report["work_precision"]) {
    const auto subject = row["subject"].get<std::string>();
    constraint_rows += subject.starts_with("streamline constraint, ") ? 1 : 0;
    if (row["error_kind"] != "distance from the line, worst step / diagonal") continue;
    EXPECT_EQ(row["method"], "streamline");
    EXPECT_LE(row["error"].get<double>(), 1e-6) << subject << ", " << row["parameter"];
  }
  EXPECT_GE(constraint_rows, 100U);
  for (const Json& row : report["stability"]) EXPECT_TRUE(row["holds"].get<bool>()) << row["case"];
  EXPECT_NE(read_file(folder_.path("r/resampling.csv")).find("\"speed\",64,"), std::string::npos);
  EXPECT_EQ(run({"report", "--example", "saddle", "--quick", "--out", "r"}).exit_code, 2);
}

TEST_F(Flow, StopsWithinASecondOfCtrlC) {
  // Lines without end at a tolerance without mercy: minutes of work.
  Program program({bin("flow").string(), "trace", "--example", "abc", "--seeds", "random:20000",
                   "--integrator", "bs32", "--tolerance", "1e-11", "--max-length", "1e6", "--out", "l.vtp"},
                  folder_.path());
  std::this_thread::sleep_for(std::chrono::milliseconds(700));
  const double before = program.seconds();
  program.signal(SIGINT);
  const ProgramResult result = program.finish(30.0);
  EXPECT_EQ(result.exit_code, 130) << result.err;
  EXPECT_LT(result.seconds - before, 1.5);  // a second, and slack for a busy machine
  EXPECT_NE(result.err.find("nothing was saved"), std::string::npos) << result.err;
  EXPECT_TRUE(files().empty());
}

// The work is another program's, which is ended with this one's verb.
TEST_F(Flow, StopsAReportWithinASecondOfCtrlCAndLeavesNothing) {
  ASSERT_EQ(run({"report", "--example", "saddle", "--quick", "--seeds", "grid:2,2,2", "--max-length", "1",
                 "--out", "r"})
                .exit_code,
            0);
  const std::string page = read_file(folder_.path("r/index.html"));
  Program program({bin("flow").string(), "report", "--example", "abc", "--thorough", "--out", "r", "--force"},
                  folder_.path());
  std::this_thread::sleep_for(std::chrono::milliseconds(1500));
  const double before = program.seconds();
  program.signal(SIGINT);
  const ProgramResult result = program.finish(30.0);
  EXPECT_EQ(result.exit_code, 130) << result.err;
  EXPECT_LT(result.seconds - before, 1.5);  // a second, and slack for a busy machine
  EXPECT_NE(result.err.find("nothing was saved"), std::string::npos) << result.err;
  EXPECT_EQ(files(), std::vector<std::string>{"r"});
  EXPECT_EQ(read_file(folder_.path("r/index.html")), page);
}

TEST_F(Flow, SaysThatTheProgramOfStudiesIsMissing) {
  const ProgramResult result = Program({bin("flow").string(), "report", "--example", "saddle", "--out", "r"},
                                       folder_.path(), {"PALPATE_HELPERS=" + folder_.path().string()})
                                   .finish();
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find("palpate-lab"), std::string::npos) << result.err;
}

TEST_F(Flow, GivesLinesWhoseEndsAddUpOnRealData) {
  struct Case {
    const char* file;
    const char* solution;
    const char* integrator;
  };
  int found = 0;
  for (const Case& c : {Case{"flow/carotid/carotid.vtk", nullptr, "dp54"},
                        Case{"flow/bluntfin/bluntfinxyz.bin", "flow/bluntfin/bluntfinq.bin", "exact"},
                        Case{"flow/disk/disk_out_ref.ex2", nullptr, "exact"}}) {
    const auto file = shared_data(c.file);
    if (file.empty()) continue;
    ++found;
    std::vector<std::string> arguments{
        "trace",       file.string(), "--seeds", "grid:5,5,5",
        "--direction", "both",        "--out",   std::to_string(found) + ".vtp"};
    if (c.solution) arguments.insert(arguments.end(), {"--solution", shared_data(c.solution).string()});
    const Json object = json(arguments);
    EXPECT_EQ(object["integrator"], c.integrator) << c.file;
    const auto outside = object["seeds_outside"].get<std::size_t>();
    EXPECT_EQ(object["lines"].get<std::size_t>(), 2 * (125 - outside)) << c.file;
    EXPECT_EQ(sum_of(object["ends"]), object["lines"].get<std::size_t>()) << c.file;
    EXPECT_EQ(object["ends"]["max_steps"], 0) << c.file;
    EXPECT_EQ(object["ends"]["bad_data"], 0) << c.file;
  }
  if (found == 0) GTEST_SKIP() << "sample data missing: flow/";
}

TEST_F(Flow, NamesTheFieldsForAnUnknownOne) {
  PALPATE_NEED_DATA(file, "flow/bluntfin/bluntfinxyz.bin");
  const std::string solution = shared_data("flow/bluntfin/bluntfinq.bin").string();
  const ProgramResult result = run({"trace", file.string(), "--solution", solution, "--field", "wind",
                                    "--seeds", "grid:1,1,1", "--out", "l.vtp"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("Momentum"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace palpate::test
