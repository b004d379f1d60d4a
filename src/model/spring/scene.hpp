#pragma once
/// \file
/// The scene of the spring-mass actuator: its equations in every form that the kernels need.

#include "model/spring/jet.hpp"
#include "model/spring/plain.hpp"

namespace percuss::model {
inline namespace PERCUSS_ISA {

struct SpringScene {
    using Plain = PlainSpring;
    template <class T, int MaxOrder>
    using Jet = SpringJet<T, MaxOrder>;
    template <int N, int MaxOrder>
    using Lanes = LanesOf<SpringJet, N, MaxOrder>;
};

}  // namespace PERCUSS_ISA
}  // namespace percuss::model
