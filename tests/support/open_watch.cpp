// Preloaded into a program: writes the name of each file that it opens, at its end of each that is mapped into it, and the label
// of each texture that it allocates through libepoxy, to $PALPATE_OPEN_WATCH.<process>.

#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <dlfcn.h>
#include <fcntl.h>
#include <unistd.h>

namespace {

template <class Function>
Function* next_of(const char* name) noexcept {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

void write_line(int fd, const char* what, const char* path) noexcept {
  char line[4200];
  const int size = std::snprintf(line, sizeof line, "%s %s\n", what, path);
  if (size > 0 && static_cast<std::size_t>(size) < sizeof line) {
    [[maybe_unused]] const auto written = write(fd, line, static_cast<std::size_t>(size));
  }
}

/// A file of this process, opened past the functions below. Its first line says which program it is.
int log_file() noexcept {
  static const int fd = [] {
    const char* stem = std::getenv("PALPATE_OPEN_WATCH");
    if (stem == nullptr) return -1;
    char name[4096];
    std::snprintf(name, sizeof name, "%s.%d", stem, static_cast<int>(getpid()));
    const int made =
        next_of<int(const char*, int, ...)>("open")(name, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
    char self[4096] = {};
    if (readlink("/proc/self/exe", self, sizeof self - 1) > 0) write_line(made, "self", self);
    return made;
  }();
  return fd;
}

/// At once: a helper makes no file once it is in its sandbox.
__attribute__((constructor)) void begin() noexcept { (void)log_file(); }

void note(const char* what, const char* path) noexcept {
  if (path != nullptr) write_line(log_file(), what, path);
}

mode_t mode_of(int flags, va_list arguments) noexcept {
  return (flags & (O_CREAT | O_TMPFILE)) != 0 ? static_cast<mode_t>(va_arg(arguments, unsigned)) : 0;
}

/// Loading a library maps it.
__attribute__((destructor)) void note_maps() noexcept {
  static auto* const next = next_of<FILE*(const char*, const char*)>("fopen");
  FILE* maps = next("/proc/self/maps", "r");
  if (maps == nullptr) return;
  char line[4200];
  while (std::fgets(line, sizeof line, maps) != nullptr) {
    line[std::strcspn(line, "\n")] = 0;
    note("maps", std::strchr(line, '/'));
  }
  std::fclose(maps);
}

constexpr unsigned kTexture = 0x1702;  // GL_TEXTURE
constexpr unsigned kMostTextures = 4096;
char texture_labels[kMostTextures][64];

void keep_label(unsigned kind, unsigned name, int size, const char* text) noexcept {
  if (kind == kTexture && name < kMostTextures)
    std::snprintf(texture_labels[name], sizeof texture_labels[name], "%.*s", size, text);
}

void note_texture(unsigned name) noexcept {
  note("texture",
       name < kMostTextures && texture_labels[name][0] != 0 ? texture_labels[name] : "without label");
}

// libepoxy calls OpenGL by pointers that it shows, and looks up each when it is first called: it writes the pointer then.
#define PALPATE_WATCH_GL(name, what_is_noted, parameters, arguments)                           \
  void(**name##_place) parameters = nullptr;                                                   \
  void(*name##_next) parameters = nullptr;                                                     \
  void name##_watched parameters {                                                             \
    what_is_noted;                                                                             \
    *name##_place = name##_next;                                                               \
    name##_next arguments;                                                                     \
    name##_next = *name##_place;                                                               \
    *name##_place = name##_watched;                                                            \
  }                                                                                            \
  __attribute__((constructor)) void watch_##name() noexcept {                                  \
    name##_place = reinterpret_cast<void(**) parameters>(dlsym(RTLD_DEFAULT, "epoxy_" #name)); \
    if (name##_place == nullptr) return;                                                       \
    name##_next = *name##_place;                                                               \
    *name##_place = name##_watched;                                                            \
  }
PALPATE_WATCH_GL(glObjectLabel, keep_label(kind, name, size, text),
                 (unsigned kind, unsigned name, int size, const char* text), (kind, name, size, text))
PALPATE_WATCH_GL(glTextureStorage2D, note_texture(name),
                 (unsigned name, int levels, unsigned format, int width, int height),
                 (name, levels, format, width, height))
PALPATE_WATCH_GL(glTextureStorage3D, note_texture(name),
                 (unsigned name, int levels, unsigned format, int width, int height, int depth),
                 (name, levels, format, width, height, depth))

}  // namespace

extern "C" {

#define PALPATE_WATCH_OPEN(name)                                          \
  int name(const char* path, int flags, ...) {                            \
    static auto* const next = next_of<int(const char*, int, ...)>(#name); \
    va_list arguments;                                                    \
    va_start(arguments, flags);                                           \
    const mode_t mode = mode_of(flags, arguments);                        \
    va_end(arguments);                                                    \
    note("opens", path);                                                  \
    return next(path, flags, mode);                                       \
  }
PALPATE_WATCH_OPEN(open)
PALPATE_WATCH_OPEN(open64)

#define PALPATE_WATCH_OPENAT(name)                                             \
  int name(int folder, const char* path, int flags, ...) {                     \
    static auto* const next = next_of<int(int, const char*, int, ...)>(#name); \
    va_list arguments;                                                         \
    va_start(arguments, flags);                                                \
    const mode_t mode = mode_of(flags, arguments);                             \
    va_end(arguments);                                                         \
    note("opens", path);                                                       \
    return next(folder, path, flags, mode);                                    \
  }
PALPATE_WATCH_OPENAT(openat)
PALPATE_WATCH_OPENAT(openat64)

#define PALPATE_WATCH_FOPEN(name)                                              \
  FILE* name(const char* path, const char* mode) {                             \
    static auto* const next = next_of<FILE*(const char*, const char*)>(#name); \
    note("opens", path);                                                       \
    return next(path, mode);                                                   \
  }
PALPATE_WATCH_FOPEN(fopen)
PALPATE_WATCH_FOPEN(fopen64)

}  // extern "C"
