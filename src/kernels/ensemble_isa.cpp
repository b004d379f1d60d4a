// The ensemble kernels, compiled once per instruction set (PERCUSS_ISA names it). Everything instantiated here lives in
// namespaces of that name.

#include "flow/taylor_ensemble.hpp"
#include "kernels/scene_table.hpp"
#include "model/scenes.hpp"

namespace percuss::kernels {
namespace {

/// A 512-bit register of doubles; narrower instruction sets hold the eight in several registers.
constexpr int lanes = 8;
/// As in the kernels for single runs.
constexpr int max_order = 24;

template <class Jets>
void kernel(const flow::ParameterVector& parameters, const TaylorSettings& settings,
            const flow::EnsembleRequest& request, std::span<flow::EnsembleMember> members) {
    flow::TaylorEnsemble<Jets> ensemble(parameters.data(), settings.law, settings.order);
    ensemble.run(request, members);
}

template <class... S>
constexpr EnsembleTable table_of(model::SceneList<S...>) {
    return {kernel<typename S::template Lanes<lanes, max_order>>...};
}
constexpr EnsembleTable table = table_of(model::Scenes{});

}  // namespace

#define PERCUSS_JOIN2(a, b) a##b
#define PERCUSS_JOIN(a, b) PERCUSS_JOIN2(a, b)
const EnsembleTable& PERCUSS_JOIN(ensemble_table_, PERCUSS_ISA)() { return table; }

}  // namespace percuss::kernels
