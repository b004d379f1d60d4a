#include "numerics/global_sensitivity.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>

namespace percuss::numerics {
namespace {

constexpr double missing = std::numeric_limits<double>::quiet_NaN();
// Below this neither the degree nor the spread over runs can be judged.
constexpr std::int64_t fewest_rows = 32;
constexpr std::int64_t first_run = 8;
constexpr std::size_t most_runs = 128;
// A quadratic at least: an effect symmetric about the middle would be missed by a line.
constexpr int least_degree = 2;
// Rows for each coefficient; with fewer the adjustment for degrees of freedom outgrows the estimate.
constexpr std::int64_t rows_per_coefficient = 16;
// Relative size of a pivot below which a polynomial is a combination of lower ones on the values that occur.
constexpr double dependent = 1e-9;

/// Sums over rows. Outputs are taken relative to a fixed origin.
struct Sums {
    double rows = 0.0;
    double y = 0.0;
    double yy = 0.0;
    Vector moments;            ///< n (d + 1): sum of P_k(x_i) y, variable by variable
    std::vector<Matrix> gram;  ///< by variable: sum of P_k(x_i) P_l(x_i)
    Vector squares;            ///< sum of (dy/dx_i)^2
    Vector square_rows;        ///< how many rows had that derivative
    Matrix outer;              ///< sum of grad grad^T, absent derivatives taken as 0
    double gradient_rows = 0.0;

    Sums() = default;
    Sums(int n, int degree)
        : moments(Vector::Zero(n * (degree + 1))),
          gram(static_cast<std::size_t>(n), Matrix::Zero(degree + 1, degree + 1)),
          squares(Vector::Zero(n)),
          square_rows(Vector::Zero(n)),
          outer(Matrix::Zero(n, n)) {}

    void add(const Sums& other, double times = 1.0) {
        rows += times * other.rows;
        y += times * other.y;
        yy += times * other.yy;
        moments += times * other.moments;
        for (std::size_t i = 0; i < gram.size(); ++i) { gram[i] += times * other.gram[i]; }
        squares += times * other.squares;
        square_rows += times * other.square_rows;
        outer += times * other.outer;
        gradient_rows += times * other.gradient_rows;
    }

