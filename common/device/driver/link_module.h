/// The face that all driver modules have: it makes links, and finds devices where it can list them.
#pragma once

#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "common/base/error.h"
#include "common/device/driver_link.h"

namespace palpate {

class LinkModule final : public DriverModule {
 public:
  /// Makes a link from options. @throws Error.
  using MakeLink = std::function<std::unique_ptr<DriverLink>(const DriverOptions&)>;
  using Find = std::function<std::vector<FoundDevice>()>;

  /// @param find null: what there is shows only when it is asked for by name.
  LinkModule(MakeLink make, std::string help, Find find = nullptr)
      : make_(std::move(make)), help_(std::move(help)), find_(std::move(find)) {}

  [[nodiscard]] std::string help() const override { return help_; }
  std::unique_ptr<DriverLink> make_link(const DriverOptions& options, std::string& error) noexcept override {
    try {
      return make_(options);
    } catch (const std::exception& problem) {  // nothing is thrown across the border
      error = problem.what();
      return nullptr;
    }
  }
  std::vector<FoundDevice> find(std::string& error) noexcept override {
    try {
      return find_ ? find_() : std::vector<FoundDevice>{};
    } catch (const std::exception& problem) {
      error = problem.what();
      return {};
    }
  }

 private:
  MakeLink make_;
  std::string help_;
  Find find_;
};

/// For families without options. @throws Error (usage) where there are some.
inline void expect_no_options(const std::string& driver, const DriverOptions& options) {
  if (!options.empty())
    throw usage_error("the driver " + driver + " has no options, found '" + options.front().first + "'");
}

}  // namespace palpate
