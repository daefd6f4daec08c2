/// What a helper program gives up before it reads its first byte of a file that nobody vouches for.
#pragma once

#include <filesystem>
#include <span>

namespace palpate {

/// What the kernel holds this process to.
struct Sandbox {
  bool files = false;    ///< Landlock: nothing on the disk is made, changed or removed
  bool network = false;  ///< seccomp: no socket is made, no program started, no other process touched
};

/// For the calling thread, which should be the only one, and what it starts: no way back. Reading, memory and the
/// descriptors that are open stay. A kernel that has no Landlock or no seccomp leaves that part out.
/// @param writable folders below which files may be made, changed and removed all the same.
Sandbox enter_sandbox(std::span<const std::filesystem::path> writable = {}) noexcept;

}  // namespace palpate
