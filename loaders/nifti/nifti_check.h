/// A cheap look at a NIfTI header before niftilib sees it: what the header claims must fit into the data that
/// is there, since a reader allocates what the header claims.
///
/// Format: nifti1.h (348 bytes) and nifti2.h (540 bytes), nifti.nimh.nih.gov.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "common/load/image/nifti_form.h"

namespace palpate {

/// Bytes at the start of a NIfTI file that hold any version's header.
inline constexpr std::size_t kNiftiHeaderBytes = 540;

/// The fields that say how many bytes there are and where.
struct NiftiClaims {
  int version = 1;
  bool pair = false;                   ///< the voxels lie in a file of their own (.img)
  std::array<std::int64_t, 8> size{};  ///< voxels along axis 1 to 7; [0]: how many axes
  int datatype = 0;                    ///< DT_ code of nifti1.h
  std::uint64_t bytes_per_voxel = 0;
  bool bits = false;                ///< DT_BINARY: eight voxels a byte, and bytes_per_voxel is 1
  std::uint64_t offset = 0;         ///< of the first voxel in its file
  std::uint64_t stated_offset = 0;  ///< the same as it stands in the header
  double intercept = 0.0;           ///< as it stands in the header, finite or not
  double time_step = 0.0;           ///< likewise, which niftilib takes for 1 where it is none
  NiftiQform qform;
  bool packed = false;  ///< the header's file is a gzip file; set by check_nifti()
  std::string problem;  ///< what is wrong, or empty
};

/// Bytes of all voxels; nothing where they are beyond any file.
[[nodiscard]] std::optional<std::uint64_t> nifti_voxel_bytes(const NiftiClaims& claims);

/// Reads the claims from the first bytes of a NIfTI file, unpacked.
[[nodiscard]] NiftiClaims read_nifti_claims(std::string_view head);

/// Why a file of `available` bytes, packed by gzip or not, cannot hold what `claims` says, or empty.
[[nodiscard]] std::string nifti_size_problem(const NiftiClaims& claims, std::uint64_t available, bool gzip);

/// Checks the header of `file`, and the size of the voxels where they lie in the same file.
/// @throws Error (bad input).
NiftiClaims check_nifti(const std::string& file);

/// The same for the voxels' own file, of a pair. @throws Error (bad input).
void check_nifti_voxels(const std::string& file, const NiftiClaims& claims);

}  // namespace palpate