    [[nodiscard]] double variance() const { return (yy - y * y / rows) / (rows - 1.0); }
};

/// Legendre polynomials shifted to [0, 1] and scaled to mean square 1: sqrt(2 k + 1) P_k(2 x - 1).
void legendre(double x, Vector& values) {
    const double t = 2.0 * x - 1.0;
    double before = 0.0;
    double now = 1.0;
    for (Eigen::Index k = 0; k < values.size(); ++k) {
        values[k] = std::sqrt(2.0 * static_cast<double>(k) + 1.0) * now;
        const double next = ((2.0 * static_cast<double>(k) + 1.0) * t * now - static_cast<double>(k) * before) /
                            (static_cast<double>(k) + 1.0);
        before = now;
        now = next;
    }
}

/// Sums of squares of y explained by polynomials of degree 0, 1, ... in one variable: with the Gram matrix G = L L^T
/// and L z = b, degree k explains z_1^2 + ... + z_k^2. Ends where a polynomial depends on the lower ones, as it must
/// once its degree reaches the number of distinct values.
std::vector<double> explained_squares(const Matrix& gram, const Vector& moments) {
    const Eigen::Index size = gram.rows();
    Matrix L = Matrix::Zero(size, size);
    Vector z = Vector::Zero(size);
    std::vector<double> explained;
    double sum = 0.0;
    for (Eigen::Index k = 0; k < size; ++k) {
        for (Eigen::Index l = 0; l < k; ++l) {
            L(k, l) = (gram(k, l) - L.row(k).head(l).dot(L.row(l).head(l))) / L(l, l);
        }
        const double pivot = gram(k, k) - L.row(k).head(k).squaredNorm();
        if (!(pivot > dependent * gram(k, k))) { break; }
        L(k, k) = std::sqrt(pivot);
        z[k] = (moments[k] - L.row(k).head(k).dot(z.head(k))) / L(k, k);
        if (k > 0) { sum += z[k] * z[k]; }
        explained.push_back(sum);
    }
    return explained;
}

std::vector<double> explained_squares(const Sums& sums, std::size_t variable) {
    const Eigen::Index size = sums.gram[variable].rows();
    return explained_squares(sums.gram[variable],
                             sums.moments.segment(static_cast<Eigen::Index>(variable) * size, size));
}

/// The degree with the least generalised cross-validation score (Craven and Wahba 1979), RSS/(1 - (k + 1)/N)^2.
int preferred_degree(const Sums& sums, std::size_t variable) {
    const std::vector<double> explained = explained_squares(sums, variable);
    const double total = sums.yy - sums.y * sums.y / sums.rows;
    const auto cap = static_cast<std::int64_t>(sums.rows) / rows_per_coefficient;
    const int last = static_cast<int>(std::min<std::int64_t>(static_cast<std::int64_t>(explained.size()) - 1, cap));
    int best = std::min(least_degree, std::max(last, 0));
    double best_score = std::numeric_limits<double>::infinity();
    for (int k = best; k <= last; ++k) {
        const double free = 1.0 - (k + 1.0) / sums.rows;
        const double score = (total - explained[static_cast<std::size_t>(k)]) / (free * free);
        if (score < best_score) {
            best_score = score;
            best = k;
        }
    }
    return best;
}

/// 1 - (1 - R^2) (N - 1)/(N - k - 1): noise explains k/(N - 1) of the variance by chance. May come out below 0.
double adjusted_share(const Sums& sums, std::size_t variable, int degree) {
    const std::vector<double> explained = explained_squares(sums, variable);
    if (explained.empty()) { return missing; }
    const int k = std::min(degree, static_cast<int>(explained.size()) - 1);
    const double total = sums.yy - sums.y * sums.y / sums.rows;
    const double unexplained = 1.0 - explained[static_cast<std::size_t>(k)] / total;
    return 1.0 - unexplained * (sums.rows - 1.0) / (sums.rows - k - 1.0);
}

double bound_of(const Sums& sums, Eigen::Index i) {
    if (sums.square_rows[i] == 0.0) { return missing; }
    const double nu = sums.squares[i] / sums.square_rows[i];
    return nu / (std::numbers::pi * std::numbers::pi * sums.variance());
}

struct Interval {
    double lower = missing;
    double upper = missing;
};

/// Quantiles of the resampled values, moved so that their mean is the estimate: what duplicates in resamples add to
/// every value (they make chance look like effect) cancels.
Interval centred(std::vector<double> values, double estimate, double confidence) {
    values.erase(std::remove_if(values.begin(), values.end(), [](double v) { return !std::isfinite(v); }),
                 values.end());
    if (values.size() < 2 || !std::isfinite(estimate)) { return {}; }
    std::sort(values.begin(), values.end());
    double mean = 0.0;
    for (const double value : values) { mean += value / static_cast<double>(values.size()); }
    const auto quantile = [&](double share) {
        const double place = share * static_cast<double>(values.size() - 1);
        const auto below = std::min(static_cast<std::size_t>(place), values.size() - 2);
        return std::lerp(values[below], values[below + 1], place - static_cast<double>(below));
    };
    const double tail = 0.5 * (1.0 - confidence);
    return {estimate + quantile(tail) - mean, estimate + quantile(1.0 - tail) - mean};
}

}  // namespace

struct SensitivityTable::State {
    int dimensions = 0;
    SensitivityOptions options;
    std::int64_t run_length = first_run;
    std::vector<Sums> runs;   ///< by row / run_length; those without rows are empty
    double origin = missing;  ///< the first output
    std::vector<Vector> basis;

