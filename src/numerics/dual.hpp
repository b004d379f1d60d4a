#pragma once
/// \file
/// Forward-mode dual numbers whose derivative part is one SIMD vector, and pairs of scalars that are processed
/// together. Everything here is meant to be inlined into kernels that are compiled once per instruction set, so it
/// lives in a namespace of that name: two sets never share a symbol.

#include <array>
#include <cmath>
#include <cstddef>
#include <type_traits>

#ifndef PERCUSS_ISA
#define PERCUSS_ISA generic
#endif

namespace percuss::numerics {
inline namespace PERCUSS_ISA {

#define PERCUSS_INLINE inline __attribute__((always_inline))

/// Lanes in one machine register of this instruction set. Wider vectors than the machine has are lowered badly by the
/// compiler, so more lanes are several registers.
/// Measured with eight doubles on AVX2: GCC's own lowering of one wide vector was 20 times slower than several
/// registers.
#if defined(__AVX512F__)
inline constexpr int register_lanes = 8;
#elif defined(__AVX__)
inline constexpr int register_lanes = 4;
#else
inline constexpr int register_lanes = 2;
#endif

template <int W>
struct Register {
    typedef double type __attribute__((vector_size(W * sizeof(double))));  // NOLINT(modernize-use-using)
};

/// N doubles worked on together.
template <int N>
struct LaneVector {
    static constexpr int width = N < register_lanes ? N : register_lanes;
    static constexpr int parts = N / width;
    using Part = typename Register<width>::type;
    Part part[parts];

    PERCUSS_INLINE double operator[](std::size_t i) const { return part[i / width][i % width]; }
    PERCUSS_INLINE void set(std::size_t i, double value) { part[i / width][i % width] = value; }

    PERCUSS_INLINE LaneVector& operator+=(const LaneVector& o) {
        for (int i = 0; i < parts; ++i) { part[i] += o.part[i]; }
        return *this;
    }
    PERCUSS_INLINE LaneVector& operator-=(const LaneVector& o) {
        for (int i = 0; i < parts; ++i) { part[i] -= o.part[i]; }
        return *this;
    }
    /// this += o s
    PERCUSS_INLINE void add_scaled(const LaneVector& o, double s) {
        for (int i = 0; i < parts; ++i) { part[i] += o.part[i] * s; }
    }
    friend PERCUSS_INLINE LaneVector operator+(LaneVector a, const LaneVector& b) { return a += b; }
    friend PERCUSS_INLINE LaneVector operator-(LaneVector a, const LaneVector& b) { return a -= b; }
    friend PERCUSS_INLINE LaneVector operator-(LaneVector a) {
        for (int i = 0; i < parts; ++i) { a.part[i] = -a.part[i]; }
        return a;
    }
    friend PERCUSS_INLINE LaneVector operator*(LaneVector a, double s) {
        for (int i = 0; i < parts; ++i) { a.part[i] *= s; }
        return a;
    }
    friend PERCUSS_INLINE LaneVector operator*(double s, const LaneVector& a) { return a * s; }
};

/// value + N directional derivatives. Arithmetic is the chain rule.
template <int N>
struct Dual {
    double v;
    LaneVector<N> d;
    Dual() = default;
    PERCUSS_INLINE Dual(double value) : v(value), d{} {}  // a constant: implicit on purpose
    PERCUSS_INLINE Dual(double value, LaneVector<N> derivative) : v(value), d(derivative) {}

    PERCUSS_INLINE Dual& operator+=(const Dual& o) { return v += o.v, d += o.d, *this; }
    PERCUSS_INLINE Dual& operator-=(const Dual& o) { return v -= o.v, d -= o.d, *this; }
    PERCUSS_INLINE Dual& operator*=(const Dual& o) { return *this = *this * o; }

    friend PERCUSS_INLINE Dual operator-(const Dual& a) { return {-a.v, -a.d}; }
    friend PERCUSS_INLINE Dual operator+(const Dual& a, const Dual& b) { return {a.v + b.v, a.d + b.d}; }
    friend PERCUSS_INLINE Dual operator-(const Dual& a, const Dual& b) { return {a.v - b.v, a.d - b.d}; }
    friend PERCUSS_INLINE Dual operator*(const Dual& a, const Dual& b) { return {a.v * b.v, a.d * b.v + b.d * a.v}; }
    friend PERCUSS_INLINE Dual operator/(const Dual& a, const Dual& b) {
        // One division serves the value and all lanes.
        const double inverse = 1.0 / b.v;
        const double q = a.v * inverse;
        return {q, (a.d - b.d * q) * inverse};
    }
    friend PERCUSS_INLINE Dual operator+(const Dual& a, double b) { return {a.v + b, a.d}; }
    friend PERCUSS_INLINE Dual operator+(double a, const Dual& b) { return {a + b.v, b.d}; }
    friend PERCUSS_INLINE Dual operator-(const Dual& a, double b) { return {a.v - b, a.d}; }
    friend PERCUSS_INLINE Dual operator-(double a, const Dual& b) { return {a - b.v, -b.d}; }
    friend PERCUSS_INLINE Dual operator*(const Dual& a, double b) { return {a.v * b, a.d * b}; }
    friend PERCUSS_INLINE Dual operator*(double a, const Dual& b) { return {a * b.v, b.d * a}; }
    friend PERCUSS_INLINE Dual operator/(const Dual& a, double b) { return a * (1.0 / b); }
    friend PERCUSS_INLINE Dual operator/(double a, const Dual& b) { return Dual(a) / b; }

    friend PERCUSS_INLINE Dual sqrt(const Dual& a) {
        const double r = std::sqrt(a.v);
        return {r, a.d * (0.5 / r)};
    }
    friend PERCUSS_INLINE Dual exp(const Dual& a) {
        const double r = std::exp(a.v);
        return {r, a.d * r};
    }
    friend PERCUSS_INLINE Dual log(const Dual& a) { return {std::log(a.v), a.d * (1.0 / a.v)}; }
    friend PERCUSS_INLINE Dual cos(const Dual& a) { return {std::cos(a.v), a.d * -std::sin(a.v)}; }
    friend PERCUSS_INLINE Dual sin(const Dual& a) { return {std::sin(a.v), a.d * std::cos(a.v)}; }
};

/// What a kernel must know of its scalar: the type times and tolerances are kept in, and the number of lanes.
template <class T>
struct ScalarTraits {
    using Base = T;
    static constexpr int lanes = 0;
};
template <int N>
struct ScalarTraits<Dual<N>> {
    using Base = double;
    static constexpr int lanes = N;
};

template <class T>
PERCUSS_INLINE const T& base(const T& a) {
    return a;
}
template <int N>
PERCUSS_INLINE const double& base(const Dual<N>& a) {
    return a.v;
}

using TwoLanes = typename Register<2>::type;

/// a as an S, which is T itself or its base type.
template <class S, class T>
PERCUSS_INLINE const S& as(const T& a) {
    if constexpr (std::is_same_v<S, T>) {
        return a;
    } else {
        return base(a);
    }
}

/// Two scalars worked on together: the two membranes of an actuator.
template <class T>
struct Pair {
    T a, b;
    Pair() = default;
    PERCUSS_INLINE Pair(const T& first, const T& second) : a(first), b(second) {}
    PERCUSS_INLINE explicit Pair(const T& both) : a(both), b(both) {}
    PERCUSS_INLINE T first() const { return a; }
    PERCUSS_INLINE T second() const { return b; }
    PERCUSS_INLINE void add_product(const Pair& x, const Pair& y) { a += x.a * y.a, b += x.b * y.b; }
    friend PERCUSS_INLINE Pair operator+(const Pair& x, const Pair& y) { return {x.a + y.a, x.b + y.b}; }
    friend PERCUSS_INLINE Pair operator-(const Pair& x, const Pair& y) { return {x.a - y.a, x.b - y.b}; }
    friend PERCUSS_INLINE Pair operator*(const Pair& x, const Pair& y) { return {x.a * y.a, x.b * y.b}; }
    template <class S>
    friend PERCUSS_INLINE Pair operator*(const S& s, const Pair& x) {
        return {s * x.a, s * x.b};
    }
};

template <>
struct Pair<double> {
    TwoLanes v;
    Pair() = default;
    PERCUSS_INLINE explicit Pair(TwoLanes value) : v(value) {}
    PERCUSS_INLINE Pair(double first, double second) : v{first, second} {}
    PERCUSS_INLINE explicit Pair(double both) : v{both, both} {}
    [[nodiscard]] PERCUSS_INLINE double first() const { return v[0]; }
    [[nodiscard]] PERCUSS_INLINE double second() const { return v[1]; }
    PERCUSS_INLINE void add_product(const Pair& x, const Pair& y) { v += x.v * y.v; }
    friend PERCUSS_INLINE Pair operator+(const Pair& x, const Pair& y) { return Pair(x.v + y.v); }
    friend PERCUSS_INLINE Pair operator-(const Pair& x, const Pair& y) { return Pair(x.v - y.v); }
    friend PERCUSS_INLINE Pair operator*(const Pair& x, const Pair& y) { return Pair(x.v * y.v); }
    friend PERCUSS_INLINE Pair operator*(double s, const Pair& x) { return Pair(x.v * s); }
};

template <int N>
struct Pair<Dual<N>> {
    TwoLanes v;
    LaneVector<N> d0, d1;
    Pair() = default;
    PERCUSS_INLINE Pair(TwoLanes value, LaneVector<N> first, LaneVector<N> second) : v(value), d0(first), d1(second) {}
    PERCUSS_INLINE Pair(const Dual<N>& first, const Dual<N>& second)
        : v{first.v, second.v},
          d0(first.d),
          d1(second.d) {}
    PERCUSS_INLINE explicit Pair(const Dual<N>& both) : v{both.v, both.v}, d0(both.d), d1(both.d) {}
    PERCUSS_INLINE Dual<N> first() const { return {v[0], d0}; }
    PERCUSS_INLINE Dual<N> second() const { return {v[1], d1}; }
    PERCUSS_INLINE void add_product(const Pair& x, const Pair& y) {
        v += x.v * y.v;
        d0.add_scaled(x.d0, y.v[0]);
        d0.add_scaled(y.d0, x.v[0]);
        d1.add_scaled(x.d1, y.v[1]);
        d1.add_scaled(y.d1, x.v[1]);
    }
    friend PERCUSS_INLINE Pair operator+(const Pair& x, const Pair& y) { return {x.v + y.v, x.d0 + y.d0, x.d1 + y.d1}; }
    friend PERCUSS_INLINE Pair operator-(const Pair& x, const Pair& y) { return {x.v - y.v, x.d0 - y.d0, x.d1 - y.d1}; }
    friend PERCUSS_INLINE Pair operator*(const Pair& x, const Pair& y) {
        return {x.v * y.v, x.d0 * y.v[0] + y.d0 * x.v[0], x.d1 * y.v[1] + y.d1 * x.v[1]};
    }
    friend PERCUSS_INLINE Pair operator*(const Dual<N>& s, const Pair& x) {
        return {x.v * s.v, x.d0 * s.v + s.d * x.v[0], x.d1 * s.v + s.d * x.v[1]};
    }
    friend PERCUSS_INLINE Pair operator*(double s, const Pair& x) { return {x.v * s, x.d0 * s, x.d1 * s}; }
};

/// A pair as a pair of S.
template <class S, class T>
PERCUSS_INLINE Pair<S> pair_as(const Pair<T>& p) {
    if constexpr (std::is_same_v<S, T>) {
        return p;
    } else {
        return Pair<S>(p.v);
    }
}

/// Coefficients of a pair of power series. Values and derivative parts are kept apart, so that a convolution touches as
/// little memory as it can: a kernel's series must fit the first-level cache.
template <class T, int N>
class PairSeries {
public:
    PERCUSS_INLINE const Pair<T>& operator[](int i) const { return c_[i]; }
    template <class S>
    PERCUSS_INLINE const Pair<T>& get(int i) const {
        return c_[i];
    }
    PERCUSS_INLINE void set(int i, const Pair<T>& value) { c_[i] = value; }

private:
    std::array<Pair<T>, N> c_;
};

template <int L, int N>
class PairSeries<Dual<L>, N> {
public:
    PERCUSS_INLINE Pair<Dual<L>> operator[](int i) const { return {v_[i], d_[2 * i], d_[2 * i + 1]}; }
    /// Coefficient i as a pair of S: Dual<L>, or double for the values alone.
    template <class S>
    PERCUSS_INLINE Pair<S> get(int i) const {
        if constexpr (std::is_same_v<S, double>) {
            return Pair<double>(v_[i]);
        } else {
            return (*this)[i];
        }
    }
    /// A value without derivatives.
    PERCUSS_INLINE void set(int i, const Pair<double>& value) {
        v_[i] = value.v;
        d_[2 * i] = LaneVector<L>{};
        d_[2 * i + 1] = LaneVector<L>{};
    }
    PERCUSS_INLINE void set(int i, const Pair<Dual<L>>& value) {
        v_[i] = value.v;
        d_[2 * i] = value.d0;
        d_[2 * i + 1] = value.d1;
    }

private:
    TwoLanes v_[N];
    LaneVector<L> d_[2 * N];
};

}  // namespace PERCUSS_ISA
}  // namespace percuss::numerics
