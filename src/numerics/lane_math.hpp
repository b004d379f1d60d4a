#pragma once
/// \file
/// Arithmetic and elementary functions of several doubles at once, lane by lane. What comes out of a lane depends on
/// what went into that lane only, to the last bit: there are no branches on what other lanes hold, which libraries of
/// vector functions do not promise. For kernels that are compiled once per instruction set.

#include "numerics/dual.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace percuss::numerics {
inline namespace PERCUSS_ISA {

/// One machine register of doubles, and integers of the same size: signed as comparisons give them, unsigned for
/// arithmetic on the bits of doubles, where NaN and infinity overflow.
template <int N>
using LanePart = typename LaneVector<N>::Part;
template <int N>
struct LaneIntegers {
    static constexpr std::size_t size = LaneVector<N>::width * sizeof(std::int64_t);
    typedef std::int64_t Truth __attribute__((vector_size(size)));  // NOLINT(modernize-use-using)
    typedef std::uint64_t Bits __attribute__((vector_size(size)));  // NOLINT(modernize-use-using)
};

/// What a comparison of lanes gives: all bits of a lane are set, or none.
template <int N>
struct LaneMask {
    using Part = typename LaneIntegers<N>::Truth;
    Part part[LaneVector<N>::parts];

    PERCUSS_INLINE bool operator[](std::size_t i) const {
        return part[i / LaneVector<N>::width][i % LaneVector<N>::width] != 0;
    }
    PERCUSS_INLINE void set(std::size_t i, bool value) {
        part[i / LaneVector<N>::width][i % LaneVector<N>::width] = value ? -1 : 0;
    }
    [[nodiscard]] PERCUSS_INLINE bool any() const {
        Part all = part[0];
        for (int i = 1; i < LaneVector<N>::parts; ++i) { all |= part[i]; }
        std::int64_t bits = 0;
        for (int i = 0; i < LaneVector<N>::width; ++i) { bits |= all[i]; }
        return bits != 0;
    }
    friend PERCUSS_INLINE LaneMask operator&(LaneMask a, const LaneMask& b) {
        for (int i = 0; i < LaneVector<N>::parts; ++i) { a.part[i] &= b.part[i]; }
        return a;
    }
    friend PERCUSS_INLINE LaneMask operator|(LaneMask a, const LaneMask& b) {
        for (int i = 0; i < LaneVector<N>::parts; ++i) { a.part[i] |= b.part[i]; }
        return a;
    }
    friend PERCUSS_INLINE LaneMask operator~(LaneMask a) {
        for (int i = 0; i < LaneVector<N>::parts; ++i) { a.part[i] = ~a.part[i]; }
        return a;
    }
};

template <int N>
PERCUSS_INLINE LaneVector<N> all_lanes(double value) {
    LaneVector<N> a;
    for (int i = 0; i < LaneVector<N>::parts; ++i) { a.part[i] = LanePart<N>{} + value; }
    return a;
}
template <int N>
PERCUSS_INLINE LaneVector<N> operator*(LaneVector<N> a, const LaneVector<N>& b) {
    for (int i = 0; i < LaneVector<N>::parts; ++i) { a.part[i] *= b.part[i]; }
    return a;
}
template <int N>
PERCUSS_INLINE LaneVector<N> operator/(LaneVector<N> a, const LaneVector<N>& b) {
    for (int i = 0; i < LaneVector<N>::parts; ++i) { a.part[i] /= b.part[i]; }
    return a;
}
template <int N>
PERCUSS_INLINE LaneVector<N> operator/(double a, const LaneVector<N>& b) {
    return all_lanes<N>(a) / b;
}
template <int N>
PERCUSS_INLINE LaneVector<N> operator+(LaneVector<N> a, double b) {
    for (int i = 0; i < LaneVector<N>::parts; ++i) { a.part[i] += b; }
    return a;
}
template <int N>
PERCUSS_INLINE LaneVector<N> operator-(LaneVector<N> a, double b) {
    for (int i = 0; i < LaneVector<N>::parts; ++i) { a.part[i] -= b; }
    return a;
}
template <int N>
PERCUSS_INLINE LaneVector<N> operator-(double a, const LaneVector<N>& b) {
    return all_lanes<N>(a) - b;
}
template <int N>
PERCUSS_INLINE LaneMask<N> operator<(const LaneVector<N>& a, const LaneVector<N>& b) {
    LaneMask<N> m;
    for (int i = 0; i < LaneVector<N>::parts; ++i) { m.part[i] = a.part[i] < b.part[i]; }
    return m;
}
template <int N>
PERCUSS_INLINE LaneMask<N> operator<(const LaneVector<N>& a, double b) {
    return a < all_lanes<N>(b);
}
template <int N>
PERCUSS_INLINE LaneVector<N> select(const LaneMask<N>& mask, const LaneVector<N>& yes, const LaneVector<N>& no) {
    LaneVector<N> a;
    for (int i = 0; i < LaneVector<N>::parts; ++i) { a.part[i] = mask.part[i] ? yes.part[i] : no.part[i]; }
    return a;
}
/// b where a is not smaller, NaN included.
template <int N>
PERCUSS_INLINE LaneVector<N> min(const LaneVector<N>& a, const LaneVector<N>& b) {
    return select(a < b, a, b);
}
template <int N>
PERCUSS_INLINE LaneVector<N> max(const LaneVector<N>& a, const LaneVector<N>& b) {
    return select(b < a, a, b);
}
template <int N>
PERCUSS_INLINE LaneVector<N> abs(LaneVector<N> a) {
    using Bits = typename LaneIntegers<N>::Bits;
    for (int i = 0; i < LaneVector<N>::parts; ++i) {
        a.part[i] = (LanePart<N>)((Bits)a.part[i] & std::uint64_t{0x7fffffffffffffff});
    }
    return a;
}
/// c[0] + c[1] x + ... + c[Count - 1] x^(Count - 1), even and odd powers side by side, so that one need not wait for
/// the other.
template <int N, int Count>
PERCUSS_INLINE LaneVector<N> polynomial(const double (&c)[Count], const LaneVector<N>& x) {
    static_assert(Count >= 2);
    const LaneVector<N> square = x * x;
    LaneVector<N> last = all_lanes<N>(c[Count - 1]);
    LaneVector<N> but_one = all_lanes<N>(c[Count - 2]);
    for (int j = Count - 3; j >= 0; --j) {
        const LaneVector<N> next = last * square + c[j];
        last = but_one;
        but_one = next;
    }
    return but_one + last * x;
}

/// Natural logarithm of normal positive numbers, to about 2 units in the last place; NaN and infinity stay, zero gives
/// about -709. With a = 2^e m, m in [sqrt(1/2), sqrt(2)): log m = 2 artanh((m - 1)/(m + 1)).
template <int N>
PERCUSS_INLINE LaneVector<N> log(const LaneVector<N>& a) {
    using Bits = typename LaneIntegers<N>::Bits;
    constexpr std::uint64_t one = 0x3ff0000000000000;
    constexpr std::uint64_t root_half = 0x3fe6a09e667f3bcd;
    constexpr std::uint64_t exponent = 0x7ff0000000000000;
    constexpr std::uint64_t two_to_52 = 0x4330000000000000;
    LaneVector<N> m;
    LaneVector<N> e;
    for (int i = 0; i < LaneVector<N>::parts; ++i) {
        const Bits bits = (Bits)a.part[i];
        // Adding 1 - sqrt(1/2) in the bits carries into the exponent from mantissas above sqrt(2): e is then one higher
        // and m below 1, so that log m does not cancel against e log 2 for a just below 1.
        const Bits high = (bits + (one - root_half)) & exponent;
        m.part[i] = (LanePart<N>)(bits - high + one);
        // An integer below 2^52 set as the mantissa of 2^52 is that integer as a double: no conversion instruction,
        // which older instruction sets lack for 64 bits.
        e.part[i] = (LanePart<N>)((high >> 52) | two_to_52) - (0x1p52 + 1023.0);
    }
    // |s| <= 0.172, z <= 0.0295: the first term left out, z^11/23, is below 1e-18.
    static constexpr double odd[] = {2.0 / 3,  2.0 / 5,  2.0 / 7,  2.0 / 9,  2.0 / 11,
                                     2.0 / 13, 2.0 / 15, 2.0 / 17, 2.0 / 19, 2.0 / 21};
    constexpr double log2_high = 0x1.62e42fefp-1;  // 33 bits: products with exponents are exact
    constexpr double log2_low = 0x1.473de6af278edp-34;
    const LaneVector<N> f = m - 1.0;
    const LaneVector<N> s = f / (m + 1.0);
    const LaneVector<N> z = s * s;
    // 2 s = f - s f exactly in real numbers; f is exact
    const LaneVector<N> small = s * (z * polynomial<N>(odd, z) - f) + e * log2_low;
    const LaneVector<N> result = e * log2_high + (f + small);
    return select(a < HUGE_VAL, result, a);
}

/// Exponential function to about 1 unit in the last place; below -708 and above 709 its values there. NaN stays.
template <int N>
PERCUSS_INLINE LaneVector<N> exp(const LaneVector<N>& a) {
    using Bits = typename LaneIntegers<N>::Bits;
    // Adding 1.5 2^52 rounds to the nearest integer, which then stands in the lowest bits.
    constexpr double shifter = 0x1.8p52;
    constexpr double log2_high = 0x1.62e42fefp-1;
    constexpr double log2_low = 0x1.473de6af278edp-34;
    // |r| <= ln(2)/2: the first term left out, r^14/14!, is 4e-18.
    static constexpr double reciprocal_factorials[] = {
        1.0 / 2,     1.0 / 6,      1.0 / 24,      1.0 / 120,      1.0 / 720,       1.0 / 5040,
        1.0 / 40320, 1.0 / 362880, 1.0 / 3628800, 1.0 / 39916800, 1.0 / 479001600, 1.0 / 6227020800};
    // Between these the exponent k stays in the range of normal numbers, so that adding it to the bits below is exact.
    const LaneVector<N> x = select(a < 709.0, select(a < -708.0, all_lanes<N>(-708.0), a), min(a, all_lanes<N>(709.0)));
    LaneVector<N> shifted = x * 0x1.71547652b82fep0 + shifter;
    const LaneVector<N> k = shifted - shifter;
    const LaneVector<N> r = (x - k * log2_high) - k * log2_low;
    const LaneVector<N> y = r + r * r * polynomial<N>(reciprocal_factorials, r) + 1.0;
    LaneVector<N> result;
    for (int i = 0; i < LaneVector<N>::parts; ++i) {
        result.part[i] = (LanePart<N>)((Bits)y.part[i] + ((Bits)shifted.part[i] << 52));
    }
    return select(a < HUGE_VAL, result, a);
}

/// Cosine and sine of angles up to 1e6 in size, absolute error about 1e-16 and growing by 1e-16 per 1e5; larger angles
/// lose accuracy in proportion. The angle is brought to [-pi/4, pi/4] by a pi/2 in three parts of which the first two
/// have 33 bits.
template <int N>
PERCUSS_INLINE void cos_sin(const LaneVector<N>& a, LaneVector<N>& c, LaneVector<N>& s) {
    using Bits = typename LaneIntegers<N>::Bits;
    constexpr double shifter = 0x1.8p52;
    // Multiples of pi/2 up to 2^20, angles up to 1.6e6, times 33 bits are exact in double precision.
    constexpr double part1 = 0x1.921fb544p0;
    constexpr double part2 = 0x1.0b4611a6p-34;
    constexpr double part3 = 0x1.3198a2e037073p-69;
    // |r| <= pi/4: the first terms left out are r^17/17! = 5e-17 and r^18/18! = 2e-18.
    static constexpr double sine[] = {-1.0 / 6,        1.0 / 120,          -1.0 / 5040,           1.0 / 362880,
                                      -1.0 / 39916800, 1.0 / 6227020800.0, -1.0 / 1307674368000.0};
    static constexpr double cosine[] = {1.0 / 24,          -1.0 / 720,           1.0 / 40320,           -1.0 / 3628800,
                                        1.0 / 479001600.0, -1.0 / 87178291200.0, 1.0 / 20922789888000.0};
    const LaneVector<N> shifted = a * 0x1.45f306dc9c883p-1 + shifter;
    const LaneVector<N> k = shifted - shifter;
    const LaneVector<N> r = ((a - k * part1) - k * part2) - k * part3;
    const LaneVector<N> z = r * r;
    const LaneVector<N> sin_r = r + r * z * polynomial<N>(sine, z);
    const LaneVector<N> cos_r = (z * z * polynomial<N>(cosine, z) - z * 0.5) + 1.0;
    for (int i = 0; i < LaneVector<N>::parts; ++i) {
        // In odd quadrants sine and cosine change places; sine is negative in quadrants 2 and 3, cosine in 1 and 2.
        const Bits quadrant = (Bits)shifted.part[i];
        const typename LaneIntegers<N>::Truth odd = (quadrant & 1) != 0;
        const Bits sin_bits = odd ? (Bits)cos_r.part[i] : (Bits)sin_r.part[i];
        const Bits cos_bits = odd ? (Bits)sin_r.part[i] : (Bits)cos_r.part[i];
        s.part[i] = (LanePart<N>)(sin_bits ^ ((quadrant & 2) << 62));
        c.part[i] = (LanePart<N>)(cos_bits ^ (((quadrant + 1) & 2) << 62));
    }
}

}  // namespace PERCUSS_ISA
}  // namespace percuss::numerics
