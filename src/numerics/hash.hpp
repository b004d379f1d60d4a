#pragma once
/// \file
/// A bijective mixing of 64 bits, for random numbers that are a function of their place.

#include <cstdint>

namespace percuss::numerics {

/// The finaliser of SplitMix64 (Steele, Lea and Flood, OOPSLA 2014; constants of Stafford's variant 13): each bit of
/// the result depends on every bit of x. 0 maps to 0.
constexpr std::uint64_t mixed_bits(std::uint64_t x) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9U;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebU;
    return x ^ (x >> 31);
}

/// A key for stream number `stream` of a seed; different streams of one seed have unrelated keys.
constexpr std::uint64_t stream_key(std::uint64_t seed, std::uint64_t stream) {
    constexpr std::uint64_t golden = 0x9e3779b97f4a7c15U;  // the increment of SplitMix64: 2^64 over the golden ratio
    return mixed_bits(mixed_bits(seed + golden) + golden * (stream + 1));
}

/// 64 random bits for place x of the stream with this key.
constexpr std::uint64_t hashed(std::uint64_t key, std::uint64_t x) { return mixed_bits(key ^ mixed_bits(x + 1)); }

}  // namespace percuss::numerics
