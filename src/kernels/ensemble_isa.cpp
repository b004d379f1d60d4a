// The ensemble kernels, compiled once per instruction set (PERCUSS_ISA names it). Everything instantiated here lives in
// namespaces of that name.

#include "flow/taylor_ensemble.hpp"
#include "kernels/ensemble_table.hpp"
#include "model/membrane_lanes.hpp"
#include "model/spring_lanes.hpp"

namespace percuss::kernels {
namespace {

constexpr int lanes = 8;
constexpr int max_order = 24;

template <class Jets>
void kernel(const flow::ParameterVector& parameters, const TaylorSettings& settings,
            const flow::EnsembleRequest& request, std::span<flow::EnsembleMember> members) {
    flow::TaylorEnsemble<Jets> ensemble(parameters.data(), static_cast<flow::Law>(settings.law), settings.order);
    ensemble.run(request, members);
}

constexpr EnsembleTable table = {
    kernel<model::MembraneLanes<lanes, true, max_order>>,
    kernel<model::MembraneLanes<lanes, false, max_order>>,
    kernel<model::SpringLanes<lanes, max_order>>,
};

}  // namespace

#define PERCUSS_JOIN2(a, b) a##b
#define PERCUSS_JOIN(a, b) PERCUSS_JOIN2(a, b)
const EnsembleTable& PERCUSS_JOIN(ensemble_table_, PERCUSS_ISA)() { return table; }

}  // namespace percuss::kernels
