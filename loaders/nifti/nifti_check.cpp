#include "loaders/nifti/nifti_check.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/load/find_format.h"
#include "common/load/gzip_head.h"

namespace palpate {
namespace {

constexpr std::uint64_t kMaxBytes = std::uint64_t{1} << 50;
/// Packed, a header fits into far fewer bytes; a name or comment in gzip's own header may be long.
constexpr std::size_t kPackedHeaderBytes = std::size_t{64} << 10;

/// Numbers of a header at fixed places, in either byte order.
class HeaderBytes {
 public:
  HeaderBytes(std::string_view bytes, bool swapped) : bytes_(bytes), swapped_(swapped) {}

  template <typename T>
  [[nodiscard]] T at(std::size_t offset) const {
    std::array<char, sizeof(T)> raw{};
    std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(offset), sizeof(T), raw.begin());
    if (swapped_) std::reverse(raw.begin(), raw.end());
    T value{};
    std::memcpy(&value, raw.data(), sizeof(T));
    return value;
  }

 private:
  std::string_view bytes_;
  bool swapped_;
};

/// Bytes of a voxel of a NIfTI type, or 0 for a type without one or unknown.
std::uint64_t bytes_of_type(int datatype) {
  constexpr std::array<std::pair<int, std::uint64_t>, 15> kTypes{{{2, 1},
                                                                  {4, 2},
                                                                  {8, 4},
                                                                  {16, 4},
                                                                  {32, 8},
                                                                  {64, 8},
                                                                  {128, 3},
                                                                  {256, 1},
                                                                  {512, 2},
                                                                  {768, 4},
                                                                  {1024, 8},
                                                                  {1280, 8},
                                                                  {1536, 16},
                                                                  {1792, 16},
                                                                  {2304, 4}}};
  const auto* const found =
      std::find_if(kTypes.begin(), kTypes.end(), [&](const auto& type) { return type.first == datatype; });
  return found == kTypes.end() ? 0 : found->second;
}

/// The fields of a qform, numbers of type T from three places on.
template <typename T>
NiftiQform qform_at(const HeaderBytes& bytes, std::size_t quaternion, std::size_t steps) {
  NiftiQform qform;
  const auto take = [&bytes](auto& to, std::size_t from) {
    for (std::size_t i = 0; i < to.size(); ++i)
      to[i] = static_cast<double>(bytes.at<T>(from + i * sizeof(T)));
  };
  take(qform.quaternion, quaternion);
  take(qform.offset, quaternion + 3 * sizeof(T));
  take(qform.steps, steps);
  return qform;
}

constexpr std::int32_t kBytes1 = 348;
constexpr std::int32_t kBytes2 = 540;

NiftiClaims failed(std::string problem) {
  NiftiClaims claims;
  claims.problem = std::move(problem);
  return claims;
}

}  // namespace

