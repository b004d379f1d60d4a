#pragma once
/// \file
/// The two scenes of the dielectric elastomer actuator, with Maxwell branches and without: its equations in every form
/// that the kernels need.

#include "model/membrane/jet.hpp"
#include "model/membrane/lanes.hpp"
#include "model/membrane/plain.hpp"

namespace percuss::model {
inline namespace PERCUSS_ISA {

struct ViscousScene {
    using Plain = ViscousMembranes;
    template <class T, int MaxOrder>
    using Jet = MembraneJet<T, true, MaxOrder>;
    template <int N, int MaxOrder>
    using Lanes = MembraneLanes<N, true, MaxOrder>;
};

struct ElasticScene {
    using Plain = ElasticMembranes;
    template <class T, int MaxOrder>
    using Jet = MembraneJet<T, false, MaxOrder>;
    template <int N, int MaxOrder>
    using Lanes = MembraneLanes<N, false, MaxOrder>;
};

}  // namespace PERCUSS_ISA
}  // namespace percuss::model
