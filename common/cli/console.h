/// What a verb says: results on stdout, remarks on stderr.
#pragma once

#include <string>
#include <utility>

namespace palpate {

class Console {
 public:
  /// @param settings JSON object of the settings that JSON results repeat as "settings"; empty: none.
  /// @param explain whether results end with what was done (base/ledger.h), JSON results as "explain".
  Console(std::string program, bool json, bool quiet, std::string settings = {}, bool explain = false)
      : program_(std::move(program)),
        settings_(std::move(settings)),
        json_(json),
        quiet_(quiet),
        explain_(explain) {}

  [[nodiscard]] bool json() const noexcept { return json_; }
  [[nodiscard]] bool quiet() const noexcept { return quiet_; }

  /// A remark on stderr, "flow: …"; nothing with --quiet.
  void note(const std::string& line) const;
  /// Result for people on stdout; nothing with --json.
  void print(const std::string& text);
  /// The one JSON object on stdout; nothing without --json.
  void print_json(const std::string& object);
  /// An error on stderr, and as {"error", "exit"} on stdout with --json if no object was printed yet.
  void fail(const std::string& line, int exit_code);
  /// Ends what was printed for people. @throws Error (work failed) where stdout did not take everything.
  void finish();

 private:
  std::string program_;
  std::string settings_;
  bool json_ = false;
  bool quiet_ = false;
  bool explain_ = false;
  bool json_printed_ = false;
};

}  // namespace palpate
