#pragma once
/// \file
/// Which inputs matter to an output, from a table of points in the unit cube, with exact gradients where there are any.

#include "numerics/linear.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace percuss::numerics {

struct SensitivityOptions {
    int most_degree = 16;      ///< of the polynomial that stands for E[y | x_i]
    int resamples = 400;       ///< of the bootstrap
    double confidence = 0.95;  ///< of the intervals, two-sided
    std::uint64_t seed = 1;    ///< of the bootstrap
};

struct VariableSensitivity {
    /// Share of the variance of y that knowing x_i alone takes away, Var(E[y | x_i])/Var(y), and its interval.
    double first_order = 0.0;
    double first_order_lower = 0.0;
    double first_order_upper = 0.0;
    int degree = 0;  ///< of the polynomial used
    /// nu_i = E[(dy/dx_i)^2] and the bound nu_i/(pi^2 Var(y)) on the total index, with the interval of the bound; NaN
    /// where no row has this derivative.
    double dgsm = 0.0;
    double dgsm_bound = 0.0;
    double dgsm_bound_lower = 0.0;
    double dgsm_bound_upper = 0.0;
};

enum class SensitivityStatus : std::uint8_t {
    too_few_rows,  ///< fewer than 32: all figures below are NaN
    constant,      ///< y does not vary: likewise
    estimated,
};

struct Sensitivity {
    SensitivityStatus status = SensitivityStatus::too_few_rows;
    std::int64_t used = 0;            ///< rows with a finite output
    std::int64_t used_gradients = 0;  ///< of them, rows with at least one derivative
    double mean = 0.0;
    double variance = 0.0;
    std::vector<VariableSensitivity> variables;
    /// Unit eigenvector of E[grad grad^T] for its largest eigenvalue (its largest entry positive; 0 for variables
    /// without derivatives), and that eigenvalue's share of the trace. Empty and NaN where there are no gradients.
    Vector active_direction;
    double active_share = 0.0;
};

/// Collects rows, keeps sums only: memory does not grow with their number.
///
/// **First order.** E[y | x_i] is the least-squares polynomial in x_i alone (shifted Legendre basis), of the degree
/// that generalised cross-validation prefers; its explained share of the variance, adjusted for the degrees of freedom,
/// is the index. For a variable with L distinct values degree L - 1 gives the means of the groups, so integer variables
/// need nothing of their own. With stratified points (Sobol, Latin hypercube) the other variables average out almost
/// exactly, while rank and bin estimators keep errors of order N^-1/2; and unlike a polynomial in all variables at once
/// it stays meaningful when rows are missing in part of the cube: it then speaks of the designs that are there.
///
/// **Derivative-based.** S_T,i <= nu_i/(pi^2 V) for inputs uniform on [0, 1] and y with square-integrable derivatives
/// on the whole cube (Sobol and Kucherenko, Math. Comput. Simul. 79, 2009). With missing rows, or where y jumps, it is
/// an indication and no bound.
///
/// **Active direction.** Constantine, Dow and Wang, SIAM J. Sci. Comput. 36, 2014.
///
/// **Intervals.** Bootstrap over runs of consecutive rows (8 rows up to 1024, longer runs for longer tables, 64 to 128
/// of them), each as stratified as a Sobol run is, centred on the estimate. For independent rows that is the usual
/// bootstrap; for Sobol points it errs to the wide side, since the runs complement one another.
class SensitivityTable {
public:
    /// Throws std::invalid_argument for dimensions outside 1..64 or options out of range.
    explicit SensitivityTable(int dimensions, const SensitivityOptions& options = {});
    ~SensitivityTable();
    SensitivityTable(SensitivityTable&&) noexcept;
    SensitivityTable& operator=(SensitivityTable&&) noexcept;

    /// Row number `row` of the table: the inputs in [0, 1]^n (an integer variable: the middle of its level's share of
    /// [0, 1]), the output, dy/dx_i in units of y per unit cube (NaN: there is none; empty: none at all). A row whose
    /// output is not finite is left out. The same rows in the same order give the same bits. Throws
    /// std::invalid_argument for a negative row, wrong lengths or inputs outside [0, 1].
    void add(std::int64_t row, const Vector& inputs, double output, const Vector& gradient = {});

    [[nodiscard]] Sensitivity estimate() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace percuss::numerics
