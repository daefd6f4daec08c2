/// A section of workbench.toml while it is read: its keys checked, every refusal with file and line.
///
/// For the sources that read the file; no one else sees toml++.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <string>
#include <vector>

#include <toml++/toml.h>

#include "common/kinematics/workbench_devices.h"
#include "common/math/quaternion.h"

namespace palpate {

[[nodiscard]] std::string line_of(const toml::node& node);  ///< "line 12"

/// @throws Error (bad input), always.
[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& place,
                         const std::string& found, const std::string& expected);

/// What the file holds. @throws Error (bad input) where it cannot be read.
[[nodiscard]] std::string workbench_text(const std::filesystem::path& path);
/// @param path for the message. @throws Error (bad input) where the text is not TOML.
[[nodiscard]] toml::table parsed_workbench(const std::string& text, const std::filesystem::path& path);

class WorkbenchSection {
 public:
  /// @param table and `path` outlive this. @param known keys; none given: any key may stand in it.
  /// @throws Error (bad input) for a key that is not known.
  WorkbenchSection(const toml::table& table, std::string name, const std::filesystem::path& path,
                   std::initializer_list<const char*> known = {});

  [[nodiscard]] bool has(const char* key) const { return table_.contains(key); }

  /// @name Values. @throws Error (bad input) where the key is missing or its value of another kind.
  /// @{
  [[nodiscard]] const toml::node& at(const char* key) const;
  [[nodiscard]] std::vector<double> numbers(const toml::node& node, std::size_t count,
                                            bool may_be_nan = false) const;
  [[nodiscard]] Vec3 vector(const toml::node& node, bool may_be_nan = false) const;
  [[nodiscard]] Vec3 vector(const char* key) const { return vector(at(key)); }
  [[nodiscard]] double number(const char* key) const;
  /// Empty where it is no text.
  [[nodiscard]] std::string word(const char* key) const {
    return at(key).value_exact<std::string>().value_or("");
  }
  [[nodiscard]] const toml::array& array(const char* key) const;
  [[nodiscard]] std::vector<Vec3> vectors(const char* key, std::size_t count) const;
  [[nodiscard]] std::vector<Vec3> all_vectors(const char* key, bool may_be_nan = false) const;
  [[nodiscard]] Quat rotation(const char* key = "rotation") const;
  [[nodiscard]] Rigid motion() const { return {rotation(), vector("translation")}; }
  /// @}
  [[noreturn]] void refuse_at(const char* key, const std::string& found, const std::string& expected) const;

 private:
  const toml::table& table_;
  std::string name_;
  const std::filesystem::path& path_;
};

/// @name [device.NAME] and [tuned.NAME]. @throws Error (bad input).
/// @{
[[nodiscard]] std::vector<DeviceOptions> device_options_of(const toml::table& root,
                                                           const std::filesystem::path& path);
[[nodiscard]] std::vector<TunedDevice> tuned_of(const toml::table& root, const std::filesystem::path& path);
/// @}

}  // namespace palpate
