/// What a program prints about itself for other programs: a manual page, and completions for shells.
#pragma once

#include <string>
#include <string_view>

#include "common/cli/explorer.h"

namespace palpate {

/// The manual page, in the macros of man(7).
[[nodiscard]] std::string manual_page(const Explorer& explorer);

/// @name A script that completes command lines of the program, under its installed and its short name
/// Verbs; options of the verb that is typed, or of the default one; values that are words; files and folders.
/// @{
[[nodiscard]] std::string bash_completion(const Explorer& explorer);
[[nodiscard]] std::string zsh_completion(const Explorer& explorer);
[[nodiscard]] std::string fish_completion(const Explorer& explorer);
/// @}

/// @param shell "bash", "zsh" or "fish". @throws Error (usage) for another.
[[nodiscard]] std::string completion(const Explorer& explorer, std::string_view shell);

}  // namespace palpate
