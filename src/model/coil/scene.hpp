#pragma once
/// \file
/// The scene of the voice-coil actuator: its equations in every form that the kernels need.

#include "model/coil/jet.hpp"
#include "model/coil/plain.hpp"

namespace percuss::model {
inline namespace PERCUSS_ISA {

struct CoilScene {
    using Plain = PlainCoil;
    template <class T, int MaxOrder>
    using Jet = CoilJet<T, MaxOrder>;
    template <int N, int MaxOrder>
    using Lanes = LanesOf<CoilJet, N, MaxOrder>;
};

}  // namespace PERCUSS_ISA
}  // namespace percuss::model