    Sums& run_of(std::int64_t row) {
        while (static_cast<std::size_t>(row / run_length) >= most_runs) { merge_neighbours(); }
        const auto place = static_cast<std::size_t>(row / run_length);
        if (runs.size() <= place) { runs.resize(place + 1); }
        if (runs[place].gram.empty()) { runs[place] = Sums(dimensions, options.most_degree); }
        return runs[place];
    }

    void merge_neighbours() {
        for (std::size_t i = 0; i < runs.size(); ++i) {
            if (i % 2 == 0) {
                if (i > 0) { runs[i / 2] = std::move(runs[i]); }
            } else if (runs[i / 2].gram.empty()) {
                runs[i / 2] = std::move(runs[i]);
            } else if (!runs[i].gram.empty()) {
                runs[i / 2].add(runs[i]);
            }
        }
        runs.resize((runs.size() + 1) / 2);
        run_length *= 2;
    }

    /// Runs drawn with replacement, as many as there are.
    [[nodiscard]] Sums resampled(const std::vector<const Sums*>& filled, std::mt19937_64& random) const {
        std::vector<int> times(filled.size(), 0);
        for (std::size_t i = 0; i < filled.size(); ++i) { ++times[random() % filled.size()]; }
        Sums sums(dimensions, options.most_degree);
        for (std::size_t i = 0; i < filled.size(); ++i) {
            if (times[i] > 0) { sums.add(*filled[i], times[i]); }
        }
        return sums;
    }
};

SensitivityTable::SensitivityTable(int dimensions, const SensitivityOptions& options)
    : state_(std::make_unique<State>()) {
    const auto check = [](const char* name, double value, double lowest, double largest) {
        if (value >= lowest && value <= largest) { return; }
        throw std::invalid_argument(std::string("sensitivity: ") + name + " = " + std::to_string(value) + ", must be " +
                                    std::to_string(lowest) + ".." + std::to_string(largest));
    };
    check("dimensions", dimensions, 1, 64);
    check("most_degree", options.most_degree, least_degree, 40);
    check("resamples", options.resamples, 2, 100000);
    check("confidence", options.confidence, 0.01, 0.999);
    state_->dimensions = dimensions;
    state_->options = options;
    state_->basis.assign(static_cast<std::size_t>(dimensions), Vector(options.most_degree + 1));
}

SensitivityTable::~SensitivityTable() = default;
SensitivityTable::SensitivityTable(SensitivityTable&&) noexcept = default;
SensitivityTable& SensitivityTable::operator=(SensitivityTable&&) noexcept = default;

void SensitivityTable::add(std::int64_t row, const Vector& inputs, double output, const Vector& gradient) {
    State& state = *state_;
    const Eigen::Index n = state.dimensions;
    if (row < 0 || inputs.size() != n || (gradient.size() != 0 && gradient.size() != n)) {
        throw std::invalid_argument("sensitivity: row " + std::to_string(row) + " needs " + std::to_string(n) +
                                    " inputs and as many derivatives or none");
    }
    if (!(inputs.array() >= 0.0 && inputs.array() <= 1.0).all()) {
        throw std::invalid_argument("sensitivity: row " + std::to_string(row) + " has an input outside 0..1");
    }
    if (!std::isfinite(output)) { return; }

    if (std::isnan(state.origin)) { state.origin = output; }
    const double y = output - state.origin;
    Sums& sums = state.run_of(row);
    sums.rows += 1.0;
    sums.y += y;
    sums.yy += y * y;
    for (Eigen::Index i = 0; i < n; ++i) {
        Vector& basis = state.basis[static_cast<std::size_t>(i)];
        legendre(inputs[i], basis);
        sums.moments.segment(i * basis.size(), basis.size()) += y * basis;
        sums.gram[static_cast<std::size_t>(i)].noalias() += basis * basis.transpose();
    }
    if (gradient.size() == 0) { return; }
    const Vector known = gradient.array().isFinite().select(gradient, 0.0);
    sums.squares += known.cwiseAbs2();
    sums.square_rows += gradient.array().isFinite().cast<double>().matrix();
    sums.outer.noalias() += known * known.transpose();
    sums.gradient_rows += gradient.array().isFinite().any() ? 1.0 : 0.0;
}

Sensitivity SensitivityTable::estimate() const {
    const State& state = *state_;
    const auto n = static_cast<std::size_t>(state.dimensions);
    Sums all(state.dimensions, state.options.most_degree);
    std::vector<const Sums*> filled;
    for (const Sums& run : state.runs) {
        if (run.gram.empty()) { continue; }
        all.add(run);
        filled.push_back(&run);
    }

    Sensitivity result;
    result.used = static_cast<std::int64_t>(all.rows);
    result.used_gradients = static_cast<std::int64_t>(all.gradient_rows);
    result.mean = all.rows > 0.0 ? state.origin + all.y / all.rows : missing;
    result.variance = all.rows > 1.0 ? all.variance() : missing;
    result.active_share = missing;
    result.variables.assign(n, {missing, missing, missing, 0, missing, missing, missing, missing});
    if (result.used < fewest_rows || filled.size() < 2) { return result; }
    // Less than rounding leaves of a constant.
    const double scale = std::abs(state.origin) + std::sqrt(all.yy / all.rows);
    if (!(std::sqrt(std::max(result.variance, 0.0)) > 1e-13 * scale)) {
        result.status = SensitivityStatus::constant;
        return result;
    }
    result.status = SensitivityStatus::estimated;

    std::vector<std::vector<double>> shares(n);
    std::vector<std::vector<double>> bounds(n);
    for (std::size_t i = 0; i < n; ++i) { result.variables[i].degree = preferred_degree(all, i); }
    std::mt19937_64 random(state.options.seed);
    for (int resample = 0; resample < state.options.resamples; ++resample) {
        const Sums sums = state.resampled(filled, random);
        for (std::size_t i = 0; i < n; ++i) {
            shares[i].push_back(adjusted_share(sums, i, result.variables[i].degree));
            bounds[i].push_back(bound_of(sums, static_cast<Eigen::Index>(i)));
        }
    }
    for (std::size_t i = 0; i < n; ++i) {
        const auto place = static_cast<Eigen::Index>(i);
        VariableSensitivity& variable = result.variables[i];
        const double share = adjusted_share(all, i, variable.degree);
        const Interval share_interval = centred(shares[i], share, state.options.confidence);
        variable.first_order = std::clamp(share, 0.0, 1.0);
        variable.first_order_lower = std::clamp(share_interval.lower, 0.0, 1.0);
        variable.first_order_upper = std::clamp(share_interval.upper, 0.0, 1.0);
        variable.dgsm = all.square_rows[place] > 0.0 ? all.squares[place] / all.square_rows[place] : missing;
        variable.dgsm_bound = bound_of(all, place);
        const Interval bound_interval = centred(bounds[i], variable.dgsm_bound, state.options.confidence);
        variable.dgsm_bound_lower = std::max(bound_interval.lower, 0.0);
        variable.dgsm_bound_upper = bound_interval.upper;
        if (std::isnan(bound_interval.lower)) { variable.dgsm_bound_lower = missing; }
    }

    const double trace = all.outer.trace();
    if (all.gradient_rows > 0.0 && trace > 0.0) {
        const Eigen::SelfAdjointEigenSolver<Matrix> eigen(all.outer);
        result.active_direction = eigen.eigenvectors().col(state.dimensions - 1);
        Eigen::Index largest = 0;
        result.active_direction.cwiseAbs().maxCoeff(&largest);
        if (result.active_direction[largest] < 0.0) { result.active_direction *= -1.0; }
        result.active_share = eigen.eigenvalues()[state.dimensions - 1] / trace;
    }
    return result;
}

}  // namespace percuss::numerics
