#pragma once
/// \file
/// percuss' side of against_auto.cpp: the branch of the soft-impact problem at many tolerances and steps, its errors
/// and times.

#include "branch/trace.hpp"
#include "scenes.hpp"
#include "soft_impact_exact.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

namespace percuss::bench {

using Strike = SoftImpactExact::Strike;

inline constexpr double from = 1.1;
inline constexpr double beyond = 1.7;
inline constexpr double never = std::numeric_limits<double>::infinity();

struct Achieved {
    std::size_t points = 0;
    double fold = never;
    double curve = never;
};

struct Limit {
    double fold = never;
    double curve = never;
    std::size_t least_points = 0;
    [[nodiscard]] bool holds(const Achieved& achieved) const {
        return achieved.fold <= fold && achieved.curve <= curve && achieved.points >= least_points;
    }
};

struct Reference {
    SoftImpactExact exact;
    Strike start{};
    double fold = 0.0;

    Reference() {
        const auto beginning = exact.with_held({from, 6.1755L, 0.791L, 0.5027L}, SoftImpactExact::frequency);
        const auto extremal = exact.fold({1.5722L, 7.491L, 6.784L, 0.5636L});
        if (!beginning || !extremal) { throw std::runtime_error("the closed form has no solution"); }
        start = *beginning;
        fold = static_cast<double>((*extremal)[SoftImpactExact::frequency]);
    }

    void add_point(Achieved& achieved, const Strike& z) const {
        const double d = exact.distance(z);
        if (achieved.points == 0 || std::isnan(d) || d > achieved.curve) { achieved.curve = d; }  // NaN stays
        ++achieved.points;
    }
};

struct OurRun {
    branch::Branch branch;
    double seconds = 0.0;
};

class Ours {
public:
    /// coarseness: of the steps, 1 for the default ones.
    Ours(double tolerance, double coarseness, const Reference& reference)
        : tolerance_(tolerance),
          coarseness_(coarseness),
          integrator_(make({&model::spring::scene}, "taylor", tolerance)) {
        family_ = flow::along_frequency({integrator_.get(), with(soft_impact, 7, from), nullptr}, 1.0);
        departure_.parameter = from;
        departure_.motion.form = orbit::Form::sequence;
        orbit::ContactUnknowns contact;
        contact.phase = static_cast<double>(reference.start[SoftImpactExact::entry]);
        contact.speed = static_cast<double>(reference.start[SoftImpactExact::speed]);
        contact.duration = static_cast<double>(reference.start[SoftImpactExact::duration] * from);
        departure_.motion.sequence.contacts = {contact};
        options_.from = from;
        options_.to = beyond;
        options_.size = 1.0;
        options_.steps.target_angle *= coarseness;
        options_.steps.largest_step *= coarseness;
        options_.steps.largest_parameter_step *= coarseness;
    }

    [[nodiscard]] OurRun run() const {
        OurRun run;
        const auto start = std::chrono::steady_clock::now();
        run.branch = branch::trace(family_, departure_, options_);
        run.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        return run;
    }

    [[nodiscard]] Achieved achieve(const Reference& reference) const {
        const branch::Branch b = run().branch;
        Achieved achieved;
        if (b.end != branch::End::range || b.boundaries.size() != 1 ||
            b.boundaries.front().kind != boundary::Kind::fold) {
            return achieved;
        }
        for (const branch::Point& point : b.points) {
            const orbit::ContactUnknowns& c = point.motion.sequence.contacts.front();
            reference.add_point(achieved, {point.parameter, c.phase, c.speed, c.duration / point.parameter});
        }
        achieved.fold = std::abs(b.boundaries.front().point.parameter - reference.fold);
        return achieved;
    }

    [[nodiscard]] double tolerance() const { return tolerance_; }
    [[nodiscard]] double coarseness() const { return coarseness_; }

private:
    double tolerance_;
    double coarseness_;
    std::unique_ptr<flow::Integrator> integrator_;
    flow::ParameterFamily family_;
    branch::Departure departure_;
    branch::TraceOptions options_;
};

struct OurEntry {
    std::unique_ptr<Ours> ours;
    Achieved achieved;
    double seconds = never;
};

/// Tolerances from loose to tight, for each of the coarsenesses.
using OurTable = std::vector<std::vector<OurEntry>>;

inline OurTable our_table(const Reference& reference) {
    OurTable table;
    for (const double coarseness : {0.5, 0.75, 1.0, 1.5, 2.0, 3.0}) {
        auto& row = table.emplace_back();
        for (const double tolerance : tolerances(1e-2, 1e-13, 1)) {
            auto contestant = std::make_unique<Ours>(tolerance, coarseness, reference);
            const Achieved achieved = contestant->achieve(reference);
            row.push_back({std::move(contestant), achieved});
        }
    }
    return table;
}

/// Times every entry as the shortest of several runs within this process.
inline void time_all(OurTable& table) {
    for (int round = 0; round < 10; ++round) {
        for (auto& row : table) {
            for (OurEntry& entry : row) { entry.seconds = std::min(entry.seconds, entry.ours->run().seconds); }
        }
    }
}

/// The default tolerance and steps.
inline const OurEntry& defaults(const OurTable& table) { return table[2].back(); }

/// The loosest tolerance of a row that keeps the limit for good.
inline const OurEntry* loosest(const std::vector<OurEntry>& row, const Limit& limit) {
    constexpr std::ptrdiff_t confirmed_by = 3;  // decades
    for (auto entry = row.begin(); entry != row.end(); ++entry) {
        const auto last = std::min(confirmed_by + 1, row.end() - entry);
        if (std::all_of(entry, entry + last, [&](const OurEntry& e) { return limit.holds(e.achieved); })) {
            return &*entry;
        }
    }
    return nullptr;
}

/// The quickest within the limit; null when there is none.
inline const OurEntry* choose(const OurTable& table, const Limit& limit) {
    const OurEntry* best = nullptr;
    for (const auto& row : table) {
        const OurEntry* entry = loosest(row, limit);
        if (entry != nullptr && (best == nullptr || entry->seconds < best->seconds)) { best = entry; }
    }
    return best;
}

}  // namespace percuss::bench
