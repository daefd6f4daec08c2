/// The face of a driver module without a bus that lists its devices: a service, a server, a maker's library.
#pragma once

#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "common/device/driver_link.h"

namespace palpate {

class PlainModule final : public DriverModule {
 public:
  /// Makes a link from options. @throws Error.
  using MakeLink = std::function<std::unique_ptr<DriverLink>(const DriverOptions&)>;
  using Find = std::function<std::vector<FoundDevice>()>;

  /// @param find null: what there is shows only when it is asked for by name.
  PlainModule(MakeLink make, std::string help, Find find = nullptr)
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

}  // namespace palpate
