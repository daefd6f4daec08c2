/// A fixture that runs a built explorer as a user does, in a folder of its own.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/json.h"
#include "common/base/progress.h"
#include "common/cli/console.h"
#include "common/cli/explorer.h"
#include "common/cli/interrupt.h"
#include "tests/e2e/program.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {

class ExplorerTest : public ::testing::Test {
 protected:
  explicit ExplorerTest(std::string explorer);

  ProgramResult run(const std::vector<std::string>& arguments);

  /// The one JSON object on stdout; anything else there fails to parse.
  Json json(std::vector<std::string> arguments, int exit_code = 0);

  /// Names of what lies in the folder, sorted.
  std::vector<std::string> files() const;

  /// Whether something with this ending is kept for the next opening.
  bool is_kept(const std::string& ending) const;

  TempFolder folder_, cache_;

 private:
  std::string explorer_;
};

/// What a verb works with, for a window in the test's own process; nothing of it is printed.
struct QuietVerb {
  explicit QuietVerb(const Explorer& explorer)
      : interrupt(progress, explorer.name),
        console(explorer.name, false, true),
        context{explorer, progress, interrupt, console, explorer.name} {}
  Progress progress;
  InterruptGuard interrupt;
  Console console;
  VerbContext context;
};

}  // namespace palpate::test
