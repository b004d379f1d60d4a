#include "attractor/shares.hpp"

#include <boost/math/distributions/binomial.hpp>

#include <cmath>
#include <stdexcept>
#include <string>

namespace percuss::attractor {
namespace {

/// Bounds hold with 95 %.
constexpr double risk = 0.05;

void check(long count, long starts) {
    if (!(starts >= 1 && count >= 0 && count <= starts)) {
        throw std::invalid_argument("share of " + std::to_string(count) + " of " + std::to_string(starts) +
                                    " starts: allowed is 0 to all of at least 1");
    }
}

/// Clopper and Pearson: the share of which as many starts as `count` or more come by chance with the probability of the
/// risk.
double lower_bound(long count, long starts, double one_sided_risk) {
    if (count == 0) { return 0.0; }
    return boost::math::binomial_distribution<>::find_lower_bound_on_p(static_cast<double>(starts),
                                                                       static_cast<double>(count), one_sided_risk);
}

/// The share of which as few as `count` or fewer do. For none that is (1 - p)^starts = risk, solved in closed form.
double upper_bound(long count, long starts, double one_sided_risk) {
    if (count == starts) { return 1.0; }
    if (count == 0) { return -std::expm1(std::log(one_sided_risk) / static_cast<double>(starts)); }
    return boost::math::binomial_distribution<>::find_upper_bound_on_p(static_cast<double>(starts),
                                                                       static_cast<double>(count), one_sided_risk);
}

}  // namespace

Share share_of(long count, long starts) {
    check(count, starts);
    return {static_cast<double>(count) / static_cast<double>(starts), lower_bound(count, starts, 0.5 * risk),
            upper_bound(count, starts, 0.5 * risk)};
}

double share_bound(long count, long starts) {
    check(count, starts);
    return upper_bound(count, starts, risk);
}

}  // namespace percuss::attractor
