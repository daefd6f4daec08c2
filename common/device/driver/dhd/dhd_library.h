/// Force Dimension's DHD library as far as the link uses it: what its functions are called, take and return,
/// in our own words. Units m, N; -1 is an error, 0 and positive values are not.
#pragma once

#include <array>
#include <cstddef>
#include <string>

namespace palpate {

struct DhdFunctions {
  static constexpr std::size_t kStatusCount = 17;
  using Status = std::array<int, kStatusCount>;

  void (*version)(int* major, int* minor, int* release, int* revision) = nullptr;
  int (*device_count)() = nullptr;
  int (*open)() = nullptr;  ///< the first one; its number
  int (*open_serial)(int serial) = nullptr;
  int (*close)(char id) = nullptr;
  int (*system_type)(char id) = nullptr;
  const char* (*system_name)(char id) = nullptr;
  int (*status)(int* status, char id) = nullptr;  ///< of kStatusCount
  int (*position)(double* x, double* y, double* z, char id) = nullptr;
  unsigned (*buttons)(char id) = nullptr;
  int (*enable_force)(unsigned char on, char id) = nullptr;
  int (*set_force)(double x, double y, double z, char id) = nullptr;
  double (*max_force)(char id) = nullptr;
  const char* (*last_error)() = nullptr;
  // Not in every version: null where they are missing.
  int (*enable_expert)() = nullptr;
  int (*set_watchdog)(unsigned char eighths_of_ms, char id) = nullptr;  ///< 0: none
};

/// Opens the library by `file`, or by its usual names where that is empty, and finds its functions.
/// @throws Error (work failed) where there is none, one lacks a function, or is older than version 3.
[[nodiscard]] DhdFunctions open_dhd_library(const std::string& file);

/// What is known of a kind of device by its system type.
struct DhdModel {
  int type = 0;
  const char* name = "";
  double force = 0.0;  ///< [N] that open drivers use as its peak
  double reach = 0.0;  ///< [m] radius of its workspace
};
/// The Omega's numbers for a type that is not known.
[[nodiscard]] const DhdModel& dhd_model(int type) noexcept;

}  // namespace palpate
