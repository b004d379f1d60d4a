#include "verbs/explore/sensitivities.hpp"

#include <cmath>

namespace percuss::verbs {

namespace {

numerics::SensitivityOptions seeded(std::uint64_t seed) {
    numerics::SensitivityOptions options;
    options.seed = seed;
    return options;
}

}  // namespace

SensitivityStudy::SensitivityStudy(const TableLayout& layout, const DesignSpace& space, std::uint64_t seed)
    : layout_(layout),
      dimensions_(static_cast<int>(space.variables().size())),
      seed_(seed),
      not_ok_(new_table()) {
    for (std::size_t q = 0; q < layout.quantities().size(); ++q) {
        if (design::quantity_info(layout.quantities()[q]).smooth) { smooth_.push_back(q); }
    }
    tables_of(std::string(all_edges));
}

numerics::SensitivityTable SensitivityStudy::new_table() const {
    return numerics::SensitivityTable(dimensions_, seeded(seed_));
}

SensitivityStudy::Tables& SensitivityStudy::tables_of(const std::string& edge_kind) {
    Tables& tables = by_edge_[edge_kind];
    while (tables.size() < smooth_.size()) { tables.push_back(new_table()); }
    return tables;
}

void SensitivityStudy::add(std::int64_t number, const DesignPoint& point, const results::Row& row) {
    const auto size = static_cast<Eigen::Index>(point.inputs.size());
    const numerics::Vector inputs = Eigen::Map<const numerics::Vector>(point.inputs.data(), size);
    const bool is_ok = layout_.status(row) == design::to_string(design::EvaluationStatus::ok);
    not_ok_.add(number, inputs, is_ok ? 0.0 : 1.0);
    if (!is_ok) { return; }
    Tables& all = tables_of(std::string(all_edges));
    Tables& kind = tables_of(layout_.edge_kind(row));
    numerics::Vector gradient(size);
    for (std::size_t s = 0; s < smooth_.size(); ++s) {
        const std::size_t q = smooth_[s];
        for (std::size_t i = 0; i < point.inputs.size(); ++i) {
            gradient[static_cast<Eigen::Index>(i)] = layout_.derivative(row, q, i) * point.slopes[i];
        }
        const double value = layout_.value(row, layout_.quantities()[q]);
        all[s].add(number, inputs, value, gradient);
        kind[s].add(number, inputs, value, gradient);
    }
}

std::vector<OutputSensitivity> SensitivityStudy::estimate() const {
    std::vector<OutputSensitivity> out;
    const bool several_kinds = by_edge_.size() > 2;
    const auto add = [&](const std::string& edge_kind) {
        for (std::size_t s = 0; s < smooth_.size(); ++s) {
            const design::Quantity quantity = layout_.quantities()[smooth_[s]];
            out.push_back(
                {std::string(design::quantity_info(quantity).name), edge_kind, by_edge_.at(edge_kind)[s].estimate()});
        }
    };
    add(std::string(all_edges));
    for (const auto& [edge_kind, tables] : by_edge_) {
        if (several_kinds && edge_kind != all_edges) { add(edge_kind); }
    }
    out.push_back({std::string(not_ok_output), std::string(all_edges), not_ok_.estimate()});
    return out;
}

}  // namespace percuss::verbs
