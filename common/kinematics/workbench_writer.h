/// Sections of workbench.toml (workbench_file.h) as text, and their place in the file.
#pragma once

#include <filesystem>
#include <string>

#include "common/kinematics/workbench_file.h"

namespace palpate {

/// @name A section's text, with its header
/// @{
/// @pre the correction has no spline: a table holds what one says.
[[nodiscard]] std::string section_text(const TrackerCorrection& tracker);
[[nodiscard]] std::string section_text(const ApparatusGeometry& apparatus);
[[nodiscard]] std::string section_text(const DhhChain& arm);
[[nodiscard]] std::string section_text(const CoregistrationGeometry& coregistration);
[[nodiscard]] std::string stylus_section_text(const Vec3& tip);
[[nodiscard]] std::string section_text(const EyesGeometry& eyes);
/// @}

/// Whether `path` holds the section already; "tuned.falcon" is the table of a device. A file that does not
/// exist holds none.
/// @throws Error (bad input) where it is not TOML.
[[nodiscard]] bool has_section(const std::filesystem::path& path, const std::string& name);

/// Puts a section into the file, in the place of the one of that name or at the end; makes the file where
/// there is none. All other lines stay as they are, remarks included.
/// @throws Error (usage) where the section is there and `replace` is not set, or is written in a way that
/// cannot be replaced alone; (bad input) where the file is not TOML; (work failed).
void write_section(const std::filesystem::path& path, const std::string& name, const std::string& text,
                   bool replace);

}  // namespace palpate
