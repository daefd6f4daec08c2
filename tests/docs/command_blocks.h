/// Commands that a Markdown page prints in fenced blocks of the shell.
///
///   ```sh           runs anywhere
///   ```sh data      needs the sample data
///   ```sh window    opens a window
///   ```sh device    needs a device, or a build of its own
///
/// Only the first word after the fence is seen by readers of the page.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace palpate::test {

/// A command as it is given to the shell: continued lines joined, comments and blank lines left out.
struct PrintedCommand {
  int line = 0;       ///< of the page, where it begins, from 1
  std::string needs;  ///< "", "data", "window" or "device"
  std::string text;
};

/// All commands of a page, in order. @throws std::runtime_error, naming the line, for a block that does not end,
/// needs something else, or is indented by four blanks instead of fenced.
[[nodiscard]] std::vector<PrintedCommand> printed_commands(std::string_view page);

}  // namespace palpate::test
