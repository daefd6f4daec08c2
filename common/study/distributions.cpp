#include "common/study/distributions.h"

#include <cmath>

#include <boost/math/distributions/non_central_t.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>

namespace palpate {

namespace bm = boost::math;

double normal_below(double z) noexcept { return 0.5 * std::erfc(-z * std::sqrt(0.5)); }

double normal_quantile(double share) { return bm::quantile(bm::normal(), share); }

double t_above(double t, double freedom) {
  if (std::isinf(t)) return 0.0;
  return 2.0 * bm::cdf(bm::complement(bm::students_t(freedom), std::abs(t)));
}

double t_quantile(double share, double freedom) { return bm::quantile(bm::students_t(freedom), share); }

double noncentral_t_above(double t, double freedom, double shift) {
  return bm::cdf(bm::complement(bm::non_central_t(freedom, shift), t));
}

}  // namespace palpate
