#pragma once
/// \file
/// What counts say about shares of the box the starts were drawn from.

namespace percuss::attractor {

/// Share of a basin: count/starts with its two-sided 95 % bounds after Clopper and Pearson (Biometrika 26 (1934) 404).
struct Share {
    double value = 0.0;
    double lower = 0.0;
    double upper = 1.0;
};
/// Throws std::invalid_argument unless 0 <= count <= starts and starts >= 1.
Share share_of(long count, long starts);

/// One-sided 95 % upper bound on the share of a set that `count` of `starts` independent uniform starts fell into. For
/// count = 0 this is 1 - 0.05^(1/starts), just under 3/starts. Throws as above.
double share_bound(long count, long starts);

}  // namespace percuss::attractor