NiftiClaims read_nifti_claims(std::string_view head) {
  if (head.size() < as_size(kBytes1)) return failed("ends within its header");
  const auto declared = HeaderBytes(head, false).at<std::int32_t>(0);
  const auto turned = HeaderBytes(head, true).at<std::int32_t>(0);
  const bool swapped = declared != kBytes1 && declared != kBytes2;
  if (swapped && turned != kBytes1 && turned != kBytes2) return failed("has no header of 348 or 540 bytes");
  const HeaderBytes bytes(head, swapped);

  NiftiClaims claims;
  double offset = 0.0;
  if ((swapped ? turned : declared) == kBytes1) {
    const std::string_view magic = head.substr(344, 4);
    if (magic != std::string_view("n+1\0", 4) && magic != std::string_view("ni1\0", 4))
      return failed("is an Analyze header, which does not say how its axes lie");
    claims.pair = magic[1] == 'i';
    for (std::size_t i = 0; i < 8; ++i) claims.size[i] = bytes.at<std::int16_t>(40 + 2 * i);
    claims.datatype = bytes.at<std::int16_t>(70);
    offset = static_cast<double>(bytes.at<float>(108));
    claims.intercept = static_cast<double>(bytes.at<float>(116));
    claims.qform = qform_at<float>(bytes, 256, 76);
    claims.time_step = static_cast<double>(bytes.at<float>(92));
  } else {
    if (head.size() < as_size(kBytes2)) return failed("ends within its header");
    const std::string_view magic = head.substr(4, 4);
    if (magic != std::string_view("n+2\0", 4) && magic != std::string_view("ni2\0", 4))
      return failed("has a header of 540 bytes without NIfTI's mark");
    claims.version = 2;
    claims.pair = magic[1] == 'i';
    for (std::size_t i = 0; i < 8; ++i) claims.size[i] = bytes.at<std::int64_t>(16 + 8 * i);
    claims.datatype = bytes.at<std::int16_t>(12);
    offset = static_cast<double>(bytes.at<std::int64_t>(168));
    claims.intercept = bytes.at<double>(184);
    claims.qform = qform_at<double>(bytes, 352, 104);
    claims.time_step = bytes.at<double>(136);
  }
  constexpr int kBinary = 1;
  claims.bits = claims.datatype == kBinary;
  claims.bytes_per_voxel = claims.bits ? 1 : bytes_of_type(claims.datatype);
  if (claims.bytes_per_voxel == 0)
    return failed("has values of the unknown type " + std::to_string(claims.datatype));
  if (claims.size[0] < 1 || claims.size[0] > 7)
    return failed("claims " + std::to_string(claims.size[0]) + " axes");
  for (std::size_t i = 1; i < 8; ++i) {
    if (static_cast<std::int64_t>(i) > claims.size[0]) claims.size[i] = 1;
    if (claims.size[i] < 1)
      return failed("claims " + std::to_string(claims.size[i]) + " voxels along axis " + std::to_string(i));
  }
  // The comparison is false for NaN.
  if (!(offset >= 0.0 && offset < static_cast<double>(kMaxBytes)))
    return failed("says that its voxels begin outside the file");
  // In one file four bytes that say whether extensions follow stand behind the header.
  const double header = claims.version == 1 ? kBytes1 : kBytes2;
  claims.stated_offset = static_cast<std::uint64_t>(offset);
  claims.offset = claims.stated_offset;
  if (!claims.pair && offset < header) claims.offset = static_cast<std::uint64_t>(header + 4.0);
  return claims;
}

std::optional<std::uint64_t> nifti_voxel_bytes(const NiftiClaims& claims) {
  std::uint64_t bytes = claims.bytes_per_voxel;
  for (std::size_t i = 1; i < 8; ++i) {
    if (__builtin_mul_overflow(bytes, static_cast<std::uint64_t>(claims.size[i]), &bytes))
      return std::nullopt;
  }
  if (claims.bits) bytes = bytes / 8 + (bytes % 8 != 0 ? 1 : 0);
  return bytes <= kMaxBytes ? std::optional(bytes) : std::nullopt;
}

std::string nifti_size_problem(const NiftiClaims& claims, std::uint64_t available, bool gzip) {
  const std::optional<std::uint64_t> bytes = nifti_voxel_bytes(claims);
  const std::uint64_t possible = gzip ? std::min(available, kMaxBytes) * kGzipRatio : available;
  if (bytes && claims.offset + *bytes <= possible) return "";
  return "claims " + (bytes ? std::to_string(*bytes) : std::string("over 2^50")) +
         " bytes of voxels from byte " + std::to_string(claims.offset) + " on, but there are " +
         std::to_string(available) + (gzip ? " packed bytes" : " bytes");
}

NiftiClaims check_nifti(const std::string& file) {
  HeadOfFile head = read_head(file, kPackedHeaderBytes);
  const bool gzip = is_gzip(head.bytes);
  if (gzip) head.bytes = gzip_head(head.bytes, kNiftiHeaderBytes);
  NiftiClaims claims = read_nifti_claims(head.bytes);
  claims.packed = gzip;
  if (!claims.problem.empty()) {
    throw input_error({file, "header", claims.problem, "NIfTI-1 or NIfTI-2", "the file may be damaged"});
  }
  const std::string problem = claims.pair ? "" : nifti_size_problem(claims, head.file_size, gzip);
  if (!problem.empty()) throw input_error({file, "", problem, "", "the file may be truncated"});
  return claims;
}

void check_nifti_voxels(const std::string& file, const NiftiClaims& claims) {
  const HeadOfFile head = read_head(file, 2);
  const std::string problem = nifti_size_problem(claims, head.file_size, is_gzip(head.bytes));
  if (!problem.empty()) throw input_error({file, "", problem, "", "the file may be truncated"});
}

}  // namespace palpate
