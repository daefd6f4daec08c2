/// A library that is opened at run time, when something of it is called for: what does not ask for it maps none of it.
#pragma once

#include <span>
#include <string>

namespace palpate {

class SharedLibrary {
 public:
  /// Opens `asked`, or the first of `names` that there is where that is empty. It is never closed: what it
  /// has started may still run.
  /// @param remedy what to install, for the line that says that there is none.
  /// @throws Error (work failed).
  SharedLibrary(const std::string& asked, std::span<const char* const> names, const std::string& remedy);

  [[nodiscard]] const std::string& file() const noexcept { return file_; }

  /// @throws Error (work failed) where the library has no such function.
  template <class Function>
  void require(Function*& function, const char* name) const {
    // A pointer to a function and one to an object are the same here: POSIX, dlsym.
    function = reinterpret_cast<Function*>(find(name));
    if (function == nullptr) refuse(name);
  }
  /// Null where it has none.
  template <class Function>
  void want(Function*& function, const char* name) const {
    function = reinterpret_cast<Function*>(find(name));
  }

 private:
  [[nodiscard]] void* find(const char* name) const;
  [[noreturn]] void refuse(const char* name) const;

  std::string file_;
  std::string remedy_;
  void* library_ = nullptr;
};

}  // namespace palpate
