// Deterministic random numbers. std:: distributions differ between standard libraries, so we bring our own.
#pragma once
#include <cmath>
#include <cstdint>

namespace fixtures {

inline std::uint64_t mix(std::uint64_t x) {
    x += 0x9E3779B97F4A7C15u;
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
    return x ^ (x >> 31);
}

inline std::uint64_t mix(std::uint64_t a, std::uint64_t b) { return mix(mix(a) ^ b); }

// Cheap lattice hash for the noise textures, 0…1.
inline double lattice_value(std::int32_t x, std::int32_t y, std::uint32_t seed) {
    std::uint32_t h = static_cast<std::uint32_t>(x) * 0x9E3779B1u + static_cast<std::uint32_t>(y) * 0x85EBCA77u + seed;
    h = (h ^ (h >> 15)) * 0xC2B2AE3Du;
    h = (h ^ (h >> 13)) * 0x27D4EB2Fu;
    h ^= h >> 16;
    return h * (1.0 / 4294967296.0);
}

// Never draw twice in the arguments of one call: their order is the compiler's choice.
// Linear congruential generator over 64 bits; the upper half goes through mix() because low LCG bits are poor.
class Lcg {
public:
    explicit Lcg(std::uint64_t seed) : state_(mix(seed)) {}

    std::uint64_t next() {
        state_ = state_ * 6364136223846793005u + 1442695040888963407u;
        return mix(state_);
    }
    double uniform() { return static_cast<double>(next() >> 11) * (1.0 / 9007199254740992.0); }
    double uniform(double low, double high) { return low + (high - low) * uniform(); }
    int integer(int low, int high) {  // both ends included
        return low + static_cast<int>(uniform() * (high - low + 1));
    }
    bool chance(double probability) { return uniform() < probability; }
    // Sum of four uniforms: near enough to a Gaussian for sensor noise, and exact in its bits everywhere.
    double normal() {
        double sum = 0.0;
        for (int i = 0; i < 4; ++i) sum += uniform();
        return (sum - 2.0) * 1.7320508075688772;
    }

private:
    std::uint64_t state_;
};

}  // namespace fixtures
